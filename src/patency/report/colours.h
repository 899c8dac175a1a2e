// SPDX-License-Identifier: Apache-2.0
// The page's one colour scale, and the colours of its curves.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace patency {

/// A share from 0 to 1 as red, green and blue: dark violet, blue, green, yellow; lightness rises evenly, so that it reads the same
/// in grey and with any colour vision. Polynomials fitted to viridis (S. van der Walt and N. Smith, 2015) by M. Zucker, both CC0.
inline std::array<std::uint8_t, 3> colour_of(double share) {
    constexpr double fit[7][3] = {{0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
                                  {0.1050930431085774, 1.404613529898575, 1.384590162594685},
                                  {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
                                  {-4.634230498983486, -5.799100973351585, -19.33244095627987},
                                  {6.228269936347081, 14.17993336680509, 56.69055260068105},
                                  {4.776384997670288, -13.74514537774601, -65.35303263337234},
                                  {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
    const double t = std::clamp(share, 0.0, 1.0);
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t c = 0; c < 3; ++c) {
        double value = 0;
        for (int power = 6; power >= 0; --power) value = value * t + fit[power][c];
        colour[c] = std::uint8_t(std::clamp(255 * value + 0.5, 0.0, 255.0));
    }
    return colour;
}

}   // namespace patency
