// SPDX-License-Identifier: Apache-2.0
#include "patency/io/image_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "patency/base/text.h"
#include "patency/io/atomic_file.h"
#include "patency/io/surface_formats.h"

namespace patency {

namespace {

constexpr double mm = 1e-3;
constexpr std::size_t nifti_header = 352;   // bytes, with the four that say whether extensions follow
constexpr double densest = 1100;            // zlib packs 1032 bytes into one at best
constexpr std::int64_t most_points = std::int64_t(1) << 31;

enum class Element { i8, u8, i16, u16, i32, u32, f32, f64 };
std::size_t size_of(Element element) {
    switch (element) {
        case Element::i8:
        case Element::u8: return 1;
        case Element::i16:
        case Element::u16: return 2;
        case Element::f64: return 8;
        default: return 4;
    }
}

template <class T>
T number_at(std::string_view bytes, std::size_t at, bool is_swapped) {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes.data() + at, sizeof(T));
    if (is_swapped) std::reverse(raw, raw + sizeof(T));
    return std::bit_cast<T>(raw);
}

template <class T>
void append_numbers(std::string_view bytes, std::size_t count, bool is_swapped, std::vector<float>& values) {
    for (std::size_t n = 0; n < count; ++n) values.push_back(float(number_at<T>(bytes, n * sizeof(T), is_swapped)));
}

/// The first `count` bytes of what gzip or zlib packed; fewer if it has not that many.
std::string unpacked(const SurfaceBytes& file, std::string_view packed, std::size_t count) {
    if (double(count) > densest * double(packed.size()) + 1e6)
        refuse_file(
            file,
            "its header asks for more numbers than it can hold: it is damaged or cut short. Copy or export it again.");
    std::string bytes(count, '\0');
    z_stream stream{};
    constexpr int either = 15 + 32;   // gzip or zlib
    if (inflateInit2(&stream, either) != Z_OK) refuse_file(file, "there is no memory to unpack it.");
    std::size_t in = 0, out = 0;
    int state = Z_OK;
    while (state == Z_OK && out < count) {
        constexpr std::size_t portion = 1 << 30;   // zlib counts in int
        const std::size_t give = std::min(portion, packed.size() - in), take = std::min(portion, count - out);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));
        stream.avail_in = uInt(give);
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + out);
        stream.avail_out = uInt(take);
        state = inflate(&stream, Z_NO_FLUSH);
        in += give - stream.avail_in, out += take - stream.avail_out;
        if (give == stream.avail_in && take == stream.avail_out) break;   // nothing moves any more
    }
    inflateEnd(&stream);
    bytes.resize(out);
    return bytes;
}

/// What a header says of the numbers that follow.
struct Contents {
    Element element = Element::u8;
    bool is_swapped = false, is_packed = false;
    double slope = 1, intercept = 0;
};

void expect_size(const SurfaceBytes& file, const Image& image) {
    double points = 1;
    for (int n : image.size) {
        if (n < 2)
            refuse_file(file, fmt::format("it is {} x {} x {} points large: a volume is needed.", image.size[0],
                                          image.size[1], image.size[2]));
        points *= n;
    }
    if (points > double(most_points))
        refuse_file(file, "it has more than two thousand million points. Crop it to the vessel.");
}

void read_values(const SurfaceBytes& file, std::string_view data, const Contents& contents, Image& image) {
    expect_size(file, image);
    const std::size_t count = std::size_t(image.size[0]) * image.size[1] * image.size[2],
                      length = count * size_of(contents.element);
    std::string own;
    if (contents.is_packed) data = own = unpacked(file, data, length);
    if (data.size() < length)
        refuse_file(file, fmt::format("it has {} of the {} bytes that its header promises: it is damaged or cut short. "
                                      "Copy or export it again.",
                                      data.size(), length));
    image.values.reserve(count);
    const bool swap = contents.is_swapped;
    switch (contents.element) {
        case Element::i8: append_numbers<std::int8_t>(data, count, swap, image.values); break;
        case Element::u8: append_numbers<std::uint8_t>(data, count, swap, image.values); break;
        case Element::i16: append_numbers<std::int16_t>(data, count, swap, image.values); break;
        case Element::u16: append_numbers<std::uint16_t>(data, count, swap, image.values); break;
        case Element::i32: append_numbers<std::int32_t>(data, count, swap, image.values); break;
        case Element::u32: append_numbers<std::uint32_t>(data, count, swap, image.values); break;
        case Element::f32: append_numbers<float>(data, count, swap, image.values); break;
        case Element::f64: append_numbers<double>(data, count, swap, image.values); break;
    }
    for (float& value : image.values) {
        value = float(contents.slope * double(value) + contents.intercept);
        if (!std::isfinite(value)) refuse_file(file, "some of its values are no numbers. Export it again.");
    }
    const double cell = determinant(image.step);
    constexpr double smallest = 1e-18, largest = 1;   // m^3: a micrometre, a metre
    if (!(std::abs(cell) > smallest && std::abs(cell) < largest) || !(norm(image.origin) < 1e3))
        refuse_file(file, "its axes, spacing or origin are no place in a body. Export it again.");
}

