// SPDX-License-Identifier: Apache-2.0
// Whole files to and from memory. A file is either the old one or the complete new one, whenever the
// program is killed; it knows nothing of formats.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace patency {

/// Write the parts, one after another, to PATH.tmp, flush it to the disk and rename it to PATH. The
/// folder must exist. Throws FileError with path and reason (full disk, no permission, no folder); a
/// file that was there stays as it was.
void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);
inline void write_file(const std::filesystem::path& path, std::string_view contents) { write_file(path, {contents}); }

/// The bytes of a regular file. Throws FileError with path and reason.
std::string read_file(const std::filesystem::path& path);

/// "cannot VERB 'PATH': REASON", with advice for the reasons a user can mend. `error` is an errno.
std::string file_error_sentence(std::string_view verb, const std::filesystem::path& path, int error);

}   // namespace patency
