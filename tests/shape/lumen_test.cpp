// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/lumen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/measure.h"
#include "tests/shape/laws.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;
const RigidMotion tilt = motion_along({1, 2, -0.5}, {0.3, -0.2, 0.1});

const NozzleShape nozzle{{{0, 1}, {1, 1}, {1.8, 0.4}, {2.6, 0.4}, {2.6, 1}, {4, 1}}};

BranchesShape y_of_tubes(double extension = 2) {
    const double c = std::cos(0.6), s = std::sin(0.6);
    return {.branches = {{.points = {{-5, 0, 0}, {0, 0, 0}}, .radii = {1, 1}, .start = "inlet", .end = ""},
                         {.points = {{0, 0, 0}, {6 * c, 6 * s, 0}}, .radii = {0.8, 0.7}, .start = "", .end = "left"},
                         {.points = {{0, 0, 0}, {6 * c, -6 * s, 0}}, .radii = {0.7, 0.7}, .start = "", .end = "right"}},
            .extension = extension};
}

std::vector<Lumen> lumens_with_openings() {
    return {make_tube({.length = 3, .radius = 1}),
            make_cone({.length = 3, .inlet_radius = 1, .outlet_radius = 0.5}),
            make_nozzle(nozzle),
            make_box({{3, 2, 1}, {Side::open, Side::wall, Side::wall}}),
            make_branches(y_of_tubes()),
            make_channel({.length = 3, .gap = 1}),
            make_step({.length = 3, .gap = 1, .height = 0.4, .at = 1.2})};
}

TEST(Lumen, measuresOfTubeConeAndNozzleAreTheClosedForms) {
    const Lumen tube = make_tube({.length = 3, .radius = 2});
    EXPECT_NEAR(tube.volume, 12 * pi, 1e-13);
    EXPECT_NEAR(tube.wall_area, 12 * pi, 1e-13);
    const Lumen cone = make_cone({.length = 3, .inlet_radius = 1, .outlet_radius = 0.5});
    EXPECT_NEAR(cone.volume, 1.75 * pi, 1e-14);
    EXPECT_NEAR(cone.wall_area, 1.5 * pi * std::hypot(3, 0.5), 1e-13);
    const Lumen stepped = make_nozzle(nozzle);
    EXPECT_NEAR(stepped.volume, pi * (1 + 0.8 / 3 * 1.56 + 0.8 * 0.16 + 1.4), 1e-13);
    EXPECT_NEAR(stepped.wall_area, pi * (2 + 1.4 * 1 + 0.64 + (1 - 0.16) + 2.8), 1e-13);
    const Lumen channel = make_channel({.length = 4, .gap = 0.5});
    EXPECT_EQ(channel.volume, 2);
    EXPECT_EQ(channel.wall_area, 8);
    EXPECT_EQ(channel.openings[0].area, 0.5);
    EXPECT_EQ(channel.openings[0].radius, 0.25);
    const Lumen step = make_step({.length = 5, .gap = 2, .height = 0.5, .at = 2});
    EXPECT_EQ(step.volume, 9);
    EXPECT_EQ(step.wall_area, 10.5);
    EXPECT_EQ(step.openings[0].area, 1.5);
    EXPECT_EQ(step.openings[0].centre, (Vec3{0, 1.25, 0}));
    EXPECT_EQ(step.openings[0].mean_square, 1.5 * 1.5 / 12);
    EXPECT_EQ(step.openings[1].area, 2);
    EXPECT_THROW(make_step({.length = 5, .gap = 2, .height = 2, .at = 2}), GeometryError);
    EXPECT_THROW(make_step({.length = 5, .gap = 2, .height = 1, .at = 5}), GeometryError);
}

