// SPDX-License-Identifier: Apache-2.0
// Bytes as pages carry them: compressed, as text, as pictures.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace patency {

/// The bytes as a zlib stream (RFC 1950), which browsers call "deflate".
std::string deflated(std::string_view bytes);

/// The bytes as base64 (RFC 4648), on one line.
std::string base64(std::string_view bytes);

/// Colours of pixels, rows from the top: red, green, blue and opacity from 0 to 255.
struct Bitmap {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba{};   ///< 4 per pixel
};

/// The picture as the bytes of a PNG file.
std::string png(const Bitmap& image);

}   // namespace patency
