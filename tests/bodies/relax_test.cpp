// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/relax.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "patency/base/errors.h"
#include "patency/shape/surface_lumen.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

constexpr double spacing = 0.1;
const PointsExtent extent{.wall_thickness = 0.4, .fluid_extension = 0.4, .wall_extension = 0.7};
const RigidMotion tilt = motion_along({1, 2, -0.5}, {0.3, -0.2, 0.1});

Lumen y_of_tubes() {
    const double c = std::cos(0.6), s = std::sin(0.6);
    return make_branches(
        {.branches = {{.points = {{-1.5, 0, 0}, {0, 0, 0}}, .radii = {0.5, 0.5}, .start = "inlet", .end = ""},
                      {.points = {{0, 0, 0}, {2 * c, 2 * s, 0}}, .radii = {0.4, 0.35}, .start = "", .end = "left"},
                      {.points = {{0, 0, 0}, {2 * c, -2 * s, 0}}, .radii = {0.4, 0.35}, .start = "", .end = "right"}},
         .extension = 1});
}

RelaxSettings still_settings(int steps) {
    return {.spacing = spacing, .wall_thickness = 0, .fluid_end = {}, .wall_end = {}, .steps = steps};
}

// One thread: the sets are small, and the machine may be shared.
class Relax : public testing::Test {
protected:
    Relax() : threads_(omp_get_max_threads()) { omp_set_num_threads(1); }
    ~Relax() override { omp_set_num_threads(threads_); }

private:
    int threads_;
};

// A lattice is in balance: sums over it cancel exactly, with ghosts behind periodic, outer and end faces.
TEST_F(Relax, leavesALatticeThatFits) {
    const Lumen periodic = make_box({{1, 0.8, 0.9}, {Side::periodic, Side::periodic, Side::periodic}});
    const Lumen channel = make_channel({.length = 1, .gap = 0.8});
    const Lumen duct = make_box({{1, 0.8, 0.9}, {Side::open, Side::wall, Side::periodic}});
    for (const Lumen& lumen : {periodic, channel, duct}) {
        const FittedPoints start = make_fitted_points(lumen, spacing, extent);
        std::vector<Vec3> inside = start.fluid, wall = start.wall;
        inside.insert(inside.end(), start.filler.begin(), start.filler.end());
        const std::vector<Vec3> before = inside, wall_before = wall;
        const RelaxQuality q = relax_points(inside, wall, lumen,
                                            {.spacing = spacing,
                                             .wall_thickness = extent.wall_thickness,
                                             .fluid_end = start.fluid_end,
                                             .wall_end = start.wall_end,
                                             .steps = 20});
        EXPECT_NEAR(q.mean_density, 1, 1e-9);
        EXPECT_LT(q.largest_density_error, 1e-9);
        for (std::size_t i = 0; i < inside.size(); ++i) ASSERT_LT(norm(inside[i] - before[i]), 1e-9) << i;
        for (std::size_t i = 0; i < wall.size(); ++i) ASSERT_LT(norm(wall[i] - wall_before[i]), 1e-9) << i;
    }
}

// Pairs push each other apart with equal strength, so the middle of all points stays where it is.
TEST_F(Relax, evensOutDisorderAndKeepsTheMiddle) {
    const Lumen box = make_box({{1, 1, 1}, {Side::periodic, Side::periodic, Side::periodic}});
    FittedPoints points = make_fitted_points(box, spacing, {});
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> shake(-0.1 * spacing, 0.1 * spacing);   // steps stay below their limit
    for (Vec3& x : points.fluid) {
        const double a = shake(engine), b = shake(engine), c = shake(engine);
        x += Vec3{a, b, c};
    }
    const std::vector<Vec3> before = points.fluid;
    std::vector<Vec3> none, still = before;
    const RelaxQuality disorder = relax_points(still, none, box, still_settings(0));
    const RelaxQuality order = relax_points(points.fluid, none, box, still_settings(150));
    EXPECT_GT(disorder.density_spread, 0.001);
    EXPECT_LT(order.density_spread, 0.2 * disorder.density_spread);
    EXPECT_LT(order.residual, 0.2 * disorder.residual);
    Vec3 drift{};
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 e = points.fluid[i] - before[i];
        drift += {e.x - std::round(e.x), e.y - std::round(e.y), e.z - std::round(e.z)};   // the box is 1 m wide
    }
    EXPECT_LT(norm(drift), 1e-10);
}

