// SPDX-License-Identifier: Apache-2.0
// Reading kept results, and fingerprints by which they are known again. Written with stages/result_files.h.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patency {

/// The whole file. @throws FileError.
std::string read_result(const std::filesystem::path& path);
void make_result_folder(const std::filesystem::path& path);   ///< @throws FileError

/// 16 hexadecimal digits: FNV-1a of 64 bits. Notices edits; protects against nobody.
std::string fingerprint(std::string_view bytes);

}  // namespace patency
