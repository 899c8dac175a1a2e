// SPDX-License-Identifier: Apache-2.0
// A lumen opened by geometry: to the stent's radius along it, nowhere narrower, unchanged past the shoulders.
#include "patency/shape/lumen_morph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace patency {
namespace {

const LumenMorph stent{.radius = 1.5e-3, .length = 10e-3, .shoulder = 3e-3};

double radius_after(double radius, double along, const StentAxis& axis = {}) {
    return axis.coordinates(morphed(axis.place({radius, 0.7, along}), axis, stent)).radius;
}

TEST(LumenMorph, OpensWhatIsNarrowerToTheStentAndLeavesWhatIsWider) {
    for (const double along : {-5e-3, -1e-3, 4.99e-3}) {
        EXPECT_NEAR(radius_after(0.6e-3, along), 1.5e-3, 1e-9 * 1.5e-3);
        EXPECT_NEAR(radius_after(1.5e-3, along), 1.5e-3, 0.02 * 1.5e-3);   // the corner's width
        EXPECT_DOUBLE_EQ(radius_after(3e-3, along), 3e-3);
    }
}

TEST(LumenMorph, IsOneToOne) {   // along every ray what was farther out stays farther out
    for (const double along : {0.0, 5.5e-3, 7.9e-3}) {
        double before = -1;
        for (double r = 1.2e-3; r < 2e-3; r += 0.01e-3) {
            const double now = radius_after(r, along);
            EXPECT_GT(now, before);
            EXPECT_GE(now, r * (1 - 1e-12));
            before = now;
        }
    }
}

TEST(LumenMorph, FadesOverTheShoulders) {
    EXPECT_NEAR(radius_after(1e-3, 5e-3 + 1.5e-3), 1.25e-3, 1e-8);   // half of the way at half of the shoulder
    const Vec3 far = {8.001e-3, 1e-3, 0}, before = {-8.001e-3, 0, 1e-3};
    EXPECT_EQ(morphed(far, {}, stent), far);
    EXPECT_EQ(morphed(before, {}, stent), before);
    const double step = 1e-6;   // no kink where the shoulder begins and ends
    for (const double along : {5e-3, 8e-3})
        EXPECT_NEAR(radius_after(1e-3, along + step), radius_after(1e-3, along - step), 0.01 * step);
}

TEST(LumenMorph, FollowsABend) {
    std::vector<Vec3> line;
    for (int k = 0; k <= 200; ++k) line.push_back({20e-3 * std::sin(k * 0.005), 20e-3 * (1 - std::cos(k * 0.005)), 0});
    const StentAxis axis(line, 10e-3, 0, 10e-3, 1.5e-3);
    EXPECT_NEAR(radius_after(0.7e-3, 2e-3, axis), 1.5e-3, 1e-8);
    Surface s{.points = {axis.place({0.7e-3, 2.0, 1e-3}), axis.place({0.7e-3, -2.0, -4e-3})}};
    morph_surface(s, axis, stent);
    for (const Vec3& x : s.points) EXPECT_NEAR(axis.coordinates(x).radius, 1.5e-3, 1e-8);
}

}   // namespace
}   // namespace patency
