// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/cell_shaking.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

TEST(CellShaking, keepsAPlaneAPlaneAndPointsInside) {
    const Lumen channel = make_channel({.length = 1, .gap = 0.5});
    CellPoints points = make_cell_points(channel, 0.05);
    const CellPoints before = points;
    shake(channel, 0.25, points);
    int moved = 0;
    for (std::size_t i = 0; i < points.point.size(); ++i) {
        EXPECT_EQ(points.point[i].z, 0);
        EXPECT_LT(channel.distance.value(points.point[i]), -0.3 * 0.05);
        EXPECT_LT(norm(points.point[i] - before.point[i]), 0.25 * 0.05 * std::sqrt(2.0) + 1e-12);
        moved += norm(points.point[i] - before.point[i]) > 0;
    }
    EXPECT_GT(moved, 150);
}

}   // namespace
}   // namespace patency
