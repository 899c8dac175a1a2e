// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/result_files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"

namespace patency {

namespace {

[[noreturn]] void fail(const char* verb, const std::filesystem::path& path, int error) {
    throw FileError(fmt::format("cannot {} '{}': {}", verb, path.string(), std::strerror(error)));
}

void append(std::FILE* file, const std::string& line, const std::filesystem::path& path) {
    if (std::fwrite(line.data(), 1, line.size(), file) != line.size() || std::fflush(file) != 0) fail("write", path, errno);
}

}  // namespace

void write_text_file(const std::filesystem::path& path, const std::string& text) {
    const std::filesystem::path beside = path.string() + ".tmp";
    {
        errno = 0;
        std::ofstream file(beside, std::ios::binary);
        file << text;
        file.flush();
        if (!file) fail("write", path, errno);
    }
    std::error_code error;
    std::filesystem::rename(beside, path, error);
    if (error) fail("write", path, error.value());
}

TableFile::TableFile(std::filesystem::path path, const std::vector<std::string>& columns)
    : path_(std::move(path)), columns_(columns), file_(std::fopen(path_.c_str(), "wb")) {
    if (!file_) fail("write", path_, errno);
    append(file_.get(), join(columns_, ",") + "\n", path_);
}

void TableFile::write_row(std::span<const double> values) {
    std::string line;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!std::isfinite(values[k]))
            throw DivergedError(fmt::format("column {} of {} is not a finite number: the flow diverged", columns_.at(k), path_.filename().string()));
        if (k > 0) line += ',';
        line += format_number(values[k]);
    }
    append(file_.get(), line + "\n", path_);
}

void open_result_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail("make the folder", folder, error.value());
    if (!std::filesystem::is_directory(folder)) throw FileError(fmt::format("'{}' is no folder", folder.string()));
    const bool is_ours = std::filesystem::exists(folder / "case.resolved.yaml") || std::filesystem::exists(folder / "log.txt");
    if (!is_ours && !std::filesystem::is_empty(folder))
        throw FileError(fmt::format("'{}' holds files that are no results of this program; choose another folder", folder.string()));
}

}  // namespace patency
