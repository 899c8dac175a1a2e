// SPDX-License-Identifier: Apache-2.0
// The point of a segment or a triangle that is nearest to another, by its weights.
#pragma once

#include <algorithm>
#include <array>

#include "patency/base/vec.h"

namespace patency {

/// Weights of the corners; they add up to one.
inline std::array<double, 3> closest_on_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double t = std::clamp(dot(x - a, ab) / dot(ab, ab), 0.0, 1.0);
    return {1 - t, t, 0};
}

/// By the region of the plane (or of an edge, or a corner) that x lies over (Ericson 2004, section 5.1.5).
inline std::array<double, 3> closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
    const double d1 = dot(ab, ax), d2 = dot(ac, ax), d3 = dot(ab, bx), d4 = dot(ac, bx), d5 = dot(ab, cx),
                 d6 = dot(ac, cx);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

}   // namespace patency
