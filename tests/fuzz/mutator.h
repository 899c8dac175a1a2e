// SPDX-License-Identifier: Apache-2.0
// Damage for files: the same for the same number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <utility>

namespace patency {

class Mutator {
public:
    explicit Mutator(unsigned number) : random_(number) {}

    /// `other` is a file of the same kind, of which pieces may be taken. Half of the files keep their form, so that the
    /// damage gets past the reader; the others have one to eight blows.
    std::string operator()(std::string bytes, std::string_view other) {
        const bool keeps_form = below(2) == 0;
        for (std::size_t blows = 1 + below(below(2) ? 8 : 2); blows > 0; --blows)
            if (keeps_form)
                touch(bytes);
            else
                strike(bytes, other);
        return bytes;
    }

private:
    std::size_t below(std::size_t count) { return random_() % std::max<std::size_t>(count, 1); }

    void strike(std::string& bytes, std::string_view other) {
        if (bytes.empty()) return;
        // Every second blow falls on the start, where headers are.
        const std::size_t at = below(below(2) ? bytes.size() : std::min<std::size_t>(bytes.size(), 600));
        switch (below(12)) {
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
            case 9: swap_words(bytes, at, {}); break;
            case 10: splice(bytes, at, other); break;
            case 11: insert_mark(bytes, at); break;
        }
    }

    /// Other values in their places.
    void touch(std::string& bytes) {
        if (bytes.empty()) return;
        const std::size_t at = below(bytes.size());
        if (bytes.find('\0') != bytes.npos) {
            switch (below(3)) {
                case 0: bytes[at] = char(bytes[at] ^ (1 << below(8))); break;
                case 1: overwrite(bytes, at); break;
                case 2: copy_within(bytes, at); break;
            }
            return;
        }
        switch (below(5)) {
            case 0: change_digit(bytes, at); break;
            case 1: replace_number(bytes, at); break;
            case 2: swap_words(bytes, at, "-.0123456789"); break;
            case 3: swap_words(bytes, at, {}); break;
            case 4: repeat_lines(bytes, at); break;
        }
    }

    static bool is_digit(char c) { return c >= '0' && c <= '9'; }

    void change_digit(std::string& bytes, std::size_t at) {
        while (at < bytes.size() && !is_digit(bytes[at])) ++at;
        if (at < bytes.size()) bytes[at] = char('0' + below(10));
    }

    /// Numbers of four bytes, one or three of them, stand in for others: points meet, triangles become flat.
    void copy_within(std::string& bytes, std::size_t at) {
        const std::size_t size = below(2) ? 4 : 12, steps = below(200);
        const std::size_t from = at > steps * size ? at - steps * size : at;   // often on the other's boundary
        if (std::max(at, from) + size <= bytes.size()) bytes.replace(at, size, bytes.substr(from, size));
    }

    /// Some lines go, or come twice. Seven are a facet of STL, wherever they begin.
    void repeat_lines(std::string& bytes, std::size_t at) {
        const std::size_t begin = bytes.find('\n', at);
        std::size_t end = begin;
        for (std::size_t count = below(2) ? 7 : 1 + below(20); count > 0 && end != bytes.npos; --count)
            end = bytes.find('\n', end + 1);
        if (end == bytes.npos) return;
        if (below(2))
            bytes.erase(begin, end - begin);
        else
            bytes.insert(end, bytes.substr(begin, end - begin));
    }

    /// The digits at or after a place become a number that programs stumble over.
    void replace_number(std::string& bytes, std::size_t at) {
        constexpr std::string_view numbers[] = {"0",          "-1",         "1",          "2147483647",
                                                "2147483648", "4294967295", "4294967296", "9223372036854775807",
                                                "1e30",       "1e308",      "-1e9",       "18446744073709551615",
                                                "nan",        "-inf",       "1e-300",     "65536",
                                                "1e5",        "-1e-5",      "1e-160",     "0.0000001"};
        const auto is_of_number = [](char c) { return is_digit(c) || c == '-' || c == '.'; };
        while (at < bytes.size() && !is_of_number(bytes[at])) ++at;
        std::size_t end = at;
        while (end < bytes.size() && is_of_number(bytes[end])) ++end;
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

    /// The word at or after a place becomes another one of the file; both begin with one of these letters, if there are some.
    void swap_words(std::string& bytes, std::size_t at, std::string_view letters) {
        constexpr std::string_view between = " \t\r\n,:{}[]<>\"=";
        const auto word_from = [&](std::size_t place) {
            std::size_t begin = bytes.find_first_not_of(between, place);
            while (begin != bytes.npos && !letters.empty() && letters.find(bytes[begin]) == letters.npos)
                begin = bytes.find_first_not_of(between, bytes.find_first_of(between, begin));
            if (begin == bytes.npos) return std::pair(bytes.size(), std::size_t(0));
            return std::pair(begin, std::min(bytes.find_first_of(between, begin), bytes.size()) - begin);
        };
        const auto [begin, length] = word_from(at);
        const auto [from, size] = word_from(below(bytes.size()));
        bytes.replace(begin, length, bytes.substr(from, std::min<std::size_t>(size, 64)));
    }

    /// A piece of the other file stands in for one here; now and then all that follows.
    void splice(std::string& bytes, std::size_t at, std::string_view other) {
        const std::string_view piece = other.substr(below(other.size()));
        if (below(8) == 0)
            bytes.replace(at, bytes.npos, piece);
        else
            bytes.replace(at, below(64), piece.substr(0, 1 + below(200)));
    }

    /// Marks that mean something in one of the formats.
    void insert_mark(std::string& bytes, std::size_t at) {
        constexpr std::string_view marks[] = {
            "{",   "}",  "[",    "]",        "\"",     "*a ",          "&a ",        "? ",
            ": ",  "- ", "\n",   "\t",       "---\n",  "<<: ",         "!!binary ",  "#",
            "|\n", "\r", "~",    "endsolid", "solid ", "</DataArray>", "<!--",       "&#0;",
            "_",   "-",  "\xff", "null",     "%TAG ",  "vertex ",      "endfacet\n", "\xef\xbb\xbf"};
        bytes.insert(at, marks[below(std::size(marks))]);
    }

    std::mt19937 random_;
};

}   // namespace patency