// A smooth wall's error falls with the fourth power of resolution / radius. Along an edge the distance's level sets
// are rounded within the band of three cells, which is of the order of band^2 x edge length in the volume, band x edge
// length in the area: the nozzle's step and the duct's corners have 9 and 12 m of edges beside 20 m^2 of wall.
TEST(Lumen, measuredVolumeAndAreaConvergeToTheClosedForms) {
    struct {
        Lumen straight;
        double volume, area;   // largest relative errors at resolution 1/32
    } cases[] = {
        {make_tube({.length = 3, .radius = 1}), 1e-6, 1e-4},
        {make_tube({.length = 3, .radius = 1, .ends = Side::periodic}), 2e-5, 1e-3},   // along the cells: no averaging
        {make_cone({.length = 3, .inlet_radius = 1, .outlet_radius = 0.5}), 1e-5, 2e-4},
        {make_nozzle(nozzle), 1e-4, 5e-3},
        {make_box({{3, 2, 1}, {Side::open, Side::wall, Side::wall}}), 1e-4, 5e-3}};
    for (const auto& c : cases) {
        const Lumen lumen = c.straight.period.x > 0 ? c.straight : moved(c.straight, tilt);
        const Measures coarse = measure(lumen, 1 / 16.0), fine = measure(lumen, 1 / 32.0);
        EXPECT_NEAR(fine.volume / lumen.volume, 1, c.volume);
        EXPECT_NEAR(fine.wall_area / lumen.wall_area, 1, c.area);
        EXPECT_NEAR(coarse.volume / lumen.volume, 1, 16 * c.volume);
        EXPECT_NEAR(coarse.wall_area / lumen.wall_area, 1, 4 * c.area);
    }
}

TEST(Lumen, volumeIsWhatRandomPointsFind) {
    for (const Lumen& lumen : lumens_with_openings()) {
        if (lumen.planar) continue;
        const Vec3 size = lumen.bounds.high - lumen.bounds.low;
        const double box = size.x * size.y * size.z;
        const int count = 200000;
        int inside = 0;
        for (const Vec3& x : random_points(lumen.bounds, count)) inside += contains(lumen, x);
        const double share = lumen.volume / box;
        // Four standard deviations of a binomial count.
        EXPECT_NEAR(double(inside) / count, share, 4 * std::sqrt(share * (1 - share) / count));
    }
}

TEST(Lumen, openingsAreFlatRoundAndContinuedStraight) {
    for (const Lumen& straight : lumens_with_openings()) {
        const Lumen lumen = straight.planar ? straight : moved(straight, tilt);
        const double far = std::min(lumen.extension, 2.0);
        for (const Opening& o : lumen.openings) {
            EXPECT_NEAR(norm(o.normal), 1, 1e-14);
            EXPECT_NEAR(o.area, o.planar ? 2 * o.radius : pi * o.radius * o.radius, 1e-13);
            EXPECT_TRUE(contains(lumen, o.centre - 1e-6 * o.normal)) << o.name;
            EXPECT_FALSE(contains(lumen, o.centre + 1e-6 * o.normal)) << o.name;
            EXPECT_LT(lumen.distance.value(o.centre + far * o.normal), 0) << o.name;
            for (const Vec3& x : random_points({o.centre - Vec3{2, 2, 2}, o.centre + Vec3{2, 2, 2}}, 2000)) {
                const auto [s, radial] = opening_coordinates(o, x);
                ASSERT_NEAR(norm(o.centre + s * o.normal + radial - x), 0, 1e-13);
                ASSERT_NEAR(dot(radial, o.normal), 0, 1e-13);
                if (lumen.planar || s < 0 || s > far || norm(radial) > 1.5 * o.reach) continue;
                // Straight: the distance past the plane depends on the radial coordinate alone, as at the plane.
                ASSERT_NEAR(lumen.distance.value(x) < 0, lumen.distance.value(x - s * o.normal) < 0, 0);
                if (lumen.distance.value(x) < 0) {
                    ASSERT_GE(opening_beyond(lumen, x), 0);
                }
            }
        }
    }
}

