// SPDX-License-Identifier: Apache-2.0
#include "patency/io/encode.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>

namespace patency {
namespace {

std::string inflated(const std::string& packed, std::size_t size) {
    std::string result(size, '\0');
    uLongf length = size;
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(result.data()), &length,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
              Z_OK);
    EXPECT_EQ(length, size);
    return result;
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | std::uint8_t(bytes[at + k]);
    return value;
}

TEST(Encode, Base64IsThatOfTheStandard) {   // RFC 4648, section 10
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64(std::string("\xff\xfe\x00\x3f", 4)), "//4APw==");
}

TEST(Encode, WhatIsDeflatedInflatesToTheSame) {
    std::string text(100'000, ' ');
    for (std::size_t k = 0; k < text.size(); ++k) text[k] = char(k * k % 251);
    const std::string packed = deflated(text);
    EXPECT_LT(packed.size(), text.size() / 2);
    EXPECT_EQ(inflated(packed, text.size()), text);
    EXPECT_EQ(inflated(deflated(""), 0), "");
}

/// A picture, chunk by chunk: checksums hold, and the rows give the pixels again once the filter is undone.
TEST(Encode, PngHoldsThePixels) {
    Bitmap image{.width = 3, .height = 2};
    for (int k = 0; k < 24; ++k) image.rgba.push_back(std::uint8_t(k * 37));
    const std::string file = png(image);
    ASSERT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
    std::string pixels;
    for (std::size_t at = 8; at < file.size(); at += 12 + number_at(file, at)) {
        const std::string named = file.substr(at + 4, 4 + number_at(file, at));
        EXPECT_EQ(number_at(file, at + 8 + number_at(file, at)),
                  crc32(0, reinterpret_cast<const Bytef*>(named.data()), uInt(named.size())));
        if (named.starts_with("IHDR")) {
            EXPECT_EQ(number_at(named, 4), 3u);
            EXPECT_EQ(number_at(named, 8), 2u);
        }
        if (named.starts_with("IDAT")) pixels = inflated(named.substr(4), 2 * (1 + 12));
    }
    for (std::size_t y = 0; y < 2; ++y) {
        std::uint8_t before[4] = {};
        for (std::size_t k = 0; k < 12; ++k) {
            before[k % 4] = std::uint8_t(before[k % 4] + std::uint8_t(pixels[y * 13 + 1 + k]));
            EXPECT_EQ(before[k % 4], image.rgba[12 * y + k]) << y << " " << k;
        }
    }
}

}   // namespace
}   // namespace patency
