// SPDX-License-Identifier: Apache-2.0
// PLY, text and binary. Not read by VTK, which reads past the end of a file that is cut short.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "patency/base/text.h"
#include "patency/io/surface_formats.h"

namespace patency {

namespace {

enum class Number { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr std::pair<std::string_view, Number> number_names[] = {
    {"char", Number::int8},      {"int8", Number::int8},       {"uchar", Number::uint8},
    {"uint8", Number::uint8},    {"short", Number::int16},     {"int16", Number::int16},
    {"ushort", Number::uint16},  {"uint16", Number::uint16},   {"int", Number::int32},
    {"int32", Number::int32},    {"uint", Number::uint32},     {"uint32", Number::uint32},
    {"float", Number::float32},  {"float32", Number::float32}, {"double", Number::float64},
    {"float64", Number::float64}};

struct Property {
    std::string name;
    Number type;
    std::optional<Number> length{};   ///< of a list: the type of its length
};
struct Element {
    std::string name;
    double count;
    std::vector<Property> properties{};
};

class PlyReader {
public:
    explicit PlyReader(const SurfaceBytes& file) : file_(file), lines_(file.bytes) {}

    Surface read() {
        read_header();
        rest_ = lines_.rest();
        for (const Element& element : elements_) {
            if (element.properties.empty()) continue;   // its items are nothing, however many it says they are
            // Every item takes a byte at least, so a count beyond the rest of the file is a lie that would cost memory.
            if (element.count > double(rest_.size())) refuse_end(element);
            for (double k = 0; k < element.count; ++k) read_item(element);
        }
        return std::move(surface_);
    }

private:
    [[noreturn]] void refuse(std::string_view what) {
        refuse_file(file_, fmt::format("line {}: {}.", lines_.number(), what));
    }
    [[noreturn]] void refuse_end(const Element& element) {
        refuse_file(file_,
                    fmt::format("it ends within its {:.0f} items '{}': it is cut short. Copy or export it again.",
                                element.count, shortened(element.name)));
    }

    Number number_type(std::string_view word) {
        for (const auto& [name, type] : number_names)
            if (word == name) return type;
        refuse(fmt::format("{} is no type of PLY", double_quoted(shortened(word))));
    }

    void read_header() {
        lines_.next();   // "ply", as the caller saw
        while (const auto line = lines_.next()) {
            std::string_view rest = *line;
            const std::string_view word = next_word(rest);
            if (word == "end_header") return;
            if (word == "comment") {
                if (surface_.space.empty()) surface_.space = space_mark(rest);
            } else if (word == "format") {
                const std::string_view format = next_word(rest);
                is_text_ = format == "ascii";
                is_swapped_ = format == "binary_big_endian";
                if (!is_text_ && !is_swapped_ && format != "binary_little_endian")
                    refuse("this format of PLY is unknown");
            } else if (word == "element") {
                const std::string name(next_word(rest));
                const auto count = read_number(next_word(rest));
                if (!count || !(*count >= 0)) refuse("an element needs a name and a number");
                elements_.push_back({name, *count});
            } else if (word == "property") {
                if (elements_.empty()) refuse("a property belongs to an element");
                std::string_view type = next_word(rest);
                Property property{};
                if (type == "list") {
                    property.length = number_type(next_word(rest));
                    type = next_word(rest);
                }
                property.type = number_type(type);
                property.name = next_word(rest);
                elements_.back().properties.push_back(std::move(property));
            }
        }
        refuse("the header has no end_header");
    }

    template <class T>
    double take(const Element& element) {
        if (rest_.size() < sizeof(T)) refuse_end(element);
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), rest_.data(), sizeof(T));
        rest_.remove_prefix(sizeof(T));
        if (is_swapped_) std::reverse(bytes.begin(), bytes.end());
        return double(std::bit_cast<T>(bytes));
    }

    double read_value(const Element& element, Number type) {
        if (is_text_) {
            const std::string_view word = next_word(rest_);
            if (word.empty()) refuse_end(element);
            const auto value = read_number(word);
            if (!value)
                refuse_file(file_, fmt::format("{} among its items '{}' is no number.", double_quoted(shortened(word)),
                                               shortened(element.name)));
            return *value;
        }
        switch (type) {
            case Number::int8: return take<std::int8_t>(element);
            case Number::uint8: return take<std::uint8_t>(element);
            case Number::int16: return take<std::int16_t>(element);
            case Number::uint16: return take<std::uint16_t>(element);
            case Number::int32: return take<std::int32_t>(element);
            case Number::uint32: return take<std::uint32_t>(element);
            case Number::float32: return take<float>(element);
            case Number::float64: break;
        }
        return take<double>(element);
    }

    void read_item(const Element& element) {
        Vec3 point{};
        for (const Property& property : element.properties) {
            if (property.length) {
                const double length = read_value(element, *property.length);
                if (!(length >= 0 && length <= double(rest_.size()))) refuse_end(element);
                corners_.clear();
                for (double k = 0; k < length; ++k) {
                    const double index = read_value(element, property.type);
                    // What cannot be an index becomes one that no surface has; the check of indices says so.
                    corners_.push_back(index >= 0 && index < 4e9 ? std::uint32_t(index) : ~0u);
                }
                if (element.name == "face" && property.name.starts_with("vertex_ind")) add_polygon(surface_, corners_);
                continue;
            }
            const double value = read_value(element, property.type);
            if (property.name == "x") point.x = value;
            if (property.name == "y") point.y = value;
            if (property.name == "z") point.z = value;
        }
        if (element.name == "vertex") surface_.points.push_back(point);
    }

    const SurfaceBytes& file_;
    Lines lines_;
    std::string_view rest_;
    std::vector<Element> elements_;
    std::vector<std::uint32_t> corners_;
    bool is_text_ = true, is_swapped_ = false;
    Surface surface_;
};

}   // namespace

Surface parse_ply(const SurfaceBytes& file) { return PlyReader(file).read(); }

}   // namespace patency
