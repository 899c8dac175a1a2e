// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_lumen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "patency/base/errors.h"
#include "patency/shape/sampling.h"
#include "tests/shape/surfaces.h"

namespace patency {

namespace {

constexpr double radius = 1e-3, dp = radius / 5;
constexpr SurfaceLumenSettings settings{.voxel = 0.5 * dp, .outside = 5 * dp, .extension = 12 * dp};

Lumen lumen_of(Surface mesh, const SurfaceLumenSettings& s = settings) {
    mesh.face_ids.clear();
    const CheckedSurface checked = check_surface(std::move(mesh));
    return make_surface_lumen(checked, find_openings(checked), s);
}

const TubeMesh tube{.radius = radius, .length = 4e-3, .around = 48, .along = 16};
double section() { return 24 * radius * radius * std::sin(std::numbers::pi / 24); }   // of a 48-gon
double perimeter() { return 96 * radius * std::sin(std::numbers::pi / 48); }

/// The tube's axis bent into an arc of this radius in the plane of x and y, from x = 0 on.
Surface bent(Surface mesh, double arc) {
    for (Vec3& x : mesh.points) {
        const double angle = x.x / arc;
        x = {(arc - x.y) * std::sin(angle), arc - (arc - x.y) * std::cos(angle), x.z};
    }
    return mesh;
}

}   // namespace

TEST(SurfaceLumen, OfAPrismHasItsExactMeasuresWithAndWithoutCaps) {
    TubeMesh capped = tube;
    capped.start_cap = capped.end_cap = true;
    for (const TubeMesh& t : {tube, capped}) {
        const Lumen lumen = lumen_of(make_tube_mesh(t));
        EXPECT_NEAR(lumen.volume / (section() * t.length), 1, 1e-12);
        EXPECT_NEAR(lumen.wall_area / (perimeter() * t.length), 1, 1e-12);
        ASSERT_EQ(lumen.openings.size(), 2u);
        for (const Opening& opening : lumen.openings) {
            EXPECT_NEAR(opening.area / section(), 1, 1e-12);
            EXPECT_NEAR(opening.reach, radius, 1e-12);
            EXPECT_NEAR(std::abs(opening.normal.x), 1, 1e-12);
            EXPECT_NEAR(opening.centre.x, opening.normal.x < 0 ? 0 : t.length, 1e-12);
            // A regular polygon of n sides: R^2 (2 + cos(2 pi / n)) / 6.
            EXPECT_NEAR(opening.mean_square, radius * radius * (2 + std::cos(std::numbers::pi / 24)) / 6, 1e-15);
        }
    }
}

TEST(SurfaceLumen, GoesOnStraightPastItsOpenings) {
    const Lumen lumen = lumen_of(bent(make_tube_mesh(tube), 6e-3));
    for (const Opening& opening : lumen.openings) {
        const Vec3 aside = normalized(cross(opening.normal, {0, 0, 1}));
        for (double s = 0.1 * dp; s < settings.extension; s += 0.5 * dp)
            for (const double share : {0.0, 0.3, 0.6, 0.9, 1.2, 1.5}) {
                const Vec3 x = opening.centre + s * opening.normal + share * radius * aside;
                const double must = (share - 1) * radius;
                EXPECT_NEAR(lumen.distance.value(x), must, share == 0 ? 0.5 * settings.voxel : dp / 20)
                    << "past by " << s;
                if (share > 0.5) {
                    EXPECT_NEAR(dot(lumen.distance.gradient(x), aside), 1, 0.02);
                }
                EXPECT_FALSE(contains(lumen, x));
            }
        EXPECT_TRUE(contains(lumen, opening.centre - 0.1 * dp * opening.normal));
    }
}

TEST(SurfaceLumen, TakesStraightPiecesIntoItself) {
    SurfaceLumenSettings longer = settings;
    longer.straight = 1.5;
    const Surface mesh = bent(make_tube_mesh(tube), 6e-3);
    const Lumen before = lumen_of(mesh), after = lumen_of(mesh, longer);
    const double diameter = 2 * std::sqrt(section() / std::numbers::pi);
    EXPECT_NEAR((after.volume - before.volume) / (2 * 1.5 * diameter * section()), 1, 1e-9);
    EXPECT_NEAR((after.wall_area - before.wall_area) / (2 * 1.5 * diameter * perimeter()), 1, 1e-9);
    for (std::size_t k = 0; k < 2; ++k) {
        const Opening &a = before.openings[k], &b = after.openings[k];
        EXPECT_EQ(a.name, b.name);
        EXPECT_NEAR(norm(b.centre - a.centre - 1.5 * diameter * a.normal), 0, 1e-9);
    }
}

TEST(SurfaceLumen, LeadsARaggedRimOnToAPlane) {
    Surface mesh = make_tube_mesh(tube);
    for (Vec3& x : mesh.points)
        if (x.x == tube.length) x.x += 0.03e-3 * std::cos(3 * std::atan2(x.z, x.y));   // no tilt, no shift
    const Lumen lumen = lumen_of(mesh);
    const Opening& opening = lumen.openings[lumen.openings[0].centre.x > 1e-3 ? 0 : 1];
    EXPECT_NEAR(opening.centre.x, tube.length + 0.03e-3, 1e-6) << "through the outermost point";
    EXPECT_NEAR(opening.area / section(), 1, 1e-3);
    EXPECT_NEAR(lumen.volume / (section() * (tube.length + 0.03e-3)), 1, 1e-3) << "nothing is cut away";
}

TEST(SurfaceLumen, RefusesAContinuationThatRunsIntoTheVessel) {
    TubeMesh ring = tube;
    ring.length = 2 * std::numbers::pi * 4e-3 * 0.85;   // nearly round: each end faces the other's side
    ring.along = 64;
    try {
        lumen_of(bent(make_tube_mesh(ring), 4e-3));
        FAIL() << "the ends run into each other";
    } catch (const GeometryError& error) {
        EXPECT_NE(std::string(error.what()).find("'inlet'"), std::string::npos) << error.what();
    }
}

TEST(SurfaceLumen, MovesWithItsSurfaceAndItsParticlesFillItExactly) {
    Surface mesh = bent(make_tube_mesh(tube), 6e-3);
    const Lumen here = lumen_of(mesh);
    const RigidMotion motion = motion_along({0.3, -0.8, 0.52}, {0.04, -0.02, 0.1});
    for (Vec3& x : mesh.points) x = motion.place(x);
    const Lumen there = lumen_of(mesh);
    EXPECT_NEAR(there.volume / here.volume, 1, 1e-9);
    EXPECT_NEAR(there.wall_area / here.wall_area, 1, 1e-9);
    for (const Lumen& lumen : {here, there}) {
        const FittedPoints points = make_fitted_points(
            lumen, dp, {.wall_thickness = 3.1 * dp, .fluid_extension = 4 * dp, .wall_extension = 6.6 * dp});
        EXPECT_NEAR(double(points.fluid_count[0]) * points.volume / lumen.volume, 1, 1e-9);
        EXPECT_GT(points.wall.size(), points.fluid.size());
    }
}

}   // namespace patency
