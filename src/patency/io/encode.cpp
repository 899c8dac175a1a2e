// SPDX-License-Identifier: Apache-2.0
#include "patency/io/encode.h"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <new>

namespace patency {

namespace {

std::string big_endian(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16 & 255), char(value >> 8 & 255), char(value & 255)};
}

/// Length, type, data, checksum of type and data.                                        PNG, third edition, 5.3
std::string chunk(std::string_view type, std::string_view data) {
    const std::string checked = std::string(type) + std::string(data);
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()));
    return big_endian(std::uint32_t(data.size())) + checked + big_endian(std::uint32_t(sum));
}

}   // namespace

std::string deflated(std::string_view bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::string result(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  uLong(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw std::bad_alloc();   // the only thing that can go wrong with room enough
    result.resize(size);
    return result;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - k);
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j) bits = bits << 8 | (j < here ? std::uint8_t(bytes[k + j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j) text += j <= here ? letters[bits >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

std::string png(const Bitmap& image) {
    assert(image.rgba.size() == 4 * image.width * image.height && "four numbers per pixel");
    const std::size_t row = 4 * image.width;
    std::string pixels;
    pixels.reserve((row + 1) * image.height);
    for (std::size_t y = 0; y < image.height; ++y) {
        // Each pixel less the one on its left packs smooth pictures to a third.                PNG, 9.2, filter 1
        pixels += '\1';
        for (std::size_t k = 0; k < row; ++k) {
            const std::uint8_t* p = &image.rgba[y * row + k];
            pixels += char(k < 4 ? *p : std::uint8_t(*p - *(p - 4)));
        }
    }
    const std::string header = big_endian(std::uint32_t(image.width)) + big_endian(std::uint32_t(image.height)) +
                               std::string("\x08\x06\x00\x00\x00", 5);   // 8 bits of red, green, blue and opacity
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", deflated(pixels)) + chunk("IEND", "");
}

}   // namespace patency