TEST_F(Relax, fitsPointsEvenlyOnTheirSidesOfTheWall) {
    struct {
        const char* name;
        Lumen lumen;
    } cases[] = {{"periodic tube", make_tube({.length = 0.8, .radius = 0.5, .ends = Side::periodic})},
                 {"tilted tube", moved(make_tube({.length = 1.5, .radius = 0.5}), tilt)},
                 {"tilted cone", moved(make_cone({.length = 1.5, .inlet_radius = 0.6, .outlet_radius = 0.4}), tilt)},
                 {"nozzle", make_nozzle({{{0, 0.7}, {0.5, 0.7}, {1, 0.4}, {1.5, 0.4}, {1.5, 0.7}, {2, 0.7}}})},
                 {"branches", y_of_tubes()}};
    for (const auto& [name, lumen] : cases) {
        RelaxQuality q;
        const auto begin = std::chrono::steady_clock::now();
        const FittedPoints points = make_relaxed_points(lumen, spacing, extent, &q);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const double dp = std::cbrt(points.volume);

        // In the sharp wedge between two branches, leaving one wall leads to the other, back and forth: some rounds
        // of that end a little short of the clearance.
        const bool branches = std::string(name) == "branches";
        double first_layer = 0;
        int in_layer = 0;
        for (const Vec3& x : points.fluid) {
            const double depth = lumen.distance.value(x) / dp;
            ASSERT_LE(depth, branches ? -0.4 : -0.5 + 1e-6) << name;
            if (depth > -0.8) first_layer -= depth, ++in_layer;
        }
        first_layer /= in_layer;
        for (const Vec3& x : points.wall) ASSERT_GE(lumen.distance.value(x) / dp, branches ? 0.4 : 0.5 - 1e-6) << name;
        std::printf(
            "    %-14s %6zu fluid %6zu wall: density %.4f +- %.2f %% (largest %.2f %%), first layer at %.3f "
            "spacings, %.2f s\n",
            name, points.fluid.size(), points.wall.size(), q.mean_density, 100 * q.density_spread,
            100 * q.largest_density_error, first_layer, seconds);
        EXPECT_NEAR(q.mean_density, 1, 0.01) << name;
        EXPECT_LT(q.density_spread, 0.01) << name;
        EXPECT_LT(q.largest_density_error, 0.03) << name;
        EXPECT_NEAR(first_layer, 0.5, 0.03) << name;
    }
}

TEST_F(Relax, keepsAsManyPointsBehindEveryPlaneAsTheVolumeNeeds) {
    for (const Lumen& lumen : {moved(make_tube({.length = 1.5, .radius = 0.5}), tilt), y_of_tubes()}) {
        const FittedPoints points = make_relaxed_points(lumen, spacing, extent);
        EXPECT_NEAR(double(points.fluid_count[0]), lumen.volume / points.volume, 0.5 + 1e-6);
        std::vector<std::size_t> count(1 + lumen.openings.size());
        for (const Vec3& x : points.fluid) {
            const int k = opening_beyond(lumen, x);
            ++count[std::size_t(k + 1)];
            if (k >= 0) {
                ASSERT_LT(opening_coordinates(lumen.openings[std::size_t(k)], x).s, points.fluid_end[std::size_t(k)]);
            }
        }
        EXPECT_EQ(count, points.fluid_count);
    }
}

TEST_F(Relax, givesTheSameBitsForAnyNumberOfThreads) {
    const Lumen lumen = moved(make_cone({.length = 1, .inlet_radius = 0.5, .outlet_radius = 0.4}), tilt);
    const FittedPoints one = make_relaxed_points(lumen, spacing, extent);
    for (int n : {2, 3}) {
        omp_set_num_threads(n);
        const FittedPoints many = make_relaxed_points(lumen, spacing, extent);
        EXPECT_EQ(one.fluid, many.fluid);
        EXPECT_EQ(one.wall, many.wall);
    }
}

// A bent tube of triangles: its distance is made by all threads too.
TEST_F(Relax, fitsASurfaceWithTheSameBitsForAnotherNumberOfThreads) {
    Surface bent = make_tube_mesh({.radius = 1e-3, .length = 4e-3, .around = 64, .along = 40});
    bent.face_ids.clear();
    const double bend = 4e-3, dp = 0.25e-3;
    for (Vec3& x : bent.points) {
        const double angle = x.x / bend;
        x = {(bend - x.y) * std::sin(angle), bend - (bend - x.y) * std::cos(angle), x.z};
    }
    const CheckedSurface checked = check_surface(std::move(bent));
    const auto openings = find_openings(checked);
    const auto make = [&](int threads, RelaxQuality& quality) {
        omp_set_num_threads(threads);
        const Lumen lumen =
            make_surface_lumen(checked, openings, {.voxel = 0.5 * dp, .outside = 5 * dp, .extension = 12 * dp});
        const FittedPoints points = make_relaxed_points(
            lumen, dp, {.wall_thickness = 3.1 * dp, .fluid_extension = 4 * dp, .wall_extension = 6.6 * dp}, &quality);
        EXPECT_NEAR(double(points.fluid_count[0]) * points.volume, lumen.volume, 1e-6 * lumen.volume);
        for (const Vec3& x : points.fluid) EXPECT_LT(lumen.distance.value(x), 0.1 * dp);
        for (const Vec3& x : points.wall) EXPECT_GT(lumen.distance.value(x), -0.1 * dp);
        return points;
    };
    RelaxQuality q, other;
    const FittedPoints one = make(1, q);
    EXPECT_LT(std::hypot(q.density_spread, q.mean_density - 1), 0.006);
    EXPECT_LT(q.largest_density_error, 0.03);
    const FittedPoints three = make(3, other);
    EXPECT_EQ(one.fluid, three.fluid);
    EXPECT_EQ(one.wall, three.wall);
    EXPECT_EQ(q.residual, other.residual);
}

TEST_F(Relax, refusesSettingsThatDoNotFitTheLumen) {
    std::vector<Vec3> points{{0.5, 0, 0}}, none;
    const Lumen tube = make_tube({.length = 1, .radius = 0.5});
    EXPECT_THROW(relax_points(points, none, tube, still_settings(1)), GeometryError);   // two openings, no ends
    RelaxSettings settings = still_settings(1);
    settings.fluid_end = settings.wall_end = {0, 0};
    settings.spacing = 0;
    EXPECT_THROW(relax_points(points, none, tube, settings), GeometryError);
    EXPECT_EQ(
        relax_points(none, none, make_tube({.length = 1, .radius = 0.5, .ends = Side::periodic}), still_settings(1))
            .mean_density,
        0);
}

}   // namespace
}   // namespace patency
