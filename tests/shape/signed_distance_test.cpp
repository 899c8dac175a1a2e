// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/signed_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"
#include "tests/shape/laws.h"

namespace patency {
namespace {

const Bounds around{{-2, -2, -2}, {3, 2, 2}};

// Distance from x to a segment by bisection on the slope of the squared distance: no closed form shared with the code.
double distance_to_segment(const Vec3& x, const Vec3& p, const Vec3& q) {
    double low = 0, high = 1;
    for (int k = 0; k < 200; ++k) {
        const double t = 0.5 * (low + high);
        (dot(p + t * (q - p) - x, q - p) > 0 ? high : low) = t;
    }
    return norm(x - (p + low * (q - p)));
}

const std::vector<AxialRadius> nozzle = {{-1, 1}, {0, 1}, {0.8, 0.3}, {1.2, 0.3}, {1.2, 0.9}, {2, 1.1}};

TEST(SignedDistance, isNegativeInsideAndExactForElementaryShapes) {
    const SignedDistance shapes[] = {half_space({0.2, 0, 0}, {1, 2, -1}),
                                     box_between({0, -1, -0.5}, {1, 1, 0.7}),
                                     box_between({0, -1, -0.5}, {1, 1, 0.7}, {false, true, true}),
                                     gap_between_plates(1.5),
                                     round_tube(0.8),
                                     stepped_gap(1.5, 0.6, 0.4),
                                     body_of_revolution({{-1, 0.4}, {2, 1.2}}, TubeEnds::open),
                                     body_of_revolution({{-1, 0.4}, {2, 1.2}}, TubeEnds::capped),
                                     body_of_revolution(nozzle, TubeEnds::open),
                                     body_of_revolution(nozzle, TubeEnds::capped),
                                     union_of_round_cones({{{-1, 0, 0}, {2, 0.5, 0.3}, 0.9, 0.4}})};
    const double inside[] = {-0.2 / std::sqrt(6.0) * 1, -0.5, -0.6, -0.75, -0.8};
    const Vec3 places[] = {{0, 0, 0}, {0.5, 0, 0.2}, {9, 0, 0.1}, {9, 0.75, 9}, {7, 0, 0}};
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(shapes[k].value(places[k]), inside[k], 1e-15) << k;
    for (const SignedDistance& shape : shapes) {
        expect_exact_distance(shape, around);
        expect_consistent_derivatives(shape, around);
    }
}

TEST(SignedDistance, ofAStepIsThatToItsPlates) {
    const SignedDistance d = stepped_gap(1.5, 0.6, 0.4);
    const Vec3 way[] = {{-100, 0.6, 0}, {0.4, 0.6, 0}, {0.4, 0, 0}, {100, 0, 0}};
    for (const Vec3& x : random_points(around, 4000)) {
        const Vec3 plane{x.x, x.y, 0};
        double nearest = std::abs(x.y - 1.5);
        for (int k = 0; k < 3; ++k) nearest = std::min(nearest, distance_to_segment(plane, way[k], way[k + 1]));
        ASSERT_NEAR(std::abs(d.value(x)), nearest, 1e-12);
        ASSERT_EQ(d.value(x) < 0, x.y < 1.5 && x.y > 0 && (x.x > 0.4 || x.y > 0.6));
    }
}

TEST(SignedDistance, ofNozzleIsThatToItsOutline) {
    const SignedDistance d = body_of_revolution(nozzle, TubeEnds::open);
    for (const Vec3& x : random_points(around, 4000)) {
        const Vec3 plane{x.x, std::hypot(x.y, x.z), 0};
        double nearest = std::min(distance_to_segment(plane, {-100, 1, 0}, {-1, 1, 0}),
                                  distance_to_segment(plane, {2, 1.1, 0}, {100, 1.1, 0}));
        for (std::size_t k = 1; k < nozzle.size(); ++k)
            nearest = std::min(nearest, distance_to_segment(plane, {nozzle[k - 1].axial, nozzle[k - 1].radius, 0},
                                                            {nozzle[k].axial, nozzle[k].radius, 0}));
        ASSERT_NEAR(std::abs(d.value(x)), nearest, 1e-12);
    }
    EXPECT_LT(d.value({1.3, 0.8, 0}), 0);   // behind the step
    EXPECT_GT(d.value({1.1, 0.8, 0}), 0);   // beside the throat
}

TEST(SignedDistance, curvatureOfTubeIsOneOverRadius) {
    EXPECT_NEAR(round_tube(2).curvature({5, 3, 4}), 0.2, 1e-15);
    EXPECT_NEAR(round_tube(2).curvature({5, 0.3, 0.4}), 2, 1e-14);
    EXPECT_EQ(gap_between_plates(1).curvature({5, 0.3, 0.4}), 0);
    // A cone of half-angle b: the distance is cos(b) r + ..., so its Laplacian is cos(b) / r.
    const SignedDistance cone = body_of_revolution({{0, 1}, {4, 2}}, TubeEnds::open);
    EXPECT_NEAR(cone.curvature({2, 0, 1.3}), 4 / std::sqrt(17.0) / 1.3, 1e-14);
}

TEST(SignedDistance, combinationsFollowTheirSets) {
    const SignedDistance a = round_tube(0.8), b = moved(round_tube(0.6), motion_along({0.3, 1, 0.2}, {0.5, 0, 0}));
    const SignedDistance both = intersection_of(a, b), either = union_of(a, b), neither = complement_of(either);
    for (const Vec3& x : random_points(around, 4000)) {
        const bool in_a = a.value(x) < 0, in_b = b.value(x) < 0;
        ASSERT_EQ(both.value(x) < 0, in_a && in_b);
        ASSERT_EQ(either.value(x) < 0, in_a || in_b);
        ASSERT_EQ(neither.value(x), -either.value(x));
        ASSERT_EQ(norm(neither.gradient(x) + either.gradient(x)), 0);
        ASSERT_EQ(neither.curvature(x), -either.curvature(x));
    }
    expect_exact_distance(b, around);   // a rigid motion keeps distances
    // The outside of a union, where its distance is exact.
    for (const Vec3& x : random_points(around, 4000)) {
        const DistanceSample s = either.sample(x);
        if (s.value > 0) {
            ASSERT_NEAR(either.value(x - s.value * s.gradient), 0, 1e-12);
        }
    }
    EXPECT_NEAR(offset_by(a, 0.1).value({0, 0.9, 0}), 0, 1e-15);
    EXPECT_EQ(offset_by(a, 0.1).curvature({0, 0.9, 0}), a.curvature({0, 0.9, 0}));
}

TEST(SignedDistance, motionCarriesTheXAxis) {
    for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{-1, 0, 0}, Vec3{1, 2, -3}}) {
        const RigidMotion m = motion_along(direction, {1, 2, 3});
        EXPECT_NEAR(norm(m.turn({1, 0, 0}) - normalized(direction)), 0, 1e-15);
        EXPECT_NEAR(determinant(m.rotation), 1, 1e-15);
        EXPECT_NEAR(norm(m.place_back(m.place({4, 5, 6})) - Vec3{4, 5, 6}), 0, 1e-14);
        const RigidMotion twice = m.after(m);
        EXPECT_NEAR(norm(twice.place({4, 5, 6}) - m.place(m.place({4, 5, 6}))), 0, 1e-13);
    }
    EXPECT_EQ(motion_along({2, 0, 0}, {}).rotation, identity<double>());
}

