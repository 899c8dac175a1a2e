// SPDX-License-Identifier: Apache-2.0
// The laws that an exact signed distance obeys, checked at random places.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "patency/shape/signed_distance.h"

namespace patency {

inline std::vector<Vec3> random_points(const Bounds& box, int count, unsigned seed = 1) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) {
        const double a = unit(engine), b = unit(engine), c = unit(engine);
        points.push_back({box.low.x + a * (box.high.x - box.low.x), box.low.y + b * (box.high.y - box.low.y),
                          box.low.z + c * (box.high.z - box.low.z)});
    }
    return points;
}

/// A function is the distance to its zero set if and only if it never changes faster than one walks, and walking
/// the distance against the gradient ends on the zero set. Lengths are of order one, so 1e-12 is round-off.
inline void expect_exact_distance(const SignedDistance& d, const Bounds& box, int count = 4000) {
    const std::vector<Vec3> points = random_points(box, count);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec3& x = points[k];
        const DistanceSample s = d.sample(x);
        ASSERT_NEAR(norm(s.gradient), 1, 1e-12) << "at " << x.x << ' ' << x.y << ' ' << x.z;
        ASSERT_NEAR(d.value(x - s.value * s.gradient), 0, 1e-12) << "at " << x.x << ' ' << x.y << ' ' << x.z;
        const Vec3& y = points[(k * 7 + 1) % points.size()];
        const Vec3 near = x + 0.01 * (y - x);
        ASSERT_LE(std::abs(d.value(y) - s.value), norm(y - x) + 1e-12);
        ASSERT_LE(std::abs(d.value(near) - s.value), norm(near - x) + 1e-12);
    }
}

/// Where the distance is smooth: the gradient is the slope of the value and the curvature that of the gradient.
/// Central differences over +-e err by e^2/6 times a third derivative, which is below 1e4 at 0.05 or more from
/// the axis and from the edges (places nearer to them show as a jump of the curvature and are left out).
inline void expect_consistent_derivatives(const SignedDistance& d, const Bounds& box, int count = 4000) {
    const double e = 1e-5;
    int smooth = 0;
    for (const Vec3& x : random_points(box, count, 2)) {
        const DistanceSample s = d.sample(x);
        if (std::abs(s.curvature) > 20) continue;
        bool jump = false;
        for (int k = 0; k < 6; ++k) {
            const double sign = k < 3 ? 3 : -3;
            const Vec3 beside = x + sign * e * Vec3{double(k % 3 == 0), double(k % 3 == 1), double(k % 3 == 2)};
            jump = jump || norm(d.gradient(beside) - s.gradient) > 1e-2 ||
                   std::abs(d.curvature(beside) - s.curvature) > 1e-2;
        }
        if (jump) continue;
        ++smooth;
        const auto slope = [&](const Vec3& n) { return (d.value(x + e * n) - d.value(x - e * n)) / (2 * e); };
        ASSERT_NEAR(slope({1, 0, 0}), s.gradient.x, 1e-6);
        ASSERT_NEAR(slope({0, 1, 0}), s.gradient.y, 1e-6);
        ASSERT_NEAR(slope({0, 0, 1}), s.gradient.z, 1e-6);
        ASSERT_NEAR(curvature_by_differences(d, x, e), s.curvature, 1e-5);
    }
    EXPECT_GT(smooth, count / 2);
}

}   // namespace patency
