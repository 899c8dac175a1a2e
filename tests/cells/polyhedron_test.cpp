// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/polyhedron.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace patency {
namespace {

Vec3 open_area(const Polyhedron& shape) {
    Vec3 sum{};
    for (std::size_t f = 0; f < shape.face_count(); ++f) sum += shape.face(f).area;
    return sum;
}

TEST(Polyhedron, isACube) {
    Polyhedron cube;
    cube.reset(0.5, 7);
    EXPECT_NEAR(cube.volume().volume, 1, 1e-15);
    for (std::size_t f = 0; f < cube.face_count(); ++f) {
        const PolyhedronFace face = cube.face(f);
        EXPECT_EQ(face.label, 7);
        EXPECT_NEAR(norm(face.area - 2 * face.centroid), 0, 1e-15) << "outward, of area 1";
    }
}

TEST(Polyhedron, losesACornerOfKnownSize) {
    Polyhedron cube;
    cube.reset(0.5, 0);
    // Through three corners' neighbours: a corner with legs of 0.3 goes.
    ASSERT_TRUE(cube.clip(normalized(Vec3{1, 1, 1}), 1.2 / std::sqrt(3.0), 1));
    EXPECT_NEAR(cube.volume().volume, 1 - 0.3 * 0.3 * 0.3 / 6, 1e-15);
    const PolyhedronFace cut = cube.face(cube.face_count() - 1);
    EXPECT_EQ(cut.label, 1);
    EXPECT_NEAR(norm(cut.area), 0.3 * 0.3 * std::sqrt(3.0) / 2, 1e-15);
    EXPECT_NEAR(norm(cut.centroid - Vec3{0.4, 0.4, 0.4}), 0, 1e-14);
}

TEST(Polyhedron, isLeftAloneByPlanesThatTouch) {
    Polyhedron cube;
    cube.reset(0.5, 0);
    EXPECT_FALSE(cube.clip({1, 0, 0}, 0.5, 1));
    EXPECT_FALSE(cube.clip(normalized(Vec3{1, 1, 0}), std::sqrt(0.5), 1)) << "an edge";
    EXPECT_FALSE(cube.clip(normalized(Vec3{1, 1, 1}), std::sqrt(0.75), 1)) << "a corner";
    EXPECT_EQ(cube.face_count(), 6u);
}

TEST(Polyhedron, isCutThroughItsCorners) {
    Polyhedron cube;
    cube.reset(0.5, 0);
    // Along a diagonal plane, through four corners exactly.
    ASSERT_TRUE(cube.clip(normalized(Vec3{1, 1, 0}), 0, 1));
    EXPECT_NEAR(cube.volume().volume, 0.5, 1e-15);
    EXPECT_EQ(cube.face_count(), 5u);
    EXPECT_NEAR(norm(open_area(cube)), 0, 1e-15);
}

TEST(Polyhedron, staysClosedUnderAnyCuts) {
    std::mt19937 random(3);
    std::normal_distribution<double> any;
    std::uniform_real_distribution<double> offset(0.3, 1.2);
    for (int trial = 0; trial < 200; ++trial) {
        Polyhedron shape;
        shape.reset(1, 0);
        for (int cut = 0; cut < 30; ++cut) {
            const double x = any(random), y = any(random), z = any(random);
            shape.clip(normalized(Vec3{x, y, z}), offset(random), cut + 1);
            ASSERT_LT(norm(open_area(shape)), 1e-14);
        }
        const std::size_t f = shape.face_count(), v = shape.corners().size();
        EXPECT_GT(shape.volume().volume, 4.0 / 3 * 3.14 * 0.027) << "planes from 0.3 on leave a ball";
        EXPECT_LE(v, 2 * f - 4) << "Euler: three edges at least meet in a corner";
    }
}

}   // namespace
}   // namespace patency
