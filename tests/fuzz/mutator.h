// SPDX-License-Identifier: Apache-2.0
// Damage for files: the same for the same number.
#pragma once

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <string_view>

namespace patency {

class Mutator {
public:
    explicit Mutator(unsigned number) : random_(number) {}

    /// One to eight blows.
    std::string operator()(std::string bytes) {
        for (std::size_t blows = 1 + below(8); blows > 0; --blows) strike(bytes);
        return bytes;
    }

private:
    std::size_t below(std::size_t count) { return random_() % std::max<std::size_t>(count, 1); }

    void strike(std::string& bytes) {
        if (bytes.empty()) return;
        // Every second blow falls on the start, where headers are.
        const std::size_t at = below(below(2) ? bytes.size() : std::min<std::size_t>(bytes.size(), 600));
        switch (below(9)) {
            case 0: bytes[at] = char(random_()); break;
            case 1: bytes[at] = char(bytes[at] ^ (1 << below(8))); break;
            case 2: bytes.erase(at, 1 + below(16)); break;
            case 3: bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(64))); break;
            case 4:
                if (below(4) == 0) bytes.resize(at);
                break;
            case 5: replace_number(bytes, at); break;
            case 6: overwrite(bytes, at); break;
            case 7: swap_lines(bytes, at); break;
            case 8: bytes.insert(at, std::string(1 + below(below(8) ? 8 : 5000), bytes[at])); break;
        }
    }

    /// The digits at or after a place become a number that programs stumble over.
    void replace_number(std::string& bytes, std::size_t at) {
        constexpr std::string_view numbers[] = {"0",          "-1",         "1",          "2147483647",
                                                "2147483648", "4294967295", "4294967296", "9223372036854775807",
                                                "1e30",       "1e308",      "-1e9",       "18446744073709551615",
                                                "nan",        "-inf",       "1e-300",     "65536"};
        const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.'; };
        while (at < bytes.size() && !is_digit(bytes[at])) ++at;
        std::size_t end = at;
        while (end < bytes.size() && is_digit(bytes[end])) ++end;
        bytes.replace(at, end - at, numbers[below(std::size(numbers))]);
    }

    /// Four bytes become a binary number of that kind.
    void overwrite(std::string& bytes, std::size_t at) {
        constexpr std::uint32_t numbers[] = {0,          1,          0x7fffffff, 0x80000000, 0xffffffff,
                                             0x7f800000, 0xffc00000, 0x00010000, 0x7f7fffff};
        const std::uint32_t number = numbers[below(std::size(numbers))];
        if (at + sizeof number <= bytes.size()) std::memcpy(bytes.data() + at, &number, sizeof number);
    }

    void swap_lines(std::string& bytes, std::size_t at) {
        const std::size_t first = bytes.find('\n', at),
                          second = first == bytes.npos ? first : bytes.find('\n', first + 1);
        if (second != bytes.npos)
            std::rotate(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(first) + 1,
                        bytes.begin() + std::ptrdiff_t(second) + 1);
    }

    std::mt19937 random_;
};

}   // namespace patency
