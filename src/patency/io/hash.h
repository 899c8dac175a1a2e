// SPDX-License-Identifier: Apache-2.0
// Fingerprints of bytes and files: XXH64 with seed 0, the figure `xxhsum -H64` prints. They notice
// accidents and edits; they are no protection against somebody who forges files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace patency {

/// XXH64 of bytes that come in pieces; the answer does not depend on how they are cut.
/// Source: the xxHash specification (Y. Collet), "XXH64 algorithm description".
class Hash {
public:
    void add(std::string_view bytes);
    std::uint64_t value() const;

private:
    void add_stripe(const char* bytes);

    std::array<std::uint64_t, 4> lanes_ = {0x60EA27EEADC0B5D6u, 0xC2B2AE3D27D4EB4Fu, 0, 0x61C8864E7A143579u};
    std::array<char, 32> rest_{};   // bytes that do not fill a stripe yet
    std::uint64_t size_ = 0;
};

std::uint64_t hash_bytes(std::string_view bytes);
/// Throws FileError when the file cannot be read.
std::uint64_t hash_file(const std::filesystem::path& path);
/// 16 lower-case digits.
std::string hex_text(std::uint64_t value);

}   // namespace patency
