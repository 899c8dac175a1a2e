// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/decimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/shape/surfaces.h"

namespace patency {
namespace {

Surface surface_of(const Surface& from, const Decimated& few) {
    Surface result{.points = {}, .triangles = few.triangles};
    for (std::uint32_t k : few.kept) result.points.push_back(from.points[k]);
    return result;
}

/// A torus of 1 m and 0.3 m: it stays closed, no point moves or comes twice, and with a fifth of its triangles its area and volume are
/// right to a percent. (A ring of n chords across has 1 - (2 pi / n)^2 / 6 of its volume: 0.7 % lack at n = 30, about what is left here.)
TEST(Decimate, KeepsTheShapeAndItsPoints) {
    const Surface torus = make_torus_mesh(1, 0.3, 200, 80);
    const std::size_t most = torus.triangles.size() / 5;
    const Decimated few = decimate(torus.points, torus.triangles, most);
    EXPECT_LE(few.triangles.size(), most + 10);
    EXPECT_GT(few.triangles.size(), most / 2);
    EXPECT_EQ(std::set(few.kept.begin(), few.kept.end()).size(), few.kept.size());
    const Surface left = surface_of(torus, few);
    EXPECT_NEAR(area(left), area(torus), 0.01 * area(torus));
    EXPECT_NEAR(volume(left), volume(torus), 0.01 * volume(torus));   // turned triangles would lose it
    const std::vector<EdgeUse> uses = edge_uses(left);
    for_each_edge(std::span<const EdgeUse>(uses), [](std::span<const EdgeUse> edge) { EXPECT_EQ(edge.size(), 2u); });
}

TEST(Decimate, LeavesASmallSurfaceAloneButForLoosePoints) {
    const std::vector<Vec3> points = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> triangles = {{1, 2, 3}};
    const Decimated same = decimate(points, triangles, 10);
    EXPECT_EQ(same.kept, (std::vector<std::uint32_t>{1, 2, 3}));
    EXPECT_EQ(same.triangles, (std::vector<Triangle>{{0, 1, 2}}));
    EXPECT_TRUE(decimate({}, {}, 10).kept.empty());
}

}   // namespace
}   // namespace patency