/// A header of lines "key SEPARATOR value" up to a key or an empty line that ends it; `rest` is what follows.
struct TextHeader {
    std::map<std::string, std::string> values;
    std::string_view rest;

    std::string get(std::initializer_list<const char*> keys) const {
        for (const char* key : keys)
            if (const auto found = values.find(key); found != values.end()) return found->second;
        return "";
    }
};
TextHeader read_header(std::string_view bytes, std::string_view separator, std::string_view last_key) {
    TextHeader header;
    Lines lines(bytes);
    constexpr std::size_t most_lines = 10000;
    while (lines.number() < most_lines) {
        const auto line = lines.next();
        if (!line) break;
        if (last_key.empty() && trimmed(*line).empty()) break;
        const std::size_t at = line->find(separator);
        if (at == line->npos) continue;
        const std::string key(trimmed(line->substr(0, at)));
        header.values[key] = std::string(trimmed(line->substr(at + separator.size())));
        if (key == last_key) break;
    }
    header.rest = lines.rest();
    return header;
}

/// All numbers of a text, whatever brackets and commas are between.
std::vector<double> numbers_in(std::string text) {
    for (char& c : text)
        if (c == '(' || c == ')' || c == ',') c = ' ';
    std::vector<double> numbers;
    std::string_view rest = text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        const auto number = read_number(word);
        if (!number) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

std::vector<double> expect_numbers(const SurfaceBytes& file, const std::string& text, std::size_t count,
                                   std::string_view what) {
    std::vector<double> numbers = numbers_in(text);
    if (numbers.size() != count) refuse_file(file, fmt::format("its header needs {} numbers as {}.", count, what));
    return numbers;
}

void set_size(const SurfaceBytes& file, const std::vector<double>& size, Image& image) {
    for (int k = 0; k < 3; ++k) {
        if (!(size[k] >= 1 && size[k] <= 1e6) || size[k] != std::floor(size[k]))
            refuse_file(file, "its size is no size of an image.");
        image.size[k] = int(size[k]);
    }
}

/// Columns from three vectors one after another.
Mat3 columns_of(const std::vector<double>& n) {
    return transpose(Mat3{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}});
}

Element find_element(const SurfaceBytes& file, const std::string& name, const std::map<std::string, Element>& known) {
    const auto found = known.find(name);
    if (found == known.end())
        refuse_file(file,
                    fmt::format("its numbers are of the type '{}', which no label map here has.", shortened(name)));
    return found->second;
}

constexpr bool is_big_endian_machine = std::endian::native == std::endian::big;