TEST(Lumen, planeOfOneOpeningDoesNotCutAnotherBranch) {
    // The side branch leaves backwards: its end lies in front of the inlet's plane.
    const Lumen lumen = make_branches(
        {.branches = {{.points = {{0, 0, 0}, {10, 0, 0}}, .radii = {1, 1}, .start = "inlet", .end = "outlet"},
                      {.points = {{5, 0, 0}, {-4, 9, 0}}, .radii = {0.6, 0.6}, .start = "", .end = "side"}},
         .extension = 3});
    EXPECT_TRUE(contains(lumen, {-3, 8, 0}));
    EXPECT_FALSE(contains(lumen, {-0.1, 0, 0}));
    EXPECT_TRUE(contains(lumen, {0.1, 0, 0}));
    EXPECT_EQ(opening_beyond(lumen, {-0.1, 0, 0}), 0);
    EXPECT_EQ(opening_beyond(lumen, {-3, 8, 0}), -1);
    EXPECT_EQ(opening_beyond(lumen, {-4.2, 9.2, 0}), 2);
    EXPECT_FALSE(contains(lumen, {-3.9, 0, 0}));   // in the round cap behind the inlet's continuation
}

TEST(Lumen, taperedBranchMeetsItsContinuationWithoutAStep) {
    const Lumen lumen =
        make_branches({.branches = {{.points = {{0, 0, 0}, {4, 0, 0}}, .radii = {1, 0.5}, .start = "in", .end = "out"}},
                       .extension = 2});
    const Opening& out = lumen.openings[1];
    for (double s : {-1e-9, 1e-9, 1.0})
        EXPECT_NEAR(lumen.distance.value(out.centre + Vec3{s, out.radius, 0}), 0, 1e-9) << s;
}

TEST(Lumen, boxKnowsItsSides) {
    const Lumen periodic = make_box({{2, 3, 0}, {Side::periodic, Side::periodic, Side::wall}, true});
    EXPECT_EQ(periodic.distance.value({1, 1, 0}), -Bounds::infinity);
    EXPECT_EQ(periodic.period, (Vec3{2, 3, 0}));
    EXPECT_EQ(periodic.wall_area, 0);
    EXPECT_EQ(periodic.volume, 6);
    const Lumen duct = make_box({{2, 3, 4}, {Side::open, Side::wall, Side::wall}});
    ASSERT_EQ(duct.openings.size(), 2u);
    EXPECT_EQ(duct.openings[1].area, 12);
    EXPECT_EQ(duct.openings[1].reach, 2.5);
    EXPECT_TRUE(contains(duct, {1.9, 0.01, 0.01}));
    EXPECT_FALSE(contains(duct, {2.1, 0.01, 0.01}));
    EXPECT_EQ(make_tube({.length = 2, .radius = 1, .ends = Side::periodic}).period, (Vec3{2, 0, 0}));
}

TEST(Lumen, refusesWhatCannotBe) {
    EXPECT_THROW(make_tube({.length = -1, .radius = 1}), GeometryError);
    EXPECT_THROW(make_tube({.length = 1, .radius = std::nan("")}), GeometryError);
    EXPECT_THROW(make_nozzle({{{0, 1}, {1, 0}}}), GeometryError);
    EXPECT_THROW(make_nozzle({{{0, 1}}}), GeometryError);
    EXPECT_THROW(make_branches({.branches = {}, .extension = 1}), GeometryError);
    EXPECT_THROW(
        make_branches({.branches = {{.points = {{0, 0, 0}}, .radii = {1}, .start = "", .end = ""}}, .extension = 1}),
        GeometryError);
    BranchesShape shape = y_of_tubes();
    shape.branches[1].points[1] = {0.9, 0.6, 0};   // its opening lies within the other daughter
    EXPECT_THROW(make_branches(shape), GeometryError);
    EXPECT_THROW(moved(make_channel({.length = 1, .gap = 1}), tilt), GeometryError);
    EXPECT_THROW(moved(make_tube({.length = 1, .radius = 1, .ends = Side::periodic}), tilt), GeometryError);
}

}   // namespace
}   // namespace patency
