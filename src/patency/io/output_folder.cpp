// SPDX-License-Identifier: Apache-2.0
#include "patency/io/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view marker = ".patency";
constexpr std::string_view marker_text =
    "This folder holds results of patency, which may replace and remove them. Without this file it will not.\n";

/// The results of every run, beside the .pvd files.
constexpr std::string_view result_folders[] = {"checkpoint", "frames"};
constexpr std::string_view result_files[] = {
    "summary.json",   "timing.json",        "pullback.csv",    "sections.csv",    "waveforms.csv",   "report.html",
    "log.txt",        "case.resolved.yaml", "wall.vtp",        "centerline.vtp",  "cut.vtp",         "streamlines.vtp",
    "offenders.vtp",  "energies.csv",       "lumen_after.stl", "lumen_after.vtp", "case_after.yaml", "origin.json",
    "deployment.csv", "stent.csv",          "stent.vtp",       "sweep.json",      "sweep.csv"};

void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw FileError(file_error_sentence("make the folder", path, error.value()));
    // create_directories is content with a file of that name in some versions of the library
    if (!fs::is_directory(path, error)) throw FileError(file_error_sentence("make the folder", path, ENOTDIR));
}

/// Whether the folder has nothing in it; throws when it cannot be looked into.
bool holds_nothing(const fs::path& path) {
    std::error_code error;
    const bool empty = fs::is_empty(path, error);
    if (error) throw FileError(file_error_sentence("look into", path, error.value()));
    return empty;
}

}   // namespace

OutputFolder::OutputFolder(const fs::path& root) : root_(root) {
    make_folder(root_);
    if (!is_output_folder(root_) && !holds_nothing(root_))
        throw FileError(
            fmt::format("the folder '{}' has files in it that are not this program's. Choose a new or an empty "
                        "folder, so that nothing of yours is overwritten.",
                        root_.string()));
    const fs::path path = root_ / marker;
    lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0) throw FileError(file_error_sentence("write", path, errno));
    // Some network file systems have no locks; there only the user can keep two runs apart.
    const bool is_busy = ::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    const bool is_written = !is_busy && ::ftruncate(lock_, 0) == 0 &&
                            ::write(lock_, marker_text.data(), marker_text.size()) == ssize_t(marker_text.size());
    const int error = errno;
    try {
        if (is_busy)
            throw FileError(fmt::format("another run is writing to '{}'. Wait for its end, or choose another folder.",
                                        root_.string()));
        if (!is_written) throw FileError(file_error_sentence("write", path, error));
        for (std::string_view folder : result_folders) make_folder(root_ / folder);
    } catch (...) {
        ::close(lock_);   // a constructor that throws has no destructor
        throw;
    }
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : root_(std::move(other.root_)), lock_(std::exchange(other.lock_, -1)) {}

OutputFolder::~OutputFolder() {
    if (lock_ < 0) return;
    std::error_code error;
    for (std::string_view folder : result_folders)
        fs::remove(root_ / folder, error);   // one that stayed empty; others stay
    ::close(lock_);
}

fs::path OutputFolder::checkpoint(std::string_view stage) const {
    return root_ / "checkpoint" / fmt::format("{}.h5", stage);
}

bool OutputFolder::has_checkpoint(std::string_view stage) const { return fs::exists(checkpoint(stage)); }

bool OutputFolder::has_checkpoint() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(root_ / "checkpoint"))
        if (entry.path().extension() == ".h5") return true;
    return false;
}

void OutputFolder::clear() const {
    std::error_code error;
    for (std::string_view folder : result_folders) {
        fs::remove_all(root_ / folder, error);
        if (error) throw FileError(file_error_sentence("remove", root_ / folder, error.value()));
        make_folder(root_ / folder);
    }
    for (std::string_view name : result_files) fs::remove(root_ / name, error);
    for (const fs::directory_entry& entry : fs::directory_iterator(root_)) {
        const std::string name = entry.path().filename().string();
        const bool is_named_by_deck = name == "probes.csv" || (name.starts_with("profile_") && name.ends_with(".csv"));
        if (is_named_by_deck || entry.path().extension() == ".pvd") fs::remove(entry.path(), error);
    }
}

bool is_output_folder(const fs::path& root) {
    std::error_code error;
    return fs::is_regular_file(root / marker, error);
}

}   // namespace patency