/// NIfTI-1: https://nifti.nimh.nih.gov/pub/dist/src/niftilib/nifti1.h
Image parse_nifti(const SurfaceBytes& file) {
    const bool is_packed = file.bytes.starts_with("\x1f\x8b");
    const std::string header =
        is_packed ? unpacked(file, file.bytes, nifti_header) : std::string(file.bytes.substr(0, nifti_header));
    if (header.size() < nifti_header) refuse_file(file, "it is cut short within its header. Copy or export it again.");
    constexpr int header_length = 348;
    const bool swap = number_at<std::int32_t>(header, 0, false) != header_length;
    const auto i16 = [&](std::size_t at) { return number_at<std::int16_t>(header, at, swap); };
    const auto f32 = [&](std::size_t at) { return double(number_at<float>(header, at, swap)); };
    if (number_at<std::int32_t>(header, 0, swap) != header_length || header.substr(344, 3) != "n+1")
        refuse_file(file,
                    "it is no NIfTI-1 image in one file (NIfTI-2 and pairs of .hdr and .img are not read). Export it "
                    "as .nii.gz.");
    const int dimensions = i16(40);
    for (int k = 4; k <= std::min(dimensions, 7); ++k)
        if (i16(40 + 2 * std::size_t(k)) > 1)
            refuse_file(file, "it has more than one volume. Export the one with the labels.");
    if (dimensions < 3 || dimensions > 7) refuse_file(file, "it has no three dimensions.");
    Image image;
    image.space = "RAS";
    set_size(file, {double(i16(42)), double(i16(44)), double(i16(46))}, image);
    const std::map<int, Element> known = {{2, Element::u8},    {4, Element::i16},  {8, Element::i32},
                                          {16, Element::f32},  {64, Element::f64}, {256, Element::i8},
                                          {512, Element::u16}, {768, Element::u32}};
    const auto element = known.find(i16(70));
    if (element == known.end())
        refuse_file(file, fmt::format("its numbers are of the type {}, which no label map here has.", i16(70)));
    Contents contents{.element = element->second, .is_swapped = swap};
    if (f32(112) != 0 && std::isfinite(f32(112) + f32(116))) contents.slope = f32(112), contents.intercept = f32(116);

    const int unit_code = header[123] & 7;
    const double unit = unit_code == 1 ? 1 : unit_code == 3 ? 1e-6 : mm;
    const Vec3 spacing{f32(80), f32(84), f32(88)};
    if (i16(254) > 0) {   // sform: the rows of an affine map
        const auto row = [&](std::size_t at) { return Vec3{f32(at), f32(at + 4), f32(at + 8)}; };
        image.step = {row(280), row(296), row(312)};
        image.origin = {f32(292), f32(308), f32(324)};
    } else if (i16(252) > 0) {   // qform: a rotation as a quaternion
        const double b = f32(256), c = f32(260), d = f32(264), a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
        const double flip = f32(76) < 0 ? -1 : 1;   // of the third axis
        const Mat3 turn{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                        {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                        {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}};
        image.step = turn * Mat3{{spacing.x, 0, 0}, {0, spacing.y, 0}, {0, 0, flip * spacing.z}};
        image.origin = {f32(268), f32(272), f32(276)};
    } else {
        image.step = {{spacing.x, 0, 0}, {0, spacing.y, 0}, {0, 0, spacing.z}};
    }
    image.step = unit * image.step;
    image.origin *= unit;
    const double start = f32(108);
    if (!(start >= nifti_header && start < 1e6))
        refuse_file(file, "its header does not say where its numbers begin. Export it again.");
    expect_size(file, image);
    const std::size_t first = std::size_t(start);
    const std::size_t length = std::size_t(image.size[0]) * image.size[1] * image.size[2] * size_of(contents.element);
    const std::string own = is_packed ? unpacked(file, file.bytes, first + length) : "";
    const std::string_view all = is_packed ? std::string_view(own) : file.bytes;
    read_values(file, all.substr(std::min(first, all.size())), contents, image);
    return image;
}

/// NRRD: https://teem.sourceforge.net/nrrd/format.html
Image parse_nrrd(const SurfaceBytes& file) {
    const TextHeader header = read_header(file.bytes, ":", "");
    Image image;
    if (header.get({"dimension"}) != "3")
        refuse_file(file, "it has not three dimensions but '" + shortened(header.get({"dimension"})) +
                              "'. Export one label map (in Slicer: as a label map volume).");
    if (!header.get({"data file", "datafile"}).empty())
        refuse_file(file, "its numbers are in another file. Save it as one .nrrd file.");
    set_size(file, expect_numbers(file, header.get({"sizes"}), 3, "sizes"), image);
    const std::string space = header.get({"space"});
    if (space == "left-posterior-superior" || space == "LPS")
        image.space = "LPS";
    else if (space == "right-anterior-superior" || space == "RAS")
        image.space = "RAS";
    else if (!space.empty())
        refuse_file(file, "its space is '" + shortened(space) + "'; only LPS and RAS are read.");
    const std::string directions = header.get({"space directions"}), spacings = header.get({"spacings"}),
                      origin = header.get({"space origin"});
    if (!directions.empty()) {
        image.step = columns_of(expect_numbers(file, directions, 9, "space directions"));
    } else {
        const auto s = spacings.empty() ? std::vector<double>{1, 1, 1} : expect_numbers(file, spacings, 3, "spacings");
        image.step = {{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}};
    }
    if (!origin.empty()) {
        const auto o = expect_numbers(file, origin, 3, "space origin");
        image.origin = {o[0], o[1], o[2]};
    }
    image.step = mm * image.step;
    image.origin *= mm;
    using enum Element;
    const std::map<std::string, Element> known = {
        {"signed char", i8},   {"int8", i8},    {"int8_t", i8},    {"unsigned char", u8},
        {"uchar", u8},         {"uint8", u8},   {"uint8_t", u8},   {"short", i16},
        {"signed short", i16}, {"int16", i16},  {"int16_t", i16},  {"unsigned short", u16},
        {"ushort", u16},       {"uint16", u16}, {"uint16_t", u16}, {"int", i32},
        {"signed int", i32},   {"int32", i32},  {"int32_t", i32},  {"unsigned int", u32},
        {"uint", u32},         {"uint32", u32}, {"uint32_t", u32}, {"float", f32},
        {"double", f64}};
    Contents contents{.element = find_element(file, header.get({"type"}), known)};
    const std::string encoding = header.get({"encoding"});
    contents.is_packed = encoding == "gzip" || encoding == "gz";
    if (!contents.is_packed && encoding != "raw")
        refuse_file(file, "its encoding is '" + shortened(encoding) + "'; raw and gzip are read.");
    contents.is_swapped = (header.get({"endian"}) == "big") != is_big_endian_machine && size_of(contents.element) > 1 &&
                          header.get({"endian"}) != "little";
    read_values(file, header.rest, contents, image);
    return image;
}

/// MetaImage: https://itk.org/Wiki/ITK/MetaIO/Documentation. Coordinates are LPS, the matrix has the axes' directions one after another.
Image parse_meta(const SurfaceBytes& file) {
    const TextHeader header = read_header(file.bytes, "=", "ElementDataFile");
    Image image;
    image.space = "LPS";
    if (header.get({"NDims"}) != "3") refuse_file(file, "it has not three dimensions. Export one label map.");
    const std::string channels = header.get({"ElementNumberOfChannels"});
    if (!channels.empty() && channels != "1")
        refuse_file(file, "it has several numbers per point. Export one label map.");
    if (const std::string skipped = header.get({"HeaderSize"}); !skipped.empty() && skipped != "0")
        refuse_file(file, "its numbers begin at a HeaderSize, which is not read. Save it as .mha.");
    set_size(file, expect_numbers(file, header.get({"DimSize"}), 3, "DimSize"), image);
    const std::string spacing = header.get({"ElementSpacing", "ElementSize"}),
                      matrix = header.get({"TransformMatrix", "Rotation", "Orientation"}),
                      origin = header.get({"Offset", "Position", "Origin"});
    const auto s = spacing.empty() ? std::vector<double>{1, 1, 1} : expect_numbers(file, spacing, 3, "ElementSpacing");
    image.step = mm * Mat3{{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}};
    if (!matrix.empty()) image.step = columns_of(expect_numbers(file, matrix, 9, "TransformMatrix")) * image.step;
    if (!origin.empty()) {
        const auto o = expect_numbers(file, origin, 3, "Offset");
        image.origin = mm * Vec3{o[0], o[1], o[2]};
    }
    using enum Element;
    const std::map<std::string, Element> known = {{"MET_CHAR", i8},    {"MET_UCHAR", u8},  {"MET_SHORT", i16},
                                                  {"MET_USHORT", u16}, {"MET_INT", i32},   {"MET_UINT", u32},
                                                  {"MET_FLOAT", f32},  {"MET_DOUBLE", f64}};
    const bool is_big = header.get({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}) == "True";
    const Contents contents{.element = find_element(file, header.get({"ElementType"}), known),
                            .is_swapped = is_big != is_big_endian_machine,
                            .is_packed = header.get({"CompressedData"}) == "True"};
    const std::string name = header.get({"ElementDataFile"});
    if (name == "LOCAL" || name == "Local" || name == "local") {
        read_values(file, header.rest, contents, image);
    } else {
        if (name.empty() || name == "LIST" || name.find('%') != name.npos)
            refuse_file(file, "it does not name the one file with its numbers. Save it as .mha.");
        const std::string data = read_file(file.path.parent_path() / name);
        read_values(file, data, contents, image);
    }
    return image;
}

bool is_nifti(std::string_view bytes) { return bytes.size() > 348 && bytes.substr(344, 3) == "n+1"; }
bool is_meta(std::string_view bytes) {
    const std::string_view start = bytes.substr(0, 4096);
    return (start.starts_with("ObjectType") || start.starts_with("NDims") || start.starts_with("Comment")) &&
           start.find("DimSize") != start.npos;
}

}   // namespace

bool is_image(std::string_view bytes) {
    return bytes.starts_with("\x1f\x8b") || bytes.starts_with("NRRD000") || is_nifti(bytes) || is_meta(bytes);
}

Image parse_image(const std::filesystem::path& path, std::string_view bytes) {
    const SurfaceBytes file{path, bytes};
    if (bytes.starts_with("NRRD000")) return parse_nrrd(file);
    return is_meta(bytes) ? parse_meta(file) : parse_nifti(file);
}

}   // namespace patency
