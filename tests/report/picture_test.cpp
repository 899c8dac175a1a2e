// SPDX-License-Identifier: Apache-2.0
#include "patency/report/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "patency/report/colours.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

/// Two squares over each other, the far one twice as wide; low values on the near one, high ones on the far one.
PolyData squares() {
    PolyData data;
    for (const auto& [half, depth] : {std::pair{1.0, 1.0}, {2.0, 0.0}})
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
            data.points.push_back({half * x, half * y, depth});
    data.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    data.arrays = {{"P", "Pa", 1, {0, 0, 0, 0, 1, 1, 1, 1}}};
    return data;
}

std::array<int, 4> pixel(const Bitmap& image, double x, double y) {
    const std::size_t at =
        4 * (std::size_t(y * double(image.height)) * image.width + std::size_t(x * double(image.width)));
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2], image.rgba[at + 3]};
}

void expect_colour(const std::array<int, 4>& seen, const std::array<std::uint8_t, 3>& wanted) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], wanted[c], 1);
    EXPECT_EQ(seen[3], 255);
}

TEST(Picture, TheNearerHidesTheFarther) {
    const PolyData data = squares();
    const Bitmap image = draw_field(
        {.surface = data, .array = "P", .range = {0, 1}, .view = {}, .frame = data, .width = 100, .most_height = 100});
    EXPECT_EQ(image.rgba.size(), 4 * image.width * image.height);
    expect_colour(pixel(image, 0.5, 0.5), colour_of(0));   // faces look at the eye: full light
    expect_colour(pixel(image, 0.2, 0.5), colour_of(1));
    EXPECT_EQ(pixel(image, 0.01, 0.01)[3], 0);   // the margin is transparent
    const View behind{.right = {-1, 0, 0}, .up = {0, 1, 0}, .toward = {0, 0, -1}};
    expect_colour(pixel(draw_field({.surface = data,
                                    .array = "P",
                                    .range = {0, 1},
                                    .view = behind,
                                    .frame = data,
                                    .width = 100,
                                    .most_height = 100}),
                        0.5, 0.5),
                  colour_of(1));
}

TEST(Picture, WithoutAValueTheWallIsGrey) {
    PolyData data = squares();
    data.arrays.push_back({"IsResolved", "1", 1, {0, 0, 0, 0, 1, 1, 1, 1}});
    const auto seen = pixel(draw_field({.surface = data,
                                        .array = "P",
                                        .range = {0, 1},
                                        .view = {},
                                        .frame = data,
                                        .width = 100,
                                        .most_height = 100}),
                            0.5, 0.5);
    EXPECT_EQ(seen[0], seen[1]);
    EXPECT_EQ(seen[1], seen[2]);
}

/// A flat ellipse, turned in space: it is looked at on its broad side, its long axis to the right.
TEST(Picture, TheViewIsTheBroadest) {
    const Vec3 a = normalized(Vec3{1, 2, 2}), b = normalized(cross(a, Vec3{0, 0, 1}));
    std::vector<Vec3> points;
    for (int k = 0; k < 100; ++k) points.push_back(3 * std::cos(0.0628 * k) * a + std::sin(0.0628 * k) * b);
    const View view = broad_view(points);
    EXPECT_NEAR(std::abs(dot(view.right, a)), 1, 1e-3);
    EXPECT_NEAR(std::abs(dot(view.up, b)), 1, 1e-3);
    EXPECT_NEAR(norm(cross(view.right, view.up) - view.toward), 0, 1e-12);   // right-handed
}

/// Lightness (CIE 1931 luminance of sRGB) rises all along the scale: it can be read without colours.
TEST(Picture, TheScaleGetsLighterAllAlong) {
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    double before = -1;
    for (int k = 0; k <= 64; ++k) {
        const auto c = colour_of(k / 64.0);
        const double lightness =
            0.2126 * linear(c[0] / 255.0) + 0.7152 * linear(c[1] / 255.0) + 0.0722 * linear(c[2] / 255.0);
        EXPECT_GT(lightness, before) << k;
        before = lightness;
    }
}

}   // namespace
}   // namespace patency
