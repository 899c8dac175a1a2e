// SPDX-License-Identifier: Apache-2.0
#include "patency/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "patency/base/errors.h"

namespace patency {
namespace {

class Descriptor {
public:
    Descriptor(const std::filesystem::path& path, int flags) : id_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (id_ >= 0) ::close(id_);
    }
    explicit operator bool() const { return id_ >= 0; }
    int id() const { return id_; }
    /// Network file systems report a full disk only here.
    bool close() { return ::close(std::exchange(id_, -1)) == 0; }

private:
    int id_;
};

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes.remove_prefix(std::size_t(count));
    }
    return true;
}

bool write_and_sync(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
    Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file) return false;
    for (std::string_view part : parts)
        if (!write_all(file.id(), part)) return false;
    return ::fsync(file.id()) == 0 && file.close();
}

/// A rename survives a power failure only when its folder is on the disk too. Some file systems cannot
/// do that for folders; the file itself is safe then, so failures are ignored.
void sync_folder(const std::filesystem::path& folder) {
    const Descriptor descriptor(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
    if (descriptor) ::fsync(descriptor.id());
}

}   // namespace

std::string file_error_sentence(std::string_view verb, const std::filesystem::path& path, int error) {
    std::string sentence =
        fmt::format("cannot {} '{}': {}.", verb, path.string(), std::generic_category().message(error));
    if (error == ENOSPC || error == EDQUOT)
        sentence += " Free some space, then start again: a run continues from its last checkpoint.";
    if (error == EACCES || error == EROFS || error == EPERM) sentence += " Choose a place where you have permission.";
    if (error == ENOENT || error == ENOTDIR) sentence += " Check the path.";
    return sentence;
}

void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
    std::filesystem::path temporary = path;
    temporary += ".tmp";
    if (!write_and_sync(temporary, parts) || ::rename(temporary.c_str(), path.c_str()) != 0) {
        const int error = errno;
        ::unlink(temporary.c_str());   // a half file on a full disk helps nobody
        throw FileError(file_error_sentence("write", path, error));
    }
    sync_folder(path.parent_path());
}

std::string read_file(const std::filesystem::path& path) {
    // O_NONBLOCK: opening a pipe by mistake must not wait for ever.
    const Descriptor file(path, O_RDONLY | O_NONBLOCK);
    struct stat status {};
    if (!file || ::fstat(file.id(), &status) != 0) throw FileError(file_error_sentence("read", path, errno));
    if (S_ISDIR(status.st_mode)) throw FileError(file_error_sentence("read", path, EISDIR));
    if (!S_ISREG(status.st_mode))
        throw FileError(fmt::format("cannot read '{}': it is not a regular file.", path.string()));

    std::string contents(std::size_t(status.st_size), '\0');
    std::size_t done = 0;
    while (done < contents.size()) {
        const ssize_t count = ::read(file.id(), contents.data() + done, contents.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw FileError(file_error_sentence("read", path, errno));
        if (count == 0) break;   // somebody shortened it meanwhile
        done += std::size_t(count);
    }
    contents.resize(done);
    return contents;
}

}   // namespace patency
