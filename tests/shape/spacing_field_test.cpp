// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/spacing_field.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "patency/base/errors.h"
#include "tests/shape/laws.h"

namespace patency {

namespace {

const RigidMotion tilt = motion_along({1, 2, -0.5}, {3e-3, -2e-3, 1e-3});
constexpr SpacingSettings settings{.smallest = 0.1e-3, .largest = 1e-3, .across = 12};

}   // namespace

TEST(SpacingField, OfATubeIsItsDiameterOverTheNumberAcross) {
    for (const double radius : {1e-3, 2e-3}) {
        const Lumen tube = moved(make_tube({.length = 8e-3, .radius = radius}), tilt);
        const SpacingField field = make_spacing_field(tube, settings);
        for (const Vec3& x : random_points(tube.bounds, 5000))
            if (contains(tube, x)) {
                ASSERT_NEAR(field(x) / (2 * radius / 12), 1, 0.02);
            }
    }
}

TEST(SpacingField, OfAConeFollowsItsDiameter) {
    const double length = 20e-3, from = 2e-3, to = 0.8e-3, slope = (from - to) / length;
    const Lumen cone = moved(make_cone({.length = length, .inlet_radius = from, .outlet_radius = to}), tilt);
    const SpacingField field = make_spacing_field(cone, settings);
    // The largest ball that holds a place on the axis lies upstream, its rim there.
    for (const Vec3& own : random_points({{2 * from, -1e-4, -1e-4}, {length - from, 1e-4, 1e-4}}, 2000)) {
        const double steep = slope / std::sqrt(1 + slope * slope);
        const double widest = (from - slope * own.x) / std::sqrt(1 + slope * slope) / (1 - steep);
        ASSERT_NEAR(field(tilt.place(own)) / (2 * widest / 12), 1, 0.03) << own.x;
    }
}

TEST(SpacingField, KeepsItsBoundsAndItsGrowth) {
    const Lumen nozzle = make_nozzle({{{0, 2e-3}, {4e-3, 2e-3}, {4e-3, 0.5e-3}, {8e-3, 0.5e-3}}});
    SpacingSettings bounded = settings;
    bounded.smallest = 0.11e-3, bounded.largest = 0.3e-3;
    const SpacingField field = make_spacing_field(nozzle, bounded);
    double least = 1, most = 0;
    const auto places = random_points(nozzle.bounds, 20000);
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (!contains(nozzle, places[n])) continue;
        least = std::min(least, field(places[n])), most = std::max(most, field(places[n]));
        const Vec3 next = places[n] + 0.05 * (places[(n + 1) % places.size()] - places[n]);
        if (!contains(nozzle, next)) continue;
        // Ways along the grid are up to 9 % longer, and values linear between nodes grow at once along all three axes.
        ASSERT_LE(std::abs(field(next) - field(places[n])), 1.3 * bounded.growth * norm(next - places[n]) + 1e-9);
    }
    EXPECT_NEAR(least, 0.11e-3, 1e-9);
    EXPECT_NEAR(most, 0.3e-3, 1e-9);
    EXPECT_DOUBLE_EQ(field({1, 1, 1}), bounded.smallest);
}

// Those of a centreline are enough where a vessel is round.
TEST(SpacingField, OfKnownBallsIsThatOfAllBalls) {
    const double length = 20e-3, from = 2e-3, to = 0.8e-3, slope = (from - to) / length;
    const Lumen cone = moved(make_cone({.length = length, .inlet_radius = from, .outlet_radius = to}), tilt);
    std::vector<InscribedBall> balls;
    for (double x = 0; x <= length; x += 0.1e-3)
        balls.push_back({tilt.place({x, 0, 0}), (from - slope * x) / std::sqrt(1 + slope * slope)});
    const SpacingField known = make_spacing_field(cone, balls, settings), all = make_spacing_field(cone, settings);
    for (const Vec3& own : random_points({{2 * from, -to, -to}, {length - from, to, to}}, 2000)) {
        const Vec3 x = tilt.place(own);
        if (contains(cone, x)) {
            ASSERT_NEAR(known(x) / all(x), 1, 0.05) << own.x;
        }
    }
    EXPECT_THROW(make_spacing_field(cone, std::vector<InscribedBall>{{{}, 0.1e-3}}, settings), GeometryError);
}

TEST(SpacingField, CanBeScaled) {
    const Lumen cone = make_cone({.length = 10e-3, .inlet_radius = 2e-3, .outlet_radius = 0.6e-3});
    const SpacingField field = make_spacing_field(cone, settings), coarse = field.scaled(1.6);
    for (const Vec3& x : random_points(cone.bounds, 200)) ASSERT_NEAR(coarse(x), 1.6 * field(x), 1e-15);
    EXPECT_DOUBLE_EQ(coarse.settings().smallest, 1.6 * settings.smallest);
    EXPECT_DOUBLE_EQ(coarse.settings().across, settings.across / 1.6);
}

TEST(SpacingField, IsTheSameForAnotherNumberOfThreads) {
    const Lumen cone = make_cone({.length = 10e-3, .inlet_radius = 2e-3, .outlet_radius = 0.6e-3});
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const SpacingField one = make_spacing_field(cone, settings);
    omp_set_num_threads(3);
    const SpacingField three = make_spacing_field(cone, settings);
    omp_set_num_threads(threads);
    for (const Vec3& x : random_points(cone.bounds, 2000)) ASSERT_EQ(one(x), three(x));
}

TEST(SpacingField, RefusesWhatMakesNoSense) {
    const Lumen tube = make_tube({.length = 8e-3, .radius = 1e-3});
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 0, .largest = 1e-3}), GeometryError);
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 1e-4, .largest = 0.5e-4}), GeometryError);
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 1e-4, .largest = std::nan("")}), GeometryError);
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 1e-4, .largest = 1e-3, .across = 0}), GeometryError);
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 1e-4, .largest = 1e-3, .growth = -1}), GeometryError);
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 1e-9, .largest = 1e-3}), GeometryError);   // too many nodes
    EXPECT_THROW(make_spacing_field(tube, {.smallest = 2e-3, .largest = 3e-3}), GeometryError);   // nothing fits
    EXPECT_THROW(make_spacing_field(make_channel({.length = 1, .gap = 0.1}), settings), GeometryError);
}

}   // namespace patency
