// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/solid_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace patency {
namespace {

TEST(SolidShape, isCutToABoxWithoutAFaceThere) {
    const SolidFill whole = fill_cylinder({0, 0, 0}, {0, 0, 1}, 0, 1, 0.02, true);
    const Vec3 low{-0.3, 0.8, -1}, high{0.3, 1.1, 1};
    const SolidFill cut = cut_to_box(whole, low, high);
    // A circle's segment above y = 0.8, cut at both sides.
    const auto area = [](double x) { return 0.5 * (x * std::sqrt(1 - x * x) + std::asin(x)); };
    double volume = 0;
    for (std::size_t i = 0; i < cut.places.size(); ++i) {
        volume += cut.volumes[i];
        EXPECT_TRUE(std::abs(cut.places[i].x) <= 0.3 && cut.places[i].y >= 0.8);
    }
    EXPECT_NEAR(volume, 2 * area(0.3) - 0.6 * 0.8, 0.02 * 0.6);
    // The arc only, one open line of vertices that are all used.
    double length = 0;
    std::vector<int> uses(cut.surface.vertices.size());
    for (const auto& e : cut.surface.elements) {
        length += norm(cut.surface.vertices[e[1]] - cut.surface.vertices[e[0]]);
        ++uses[e[0]], ++uses[e[1]];
    }
    EXPECT_NEAR(length, 2 * std::asin(0.3), 0.05);
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), 2);
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 2), std::ptrdiff_t(uses.size()) - 2);
    for (const Vec3& x : cut.surface.vertices) {
        EXPECT_NEAR(norm(x), 1, 1e-12);
        EXPECT_TRUE(std::abs(x.x) <= 0.3 && x.y >= 0.8);
    }
}

TEST(SolidShape, thatABoxHoldsIsNotCut) {
    const SolidFill whole = fill_cylinder({0, 0, 0}, {0, 0, 1}, 0.5, 1, 0.1, false),
                    cut = cut_to_box(whole, {-2, -2, -2}, {2, 2, 2});
    EXPECT_EQ(cut.places.size(), whole.places.size());
    EXPECT_EQ(cut.surface.elements.size(), whole.surface.elements.size());
    EXPECT_EQ(cut.surface.vertices.size(), whole.surface.vertices.size());
}

}   // namespace
}   // namespace patency
