// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"

namespace patency {
namespace {

const RigidMotion tilt = motion_along({1, 2, -0.5}, {0.3, -0.2, 0.1});

TEST(Sampling, rowsOfChannelLieHalfASpacingFromThePlates) {
    const double gap = 1, spacing = 0.04;   // 25 rows
    const Lumen channel = make_channel({.length = 2, .gap = gap});
    const FittedPoints points =
        make_fitted_points(channel, spacing, {.wall_thickness = 0.16, .fluid_extension = 0.2, .wall_extension = 0.4});
    EXPECT_EQ(points.fluid.size(), 25u * (50 + 5 + 5));
    EXPECT_EQ(points.fluid_count, (std::vector<std::size_t>{25 * 50, 25 * 5, 25 * 5}));
    EXPECT_EQ(points.wall.size(), 2u * 4 * (50 + 10 + 10));
    EXPECT_NEAR(points.volume, spacing * spacing, 1e-17);
    for (const Vec3& x : points.fluid) {
        const double row = x.y / spacing - 0.5;
        ASSERT_NEAR(row, std::round(row), 1e-12);
        ASSERT_LE(channel.distance.value(x), -0.5 * spacing + 1e-12);
        ASSERT_EQ(x.z, 0);
    }
    for (const Vec3& x : points.wall) {
        const double row = channel.distance.value(x) / spacing - 0.5;
        ASSERT_NEAR(row, std::round(row), 1e-12);
    }
    // Behind the plane first, then past the inlet, then past the outlet.
    for (std::size_t k = 0; k < points.fluid.size(); ++k)
        ASSERT_EQ(opening_beyond(channel, points.fluid[k]), k < 1250 ? -1 : k < 1375 ? 0 : 1);
}

TEST(Sampling, cellsStretchWhereTheSpacingDoesNotDivide) {
    const Lumen channel = make_channel({.length = 1, .gap = 1});
    const FittedPoints points = make_fitted_points(channel, 0.06, {.wall_thickness = 0.2, .fluid_extension = 0.25});
    EXPECT_EQ(points.fluid_count, (std::vector<std::size_t>{17 * 17, 17 * 4, 17 * 4}));
    EXPECT_NEAR(points.volume * 17 * 17, 1, 1e-14);
    EXPECT_NEAR(points.fluid_end[0], 4.0 / 17, 1e-15);
}

TEST(Sampling, periodicBoxIsFilledOnce) {
    const Lumen box = make_box({{1, 1, 0}, {Side::periodic, Side::periodic, Side::wall}, true});
    const FittedPoints points = make_fitted_points(box, 0.02, {.wall_thickness = 0.08});
    EXPECT_EQ(points.fluid.size(), 2500u);
    EXPECT_TRUE(points.wall.empty());
    const Lumen cube = make_box({{1, 1, 1}, {Side::periodic, Side::wall, Side::wall}});
    const FittedPoints in_cube = make_fitted_points(cube, 0.1, {.wall_thickness = 0.2});
    EXPECT_EQ(in_cube.fluid.size(), 1000u);
    EXPECT_EQ(in_cube.wall.size(), 10u * (14 * 14 - 10 * 10 - 4));   // an edge's outermost column is 0.21 away
}

TEST(Sampling, numberTimesVolumeIsTheLumensVolume) {
    const Lumen straight = make_tube({.length = 3, .radius = 0.5});
    const Lumen cone = make_cone({.length = 3, .inlet_radius = 0.5, .outlet_radius = 0.3});
    for (const Lumen& lumen : {straight, moved(straight, tilt), moved(cone, tilt)}) {
        const double spacing = 0.05;
        const FittedPoints points =
            make_fitted_points(lumen, spacing, {.wall_thickness = 0.2, .fluid_extension = 0.2, .wall_extension = 0.4});
        EXPECT_NEAR(double(points.fluid_count[0]), lumen.volume / points.volume, 0.5 + 1e-6);
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_NEAR(double(points.fluid_count[k + 1]), lumen.openings[k].area * 0.2 / points.volume, 0.5 + 1e-6);
        for (std::size_t k = 0; k < points.fluid.size(); ++k) {
            ASSERT_LT(lumen.distance.value(points.fluid[k]), 0.5 * spacing);
            ASSERT_EQ(opening_beyond(lumen, points.fluid[k], spacing) + 1,
                      k < points.fluid_count[0]                           ? 0
                      : k < points.fluid_count[0] + points.fluid_count[1] ? 1
                                                                          : 2);
        }
        // A lattice in the lumen's own frame keeps a row's distance from the flat openings.
        for (const Vec3& x : points.fluid)
            for (const Opening& o : lumen.openings)
                ASSERT_GE(std::abs(opening_coordinates(o, x).s), 0.5 * fitted_lattice(lumen, spacing).cell.x - 1e-9);
        for (const Vec3& x : points.wall) {
            ASSERT_GT(lumen.distance.value(x), -0.5 * spacing);
            ASSERT_LT(lumen.distance.value(x), 0.2 + 0.5 * spacing);
        }
        const double r = lumen.openings[0].radius, end = points.wall_end[0];
        if (lumen.volume < straight.volume) continue;   // the cone's wall has no short formula
        EXPECT_NEAR(double(points.wall.size()), std::numbers::pi * 0.2 * (2 * r + 0.2) * (3 + 2 * end) / points.volume,
                    4);
        EXPECT_NEAR(double(points.filler.size()),
                    2 * std::numbers::pi * r * r * (end - points.fluid_end[0]) / points.volume, 1);
    }
}

// The count of lattice points in a tilted tube errs like a random walk over the cells that the wall cuts, so it
// converges faster than the share of those cells, which is of order spacing / radius.
TEST(Sampling, latticeCountConvergesToTheVolume) {
    const Lumen lumen = moved(make_tube({.length = 3, .radius = 0.5}), tilt);
    for (double spacing : {0.1, 0.05, 0.025}) {
        const double count = double(make_lattice(lumen, spacing).size());
        const Lattice lattice = fitted_lattice(lumen, spacing);
        EXPECT_NEAR(count * lattice.cell_volume() / lumen.volume, 1, 0.3 * spacing / 0.5) << spacing;
    }
}

TEST(Sampling, refusesALumenTooNarrowForTheSpacing) {
    const Lumen lumen = make_tube({.length = 3, .radius = 0.5});
    EXPECT_THROW(make_fitted_points(lumen, -0.1, {}), GeometryError);
    EXPECT_THROW(make_fitted_points(lumen, std::nan(""), {}), GeometryError);
}

}   // namespace
}   // namespace patency
