// SPDX-License-Identifier: Apache-2.0
#include "patency/io/hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"

namespace patency {
namespace {

static_assert(std::endian::native == std::endian::little, "words are read as the machine has them");

// The specification's five primes.
constexpr std::uint64_t prime_1 = 0x9E3779B185EBCA87u, prime_2 = 0xC2B2AE3D27D4EB4Fu, prime_3 = 0x165667B19E3779F9u,
                        prime_4 = 0x85EBCA77C2B2AE63u, prime_5 = 0x27D4EB2F165667C5u;
static_assert(prime_1 + prime_2 == 0x60EA27EEADC0B5D6u && 0 - prime_1 == 0x61C8864E7A143579u, "initial lanes");

template <class Word>
Word load(const char* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

std::uint64_t mix(std::uint64_t lane, std::uint64_t word) { return std::rotl(lane + word * prime_2, 31) * prime_1; }

}   // namespace

void Hash::add_stripe(const char* bytes) {
    for (std::size_t i = 0; i < lanes_.size(); ++i) lanes_[i] = mix(lanes_[i], load<std::uint64_t>(bytes + 8 * i));
}

void Hash::add(std::string_view bytes) {
    const std::size_t filled = size_ % rest_.size();
    size_ += bytes.size();
    if (filled > 0) {
        const std::size_t count = std::min(bytes.size(), rest_.size() - filled);
        std::copy_n(bytes.data(), count, rest_.data() + filled);
        bytes.remove_prefix(count);
        if (filled + count < rest_.size()) return;
        add_stripe(rest_.data());
    }
    for (; bytes.size() >= rest_.size(); bytes.remove_prefix(rest_.size())) add_stripe(bytes.data());
    std::copy(bytes.begin(), bytes.end(), rest_.begin());
}

std::uint64_t Hash::value() const {
    std::uint64_t h = prime_5;
    if (size_ >= rest_.size()) {
        h = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) + std::rotl(lanes_[3], 18);
        for (std::uint64_t lane : lanes_) h = (h ^ mix(0, lane)) * prime_1 + prime_4;
    }
    h += size_;
    const char* at = rest_.data();
    const char* const end = at + size_ % rest_.size();
    for (; end - at >= 8; at += 8) h = std::rotl(h ^ mix(0, load<std::uint64_t>(at)), 27) * prime_1 + prime_4;
    for (; end - at >= 4; at += 4) h = std::rotl(h ^ load<std::uint32_t>(at) * prime_1, 23) * prime_2 + prime_3;
    for (; at < end; ++at) h = std::rotl(h ^ load<std::uint8_t>(at) * prime_5, 11) * prime_1;
    h = (h ^ h >> 33) * prime_2;
    h = (h ^ h >> 29) * prime_3;
    return h ^ h >> 32;
}

std::uint64_t hash_bytes(std::string_view bytes) {
    Hash hash;
    hash.add(bytes);
    return hash.value();
}

std::uint64_t hash_file(const std::filesystem::path& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), &std::fclose);
    if (!file) throw FileError(file_error_sentence("read", path, errno));
    Hash hash;
    std::vector<char> buffer(1 << 20);
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get()))
        hash.add({buffer.data(), count});
    if (std::ferror(file.get())) throw FileError(file_error_sentence("read", path, errno));
    return hash.value();
}

std::string hex_text(std::uint64_t value) { return fmt::format("{:016x}", value); }

}   // namespace patency
