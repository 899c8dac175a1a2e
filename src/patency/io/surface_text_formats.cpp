// SPDX-License-Identifier: Apache-2.0
// STL and OBJ, and what the readers of text share. They are read here and not by VTK, whose readers print, take a line
// without its numbers for the origin, and lose solids and comments.
#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <limits>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/io/surface_formats.h"

namespace patency {

namespace {

constexpr std::size_t stl_header = 80, stl_record = 50;   // bytes: header, then normal, three points, two bytes unused

std::uint32_t stl_count(std::string_view bytes) {
    std::uint32_t count = 0;   // little-endian, as are the machines this runs on
    std::memcpy(&count, bytes.data() + stl_header, sizeof count);
    return count;
}

Surface parse_stl_binary(const SurfaceBytes& file) {
    constexpr std::size_t start = stl_header + sizeof(std::uint32_t);
    const std::string_view bytes = file.bytes;
    if (bytes.size() < start)
        refuse_file(file, fmt::format("{} bytes are too few for an STL file. Copy or export it again.", bytes.size()));
    const std::size_t count = stl_count(bytes), fits = (bytes.size() - start) / stl_record;
    if (count != fits || !is_stl_binary(bytes))
        refuse_file(
            file,
            fmt::format(
                "it says that it has {} triangles, but its length is that of {}: it is cut short, damaged, or no STL "
                "file. Copy or export it again.",
                count, fits));
    Surface surface;
    surface.space = space_mark(bytes.substr(0, stl_header));
    for (std::size_t k = 0; k < count; ++k) {
        float numbers[9];
        std::memcpy(numbers, bytes.data() + start + k * stl_record + 3 * sizeof(float), sizeof numbers);
        const auto first = std::uint32_t(surface.points.size());
        for (std::size_t corner = 0; corner < 3; ++corner)
            surface.points.push_back({numbers[3 * corner], numbers[3 * corner + 1], numbers[3 * corner + 2]});
        surface.triangles.push_back({first, first + 1, first + 2});
    }
    return surface;
}

std::string lower(std::string_view word) {
    std::string result(word);
    for (char& c : result) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return result;
}

Surface parse_stl_text(const SurfaceBytes& file) {
    Surface surface;
    std::int32_t solids = 0;
    std::size_t corners = 0;   // of the facet
    bool is_open = false;      // a solid
    Lines lines(file.bytes);
    const auto refuse = [&](std::string_view what) {
        refuse_file(file, fmt::format("line {}: {}.", lines.number(), what));
    };
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string word = lower(next_word(rest));
        if (word == "solid") {
            ++solids;
            is_open = true;
            if (surface.space.empty()) surface.space = space_mark(rest);
        } else if (word == "vertex") {
            const auto point = read_point(rest);
            if (!point) refuse("a vertex needs three numbers");
            surface.points.push_back(*point);
            ++corners;
        } else if (word == "endfacet") {
            if (corners != 3) refuse(fmt::format("a facet needs 3 vertices and has {}", corners));
            const auto end = std::uint32_t(surface.points.size());
            surface.triangles.push_back({end - 3, end - 2, end - 1});
            surface.face_ids.push_back(solids);
            corners = 0;
        } else if (word == "endsolid") {
            is_open = false;
        } else if (!word.empty() && word != "facet" && word != "outer" && word != "endloop") {
            refuse(fmt::format("{} has no place in an STL file", double_quoted(shortened(*line, 40))));
        }
    }
    if (is_open || corners > 0) refuse("the file ends within a solid: it is cut short. Copy or export it again");
    if (solids < 2) surface.face_ids.clear();
    return surface;
}

}   // namespace

std::optional<std::string_view> Lines::next() {
    if (rest_.empty()) return {};
    const std::size_t end = rest_.find_first_of("\r\n");
    const std::string_view line = rest_.substr(0, end);
    const bool is_windows = end != rest_.npos && rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + (is_windows ? 2 : 1));
    ++number_;
    return line;
}

std::string_view next_word(std::string_view& text) {
    constexpr std::string_view space = " \t\r\n\v\f";
    const std::size_t begin = text.find_first_not_of(space);
    if (begin == text.npos) return text = {};
    text.remove_prefix(begin);
    const std::string_view word = text.substr(0, text.find_first_of(space));
    text.remove_prefix(word.size());
    return word;
}

std::optional<double> read_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || end != word.data() + word.size() || error == std::errc::invalid_argument) return {};
    if (error == std::errc::result_out_of_range && word.find_first_of("eE") != word.npos &&
        word.find("e-") == word.npos && word.find("E-") == word.npos)
        return std::numeric_limits<double>::infinity();
    return value;   // 0 for what is smaller than a double can be
}

std::optional<Vec3> read_point(std::string_view text) {
    double numbers[3];
    for (double& number : numbers) {
        const auto value = read_number(next_word(text));
        if (!value) return {};
        number = *value;
    }
    return Vec3{numbers[0], numbers[1], numbers[2]};
}

std::string space_mark(std::string_view comment) {
    for (const char* axes : {"LPS", "RAS"})
        if (comment.find(fmt::format("SPACE={}", axes)) != comment.npos) return axes;
    return {};
}

void add_polygon(Surface& surface, const std::vector<std::uint32_t>& corners) {
    for (std::size_t k = 2; k < corners.size(); ++k)
        surface.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

bool is_stl_text(std::string_view bytes) {
    const std::string_view start = bytes.substr(0, 1024);   // a binary header that begins with "solid" ends within it
    return lower(trimmed(start).substr(0, 5)) == "solid" && start.find('\0') == start.npos && !is_stl_binary(bytes);
}

bool is_stl_binary(std::string_view bytes) {
    constexpr std::size_t start = stl_header + sizeof(std::uint32_t);
    return bytes.size() >= start && bytes.size() == start + stl_record * std::size_t(stl_count(bytes));
}

Surface parse_stl(const SurfaceBytes& file) {
    return is_stl_text(file.bytes) ? parse_stl_text(file) : parse_stl_binary(file);
}

Surface parse_obj(const SurfaceBytes& file) {
    Surface surface;
    Lines lines(file.bytes);
    const auto refuse = [&](std::string_view what) {
        refuse_file(file, fmt::format("line {}: {}.", lines.number(), what));
    };
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string_view word = next_word(rest);
        if (word.starts_with('#') && surface.space.empty()) surface.space = space_mark(*line);
        if (word == "v") {
            const auto point = read_point(rest);
            if (!point) refuse("a vertex needs three numbers");
            surface.points.push_back(*point);
        } else if (word == "f") {
            std::vector<std::uint32_t> corners;
            for (std::string_view corner; !(corner = next_word(rest)).empty();) {
                const auto number = read_number(corner.substr(0, corner.find('/')));
                const auto count = double(surface.points.size());
                // Counted from 1, or backward from the last vertex so far.
                const double index = !number ? -1 : *number < 0 ? count + *number : *number - 1;
                if (!(index >= 0 && index < 4e9) || index != double(std::uint32_t(index)))
                    refuse("a face names a vertex that cannot be");
                corners.push_back(std::uint32_t(index));
            }
            if (corners.size() < 3) refuse("a face needs three vertices");
            add_polygon(surface, corners);
        }
    }
    return surface;
}

}   // namespace patency
