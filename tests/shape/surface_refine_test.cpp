// SPDX-License-Identifier: Apache-2.0
// Smaller triangles: the same shape, closed as before, only where asked.
#include "patency/shape/surface_refine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/flat_loop.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

Surface capped_tube() { return make_tube_mesh({.around = 12, .along = 4, .start_cap = true, .end_cap = true}); }

double longest_edge(const Surface& s, double from) {
    double longest = 0;
    for (const Triangle& t : s.triangles)
        for (int k = 0; k < 3; ++k) {
            const Vec3 &a = s.points[t[std::size_t(k)]], &b = s.points[t[std::size_t((k + 1) % 3)]];
            if (0.5 * (a.x + b.x) > from) longest = std::max(longest, norm(a - b));
        }
    return longest;
}

TEST(RefineSurface, KeepsTheShapeAndItsFaces) {
    const Surface before = capped_tube();
    Surface s = before;
    const double size = 0.13e-3;
    refine_surface(s, [=](const Vec3&) { return size; });
    EXPECT_LE(longest_edge(s, -1), size);
    EXPECT_NEAR(area(s), area(before), 1e-12 * area(before));
    EXPECT_NEAR(volume(s), volume(before), 1e-12 * volume(before));
    EXPECT_TRUE(boundary_edges(edge_uses(s)).empty());
    for (std::size_t i = 0; i < before.points.size(); ++i) EXPECT_EQ(s.points[i], before.points[i]);
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {   // the start's cap has the id 2
        const bool is_cap = std::abs(centroid(s, s.triangles[t]).x) < 1e-12;
        ASSERT_EQ(s.face_ids[t] == 2, is_cap);
        EXPECT_GT(norm(area_vector(s, s.triangles[t])), 0);
    }
}

TEST(RefineSurface, LeavesAloneWhatNobodyAskedFor) {
    const Surface before = capped_tube();
    Surface s = before;
    refine_surface(s, [](const Vec3& x) { return 0.2e-3 + 0.5 * std::max(0.0, 5e-3 - x.x); });
    EXPECT_LE(longest_edge(s, 5.1e-3), 0.2e-3);
    EXPECT_TRUE(boundary_edges(edge_uses(s)).empty());
    std::size_t old = 0, now = 0;
    for (const Triangle& t : before.triangles) old += centroid(before, t).x < 1e-3;
    for (const Triangle& t : s.triangles) now += centroid(s, t).x < 1e-3;
    EXPECT_EQ(old, now);
}

TEST(RefineSurface, RefusesSizesThatNoTriangleHas) {
    Surface s = capped_tube();
    EXPECT_THROW(refine_surface(s, [](const Vec3& x) { return x.x > 3e-3 ? 0.2e-3 : Bounds::infinity; }),
                 GeometryError);
}

}   // namespace
}   // namespace patency
