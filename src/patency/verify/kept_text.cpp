// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/kept_text.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <sstream>

#include "patency/base/errors.h"

namespace patency {

namespace fs = std::filesystem;

std::string read_result(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw FileError("cannot read '" + path.string() + "'");
    return text.str();
}

void make_result_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw FileError("cannot make the folder '" + path.string() + "': " + error.message());
}

std::string fingerprint(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", hash);
}

}  // namespace patency