TEST(SignedDistance, boundsHoldTheInside) {
    const SignedDistance d =
        moved(body_of_revolution(nozzle, TubeEnds::capped), motion_along({1, 1, 1}, {0.1, 0.2, 0.3}));
    const Bounds& b = d.bounds();
    for (const Vec3& x : random_points({{-4, -4, -4}, {4, 4, 4}}, 20000))
        if (d.value(x) < 0) {
            ASSERT_TRUE(x.x >= b.low.x && x.y >= b.low.y && x.z >= b.low.z);
            ASSERT_TRUE(x.x <= b.high.x && x.y <= b.high.y && x.z <= b.high.z);
        }
    EXPECT_TRUE(std::isfinite(b.low.x) && std::isfinite(b.high.z));
    const Bounds tube = moved(round_tube(1), RigidMotion{identity<double>(), {5, 6, 7}}).bounds();
    EXPECT_EQ(tube.low.x, -Bounds::infinity);
    EXPECT_EQ(tube.high.y, 7);
}

// Inside a union the smaller distance is a lower bound of the true depth. Two equal tubes that cross at right angles:
// at the edge where they meet the walls stand at 90 degrees or less, and a point at depth a below both is
// a / cos(45 deg) from the edge. So the true depth is at most sqrt(2) times the bound, and reaches that.
TEST(SignedDistance, ofUnionUnderestimatesDepthByAtMostTheEdgesAngle) {
    const SignedDistance d = union_of_round_cones({{{-9, 0, 0}, {9, 0, 0}, 1, 1}, {{0, 0, 0}, {0, 9, 0}, 1, 1}});
    double worst = 1, least = 2;
    for (const Vec3& x : random_points({{-1.2, -0.9, -0.9}, {1.2, 1.5, 0.9}}, 60, 3)) {
        if (d.value(x) > -0.05) continue;
        double depth = 100;       // the shortest of many rays to the wall, each walked by the distance itself
        const int rays = 40000;   // 1 degree apart: 1.5e-4 of the depth too long at most
        for (int k = 0; k < rays; ++k) {
            const double z = 1 - (2 * k + 1.0) / rays, angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
            const Vec3 way{std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
            double t = 0, step;
            while (t < depth && (step = -d.value(x + t * way)) > 1e-7) t += step;
            depth = std::min(depth, t);
        }
        worst = std::max(worst, depth / -d.value(x));
        least = std::min(least, depth / -d.value(x));
    }
    RecordProperty("largest_true_depth_over_bound", std::to_string(worst));
    EXPECT_GE(least, 1 - 1e-5);
    EXPECT_GT(worst, 1.2);
    EXPECT_LE(worst, std::sqrt(2.0) + 1e-3);
}

TEST(SignedDistance, refusesOutlinesThatAreNone) {
    EXPECT_THROW(body_of_revolution({}, TubeEnds::open), GeometryError);
    EXPECT_THROW(body_of_revolution({{1, 1}, {0, 1}}, TubeEnds::open), GeometryError);
    EXPECT_THROW(body_of_revolution({{1, -1}}, TubeEnds::open), GeometryError);
    EXPECT_THROW(union_of_round_cones({}), GeometryError);
    EXPECT_THROW(union_of_round_cones({{{}, {1, 0, 0}, 1, 0}}), GeometryError);
}

TEST(MadeWhenAsked, IsMadeOnceAndOnlyThen) {
    int made = 0;
    const SignedDistance later = made_when_asked(
        [&] {
            ++made;
            return SignedDistance(
                [](const Vec3& x) {
                    return DistanceSample{norm(x) - 1, normalized(x), 2 / norm(x)};
                },
                {{-1, -1, -1}, {1, 1, 1}});
        },
        {{-1, -1, -1}, {1, 1, 1}});
    const SignedDistance copy = later;
    EXPECT_EQ(copy.bounds().high, (Vec3{1, 1, 1}));
    EXPECT_EQ(made, 0);
    double sum = 0;
#pragma omp parallel for num_threads(4) reduction(+ : sum)
    for (int k = 1; k <= 100; ++k) sum += copy.value({double(k), 0, 0});
    EXPECT_DOUBLE_EQ(sum, 4950);
    EXPECT_DOUBLE_EQ(later.value({0, 0.5, 0}), -0.5);
    EXPECT_EQ(made, 1);
}

TEST(MadeWhenAsked, WhatGoesWrongComesWithTheQuestion) {
    const SignedDistance never = made_when_asked([]() -> SignedDistance { throw GeometryError("open"); }, {});
    EXPECT_THROW(never.value({0, 0, 0}), GeometryError);
    EXPECT_THROW(never.value({0, 0, 0}), GeometryError);
}

}   // namespace
}   // namespace patency
