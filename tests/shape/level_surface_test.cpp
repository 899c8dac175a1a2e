// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/level_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "patency/shape/flat_loop.h"
#include "patency/shape/surface_cut.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;
const auto everywhere_crossed = [](const Bounds&) { return true; };

/// Every edge has two triangles that run along it in opposite ways, or four in pairs where sheets touch.
void expect_closed(const Surface& surface) {
    const std::vector<EdgeUse> uses = edge_uses(surface);
    for_each_edge(std::span<const EdgeUse>(uses), [](std::span<const EdgeUse> edge) {
        int balance = 0;
        for (const EdgeUse& use : edge) balance += use.rises ? 1 : -1;
        ASSERT_EQ(balance, 0);
    });
}

Surface sphere(double radius, double cell) {
    const LevelField field = [=](const Vec3& x) { return norm(x) - radius; };
    return make_level_surface(field, level_grid_around(grown({{}, {}}, radius + 1.3 * cell), cell), everywhere_crossed);
}

TEST(LevelSurface, sphereConvergesToSecondOrder) {
    const Surface coarse = sphere(1, 0.2), fine = sphere(1, 0.1);
    expect_closed(fine);
    for (const Vec3& x : fine.points) ASSERT_NEAR(norm(x), 1, 1e-9);
    const double exact = 4 * pi / 3;
    // Triangles within cells cut a sphere's volume by about (cell / radius)^2 / 4.
    EXPECT_NEAR(volume(fine) / exact, 1, 4e-3);
    EXPECT_NEAR(area(fine) / (4 * pi), 1, 2e-3);
    EXPECT_NEAR((exact - volume(coarse)) / (exact - volume(fine)), 4, 0.3);
}

TEST(LevelSurface, volumeBeyondTheTrianglesIsFoundToFourthOrder) {
    const LevelField field = [](const Vec3& x) { return 2 * (norm(x) - 1); };   // any slope
    for (double cell : {0.2, 0.1}) {
        const Surface s = sphere(1, cell);
        EXPECT_NEAR((volume(s) + volume_beyond(s, field)) / (4 * pi / 3), 1, 0.1 * std::pow(cell, 4));
    }
}

TEST(LevelSurface, boxesThatAreNotCrossedCostNothing) {
    int looks = 0;
    const LevelField field = [&](const Vec3& x) {
#pragma omp atomic
        ++looks;
        return norm(x) - 1;
    };
    const LevelGrid grid = level_grid_around(grown({{}, {}}, 1.5), 0.05);
    const Surface all = make_level_surface(field, grid, everywhere_crossed);
    const int before = std::exchange(looks, 0);
    const Surface some = make_level_surface(field, grid, [](const Bounds& box) {
        return std::abs(norm(0.5 * (box.low + box.high)) - 1) <= 0.5 * diagonal(box);
    });
    EXPECT_EQ(all.points, some.points);
    EXPECT_EQ(all.triangles, some.triangles);
    EXPECT_LT(looks, before);
}

// Waves as short as two cells: cells with every pattern of signs, two and more sheets in one.
TEST(LevelSurface, isClosedWhereSheetsShareCells) {
    const LevelField field = [](const Vec3& x) {
        const double inside = std::sin(2.9 * x.x) * std::cos(2.3 * x.y) + std::sin(2.6 * x.y) * std::cos(3.1 * x.z) +
                              std::sin(2.2 * x.z) * std::cos(2.7 * x.x);
        return std::max(inside, norm(x) - 8.3);
    };
    const Surface s = make_level_surface(field, level_grid_around(grown({{}, {}}, 10), 1), everywhere_crossed);
    EXPECT_GT(s.triangles.size(), 3000u);
    expect_closed(s);
}

TEST(LevelSurface, twoSpheresInOneCellStayApart) {
    const LevelField field = [](const Vec3& x) {
        return std::min(norm(x - Vec3{0.9, 0.9, 0.9}) - 1.5, norm(x + Vec3{0.9, 0.9, 0.9}) - 1.5);
    };
    const Surface s = make_level_surface(field, {{-3.5, -3.5, -3.5}, {1, 1, 1}, {7, 7, 7}}, everywhere_crossed);
    expect_closed(s);
    Groups parts(s.points.size());
    for (const Triangle& t : s.triangles) parts.join(t[0], t[1]), parts.join(t[0], t[2]);
    std::set<std::uint32_t> groups;
    for (std::uint32_t k = 0; k < s.points.size(); ++k) groups.insert(parts.group_of(k));
    EXPECT_EQ(groups.size(), 2u);
}

TEST(SurfaceCut, capsAreFlatAndTheRestStays) {
    const Vec3 normal = normalized(Vec3{1, 2, -0.5}), point = 0.4 * normal;
    Surface open = sphere(1, 0.1), closed = open;
    EXPECT_EQ(cut_flat(open, {point, normal}, 0.02), 1u);
    EXPECT_EQ(cut_flat(closed, {point, normal}, 0.02, 7), 1u);
    expect_closed(closed);
    EXPECT_FALSE(boundary_edges(edge_uses(open)).empty());
    double cap = 0;
    for (std::size_t k = 0; k < closed.triangles.size(); ++k) {
        for (std::uint32_t p : closed.triangles[k]) ASSERT_LE(dot(closed.points[p] - point, normal), 1e-12);
        if (closed.face_ids[k] != 7) continue;
        cap += norm(area_vector(closed, closed.triangles[k]));
        EXPECT_GT(dot(area_vector(closed, closed.triangles[k]), normal), 0);
    }
    EXPECT_NEAR(cap / (pi * (1 - 0.16)), 1, 1e-2);
    const double height = 0.6,
                 left = 4 * pi / 3 - pi * height * height * (3 - height) / 3;   // less a spherical segment
    EXPECT_NEAR(volume(closed) / left, 1, 5e-3);
    double least = 1;
    for (const Triangle& t : open.triangles) least = std::min(least, norm(area_vector(open, t)));
    EXPECT_GT(least, 1e-5);   // a five-hundredth of a cell's face: no slivers
}

TEST(SurfaceCut, spareWhatIsBeyondItsReachAndLength) {
    const LevelField field = [](const Vec3& x) {
        return std::min(norm(x - Vec3{0, 3, 0}), norm(x + Vec3{0, 3, 0})) - 1;
    };
    const Surface two =
        make_level_surface(field, level_grid_around({{-1.5, -4.5, -1.5}, {1.5, 4.5, 1.5}}, 0.1), everywhere_crossed);
    Surface one_cut = two, both_cut = two, none_cut = two;
    EXPECT_EQ(cut_flat(one_cut, {{0.4, 3, 0}, {1, 0, 0}, 2}, 0.02, 2), 1u);
    EXPECT_EQ(cut_flat(both_cut, {{0.4, 3, 0}, {1, 0, 0}}, 0.02, 2), 2u);
    EXPECT_EQ(cut_flat(none_cut, {{-5, 3, 0}, {1, 0, 0}, 2, 1}, 0.02, 2), 0u);
    EXPECT_NEAR(volume(two) - volume(one_cut), 0.5 * (volume(two) - volume(both_cut)), 1e-9);
    EXPECT_EQ(none_cut.triangles.size(), two.triangles.size());
}

}   // namespace
}   // namespace patency
