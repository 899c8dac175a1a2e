// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_distance.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/ray_parity.h"
#include "patency/shape/triangle_tree.h"
#include "tests/shape/laws.h"
#include "tests/shape/surfaces.h"

namespace patency {

namespace {

Surface tube_mesh() {
    return make_tube_mesh({.around = 192, .along = 24, .start_cap = true, .end_cap = true});
}   // R 1 mm, L 6 mm

Surface box_mesh(const Vec3& size) {
    Surface s{.points = {{0, 0, 0},
                         {size.x, 0, 0},
                         {0, size.y, 0},
                         {size.x, size.y, 0},
                         {0, 0, size.z},
                         {size.x, 0, size.z},
                         {0, size.y, size.z},
                         size}};
    s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return s;
}

/// Errors of a grid's distance against the exact one, where that is within `outside` and `from_axis` of its medial axis.
struct Errors {
    double value = 0, slope = 0;
    int wrong_sides = 0;
};
Errors errors_of(const SignedDistance& grid, const SignedDistance& exact, double voxel, double outside,
                 double deepest) {
    Errors e;
    for (const Vec3& x : random_points(grown(grid.bounds(), outside), 20000)) {
        const DistanceSample is = grid.sample(x), must = exact.sample(x);
        if (must.value > outside || must.value < -deepest) continue;
        e.value = std::max(e.value, std::abs(is.value - must.value));
        // At edges the slope jumps: there the two sides of the jump are mixed.
        if (norm(exact.gradient(x + 2 * voxel * must.gradient) - must.gradient) < 1e-6 &&
            std::abs(must.curvature) < 1 / (4 * voxel))
            e.slope = std::max(e.slope, norm(is.gradient - must.gradient));
        e.wrong_sides += std::abs(must.value) > 0.05 * voxel && (is.value < 0) != (must.value < 0);
    }
    return e;
}

/// How often the surface goes around x, by the solid angles of its triangles (van Oosterom & Strackee 1983).
double winding_number(const Surface& mesh, const Vec3& x) {
    double sum = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3 a = mesh.points[i] - x, b = mesh.points[j] - x, c = mesh.points[k] - x;
        const double la = norm(a), lb = norm(b), lc = norm(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (4 * std::numbers::pi);
}

/// The torus around the z axis.
SignedDistance torus(double large, double small) {
    return {[=](const Vec3& x) {
                const double r = std::hypot(x.x, x.y), d = std::hypot(r - large, x.z);
                const Vec3 radial = Vec3{x.x, x.y, 0} / r;
                const Vec3 out = ((r - large) * radial + Vec3{0, 0, x.z}) / d;
                return DistanceSample{d - small, out, 1 / d + dot(out, radial) / r};
            },
            Bounds{{-large - small, -large - small, -small}, {large + small, large + small, small}}};
}

}   // namespace

TEST(SurfaceDistance, OfABoxIsExactOutsideItsEdgesAndItsMiddle) {
    const Vec3 size{3e-3, 2e-3, 1.5e-3};
    const double voxel = 0.11e-3;
    const SignedDistance grid = make_surface_distance(box_mesh(size), voxel), exact = box_between({}, size);
    int faces = 0;
    for (const Vec3& x : random_points(grown({{}, size}, 0.5e-3), 20000)) {
        const DistanceSample is = grid.sample(x), must = exact.sample(x);
        EXPECT_NEAR(is.value, must.value, 0.5 * voxel);   // edges are cut
        if (std::abs(must.value) > 0.25 * voxel) {
            EXPECT_EQ(is.value < 0, must.value < 0);
        }
        // Nearest to a face, and so are all corners of the voxels around: distance is linear there, and so is the grid.
        const auto is_face = [&](const Vec3& y) { return norm(exact.gradient(y) - must.gradient) < 1e-9; };
        bool all = true;
        for (int n = 0; n < 8; ++n)
            all = all && is_face(x + 2.1 * voxel * Vec3{n & 1 ? 1.0 : -1.0, n & 2 ? 1.0 : -1.0, n & 4 ? 1.0 : -1.0});
        if (!all) continue;
        ++faces;
        EXPECT_NEAR(is.value, must.value, 1e-9);
        EXPECT_NEAR(norm(is.gradient - must.gradient), 0, 1e-4);
        EXPECT_NEAR(is.curvature, 0, 1);   // of 1 / voxel = 9000
    }
    EXPECT_GT(faces, 1000);
}

TEST(ExactDistance, IsThatOfTheNearestOfAllTriangles) {
    Surface mesh = make_torus_mesh(3e-3, 1e-3, 25, 9);
    for (Vec3& x : mesh.points) x.z *= 0.01 + std::abs(x.x) / 4e-3;   // flat on one side: slivers
    const SignedDistance exact = make_exact_distance(mesh);
    for (const Vec3& x : random_points(grown(exact.bounds(), 1e-3), 3000)) {
        double least = Bounds::infinity;
        for (const auto& [a, b, c] : mesh.triangles)
            least = std::min(least, norm(x - nearest_place(x, mesh.points[a], mesh.points[b], mesh.points[c])));
        EXPECT_NEAR(std::abs(exact.value(x)), least, 1e-15);
    }
}

// In every depth of a lumen, near the wall on both sides of it, and for every reach.
TEST(ExactDistance, WithinReachIsTheSampleAndBeyondItABound) {
    const SignedDistance exact = make_exact_distance(make_torus_mesh(3e-3, 1e-3, 48, 20));
    const SignedDistance later = made_when_asked([&] { return exact; }, exact.bounds());
    int near = 0, deep = 0;
    double shortfall = 0;
    for (const Vec3& x : random_points(grown(exact.bounds(), 1e-3), 2000))
        for (const double reach : {0.1e-3, 0.3e-3, 0.9e-3}) {
            const DistanceSample must = exact.sample(x), is = exact.sample_within(x, reach);
            ASSERT_EQ(is.value, later.sample_within(x, reach).value);
            if (std::abs(must.value) < reach) {
                ++near;
                ASSERT_EQ(is.value, must.value);
                ASSERT_EQ(norm(is.gradient - must.gradient), 0);
            } else if (must.value < 0) {
                ++deep;
                ASSERT_LE(is.value, -reach);
                ASSERT_GE(is.value, must.value * (1 + 1e-8));
                shortfall = std::max(shortfall, is.value - must.value);
            }
        }
    EXPECT_GT(std::min(near, deep), 300);
    EXPECT_GT(shortfall, 0.1e-3);   // it did stop early
}

// A point dragged along the surface past its neighbours crumples the triangles around it into others, whose normals then point anywhere.
TEST(ExactDistance, KnowsTheSideBesideACrumple) {
    const Surface smooth = make_torus_mesh(3e-3, 1e-3, 48, 20);
    const Vec3 dragged = smooth.points[0];
    std::vector<Vec3> near = smooth.points;
    std::sort(near.begin(), near.end(),
              [&](const Vec3& a, const Vec3& b) { return norm(a - dragged) < norm(b - dragged); });
    int inside = 0, outside = 0;
    for (std::size_t k = 6; k < 40; ++k) {
        Surface mesh = smooth;
        mesh.points[0] = 0.7 * near[k] + 0.3 * near[k + 2];
        const SignedDistance crumpled = make_exact_distance(mesh);
        const double size = norm(mesh.points[0] - dragged);
        const Vec3 reach{size, size, size};
        for (const Vec3& x : random_points({dragged - 2 * reach, dragged + 2 * reach}, 500)) {
            const double turns = winding_number(mesh, x);
            if (std::abs(turns) > 0.1 && std::abs(turns - 1) > 0.1) continue;   // in a pocket of the crumple
            const bool is_inside = turns > 0.5;
            (is_inside ? inside : outside) += 1;
            EXPECT_EQ(crumpled.value(x) < 0, is_inside)
                << k << ": " << 1e3 * x.x << " " << 1e3 * x.y << " " << 1e3 * x.z;
        }
    }
    EXPECT_GT(std::min(inside, outside), 1000);
}

TEST(RayParity, TellsWhatASurfaceEncloses) {
    const Surface mesh = make_torus_mesh(3e-3, 1e-3, 48, 20);
    const TriangleTree tree(mesh);
    const SignedDistance exact = make_exact_distance(mesh);
    int inside = 0;
    for (const Vec3& x : random_points(grown(exact.bounds(), 1e-3), 3000)) {
        inside += exact.value(x) < 0;
        EXPECT_EQ(is_enclosed(mesh, tree, x), exact.value(x) < 0);
    }
    EXPECT_GT(inside, 300);
}

// Also on the axis, where all triangles are equally far, and with triangles without area among them.
TEST(SurfaceDistance, AtTheCornersOfVoxelsIsTheTrianglesOwn) {
    Surface mesh = make_torus_mesh(3e-3, 1e-3, 48, 20);
    mesh.points.push_back(0.5 * (mesh.points[mesh.triangles[0][0]] + mesh.points[mesh.triangles[0][1]]));
    const auto middle = std::uint32_t(mesh.points.size() - 1);
    const auto [a, b, c] = mesh.triangles[0];
    mesh.triangles[0] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
    mesh.triangles.push_back({a, b, middle});
    const double voxel = 0.09e-3, outside = 0.7e-3;
    const SignedDistance grid = make_surface_distance(mesh, voxel, outside), exact = make_exact_distance(mesh);
    const Vec3 low = bounds(mesh).low;
    int deep = 0;
    for (const Vec3& x : random_points(grown(bounds(mesh), outside), 4000)) {
        const Vec3 place = (x - low) / voxel;
        const Vec3 corner = low + voxel * Vec3{std::round(place.x), std::round(place.y), std::round(place.z)};
        const double must = exact.value(corner);
        if (must > outside) continue;
        deep += must < -8 * voxel;
        const double is = grid.value(corner);
        if (std::abs(must) > 0.05 * voxel) {
            ASSERT_EQ(is < 0, must < 0);
        }
        ASSERT_NEAR(std::abs(is), std::abs(must), 1e-6 * std::abs(must) + 1e-12);   // kept in float
    }
    EXPECT_GT(deep, 30);
}

TEST(SurfaceDistance, OfATubeHasTheStatedErrorAndHalvingTheVoxelQuartersIt) {
    const double radius = 1e-3, dp = radius / 6;
    const SignedDistance exact = body_of_revolution({{0, radius}, {6e-3, radius}}, TubeEnds::capped);
    double last = 0;
    for (const double voxel : {dp, 0.5 * dp}) {
        const SignedDistance grid = make_surface_distance(tube_mesh(), voxel, 4 * dp);
        // The flat ends' edges are left out: only places nearest to the round wall, between the caps.
        double value = 0, slope = 0, curvature = 0, count = 0;
        for (const Vec3& x : random_points({{1.3e-3, -1.6e-3, -1.6e-3}, {4.7e-3, 1.6e-3, 1.6e-3}}, 20000)) {
            const DistanceSample is = grid.sample(x), must = exact.sample(x);
            if (must.value > 3.5 * dp || must.value < -3 * dp) continue;
            value = std::max(value, std::abs(is.value - must.value));
            slope = std::max(slope, norm(is.gradient - must.gradient));
            curvature += std::abs(is.curvature / must.curvature - 1), ++count;
        }
        const double facets = radius * (1 - std::cos(std::numbers::pi / 192));
        EXPECT_LT(value, voxel * voxel / 8 / (radius - 3.5 * dp) + facets) << "voxel " << voxel;
        if (voxel < dp) {
            EXPECT_LT(value, dp / 20);
            EXPECT_LT(slope, 0.02);
            EXPECT_LT(curvature / count, 0.05);
            EXPECT_NEAR(last / value, 4, 1.2);
        }
        last = value;
    }
}

TEST(SurfaceDistance, OfATorusAndOfASphereKnowsEverySide) {
    const double voxel = 0.1e-3;
    const Errors ring = errors_of(make_surface_distance(make_torus_mesh(3e-3, 1e-3, 240, 80), voxel, 0.5e-3),
                                  torus(3e-3, 1e-3), voxel, 0.5e-3, 5 * voxel);
    EXPECT_EQ(ring.wrong_sides, 0);
    EXPECT_LT(ring.value, 0.05 * voxel * 2);   // dp / 20, of a spacing of two voxels
    EXPECT_LT(ring.slope, 0.02);
    const SignedDistance ball = union_of_round_cones({{{0, 0, 0}, {0, 0, 0}, 1e-3, 1e-3}});
    const Surface mesh = make_level_mesh(ball, {{-1.2e-3, -1.2e-3, -1.2e-3}, {1.2e-3, 1.2e-3, 1.2e-3}}, 0.05e-3);
    Surface closed = mesh;
    merge_points(closed, 0);
    const Errors round = errors_of(make_surface_distance(closed, voxel, 0.5e-3), ball, voxel, 0.5e-3, 5 * voxel);
    EXPECT_EQ(round.wrong_sides, 0);
    EXPECT_LT(round.value, 0.05 * voxel * 2);
    EXPECT_LT(round.slope, 0.02);
}

TEST(SurfaceDistance, MovesWithItsSurface) {
    const RigidMotion motion = motion_along({0.3, -0.8, 0.52}, {0.04, -0.02, 0.1});
    Surface mesh = make_torus_mesh(3e-3, 1e-3, 120, 40);
    const double voxel = 0.1e-3;
    const SignedDistance here = make_surface_distance(mesh, voxel);
    for (Vec3& x : mesh.points) x = motion.place(x);
    const SignedDistance there = make_surface_distance(mesh, voxel);
    for (const Vec3& x : random_points(here.bounds(), 5000)) {
        const DistanceSample a = here.sample(x), b = there.sample(motion.place(x));
        if (std::abs(a.value) > 5 * voxel) continue;
        EXPECT_NEAR(a.value, b.value, 0.05 * voxel);
        EXPECT_LT(norm(motion.turn(a.gradient) - b.gradient), 0.06);   // facets are 9 degrees apart
    }
}

TEST(SurfaceDistance, FarOutsideIsABoundAndAUnitVector) {
    const SignedDistance grid = make_surface_distance(tube_mesh(), 0.1e-3, 0.5e-3);
    for (const Vec3& x : {Vec3{0.1, 0, 0}, Vec3{-3, 5, 1e9}, Vec3{3e-3, 0, 4e-3}, Vec3{1e300, 0, 0}}) {
        const DistanceSample s = grid.sample(x);
        EXPECT_GE(s.value, 0.5e-3);
        EXPECT_NEAR(norm(s.gradient), 1, 1e-12);
    }
}

TEST(SurfaceDistance, IsTheSameForAnyNumberOfThreads) {
    const Surface mesh = make_torus_mesh(3e-3, 1e-3, 120, 40);
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const SignedDistance one = make_surface_distance(mesh, 0.1e-3);
    omp_set_num_threads(4);
    const SignedDistance four = make_surface_distance(mesh, 0.1e-3);
    omp_set_num_threads(before);
    for (const Vec3& x : random_points(grown(one.bounds(), 0.3e-3), 50000)) {
        const DistanceSample a = one.sample(x), b = four.sample(x);
        ASSERT_EQ(a.value, b.value);
        ASSERT_EQ(a.gradient, b.gradient);
    }
}

TEST(SurfaceDistance, RefusesWhatHasNoInside) {
    Surface inside_out = tube_mesh();
    for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
    EXPECT_THROW(make_surface_distance(inside_out, 0.1e-3), GeometryError);
    EXPECT_THROW(make_surface_distance(make_tube_mesh({}), 0.1e-3), GeometryError) << "open ends";
    EXPECT_THROW(make_surface_distance({}, 0.1e-3), GeometryError);
    EXPECT_THROW(make_surface_distance(tube_mesh(), 1e-9), GeometryError) << "1e19 voxels";
    EXPECT_THROW(make_surface_distance(tube_mesh(), 0), GeometryError);
    Surface broken = tube_mesh();
    broken.points[7].y = NAN;
    EXPECT_THROW(make_surface_distance(broken, 0.1e-3), GeometryError);
}

}   // namespace patency
