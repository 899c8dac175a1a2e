// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/shape/laws.h"
#include "tests/shape/surfaces.h"

namespace patency {

namespace {

double square_to(const Surface& surface, std::uint32_t triangle, const Vec3& x) {
    const Triangle& t = surface.triangles[triangle];
    const Vec3 d = x - nearest_place(x, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
    return dot(d, d);
}

}   // namespace

TEST(TriangleTree, FindsWhatAllTrianglesWouldSay) {
    const Surface ring = make_torus_mesh(3e-3, 1e-3, 40, 16);
    const TriangleTree tree(ring);
    for (const Vec3& x : random_points(grown(bounds(ring), 1e-3), 300)) {
        double least = Bounds::infinity;
        for (std::uint32_t t = 0; t < ring.triangles.size(); ++t) least = std::min(least, square_to(ring, t, x));
        const TriangleTree::Nearest found = tree.nearest(x, Bounds::infinity);
        EXPECT_EQ(found.square, least);
        EXPECT_NEAR(norm(x - found.place), std::sqrt(least), 1e-15);
        EXPECT_EQ(tree.square_distance(x, 0.5 * least), 0.5 * least);
    }
}

// Whatever is nearest to a point close by is a rival; far from the surface most triangles are not.
TEST(TriangleTree, RivalsHoldTheNearestTriangleOfEveryPointAround) {
    const Surface ring = make_torus_mesh(3e-3, 1e-3, 80, 32);
    const TriangleTree tree(ring);
    const double radius = 0.2e-3;
    double share = 0;
    const auto middles = random_points(grown(bounds(ring), 1e-3), 200);
    for (const Vec3& x : middles) {
        std::vector<std::uint32_t> rivals;
        tree.find_rivals(tree.nearest(x, Bounds::infinity).place, x, radius, rivals);
        share += double(rivals.size()) / double(ring.triangles.size() * middles.size());
        for (const Vec3& e : random_points({{-1, -1, -1}, {1, 1, 1}}, 20)) {
            const Vec3 p = x + (radius / std::max(1.0, norm(e))) * e;
            double least = Bounds::infinity;
            for (const std::uint32_t t : rivals) least = std::min(least, square_to(ring, t, p));
            ASSERT_EQ(least, tree.square_distance(p, Bounds::infinity));
        }
    }
    EXPECT_LT(share, 0.1);
}

}   // namespace patency
