// SPDX-License-Identifier: Apache-2.0
// From rest to rest.
#pragma once

#include <algorithm>

namespace patency {

/// 0 at or before 0, 1 at or after 1, without slope and curvature at both; its steepest slope is 15/8.
inline double smooth_rise(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return s * s * s * (10 + s * (-15 + 6 * s));
}

/// From 0 to 1, from rest to rest, at a speed that grows evenly from a half to one and a half times the mean: what a driven body
/// has taken up grows with the way, and its energy of motion should not stand beside it. Gathered and lost in the first and the
/// last twentieth.                                                                                    THEORY (21.14)
inline double growing_rise(double s) {
    constexpr double edge = 0.05, first = 0.5, last = 1.5, slope = (last - first) / (1 - 2 * edge);
    constexpr double whole = (0.5 * edge) * (first + last) + (1 - 2 * edge) * 0.5 * (first + last);
    s = std::clamp(s, 0.0, 1.0);
    if (s < edge) return 0.5 * first * s * s / edge / whole;
    if (s > 1 - edge) return 1 - 0.5 * last * (1 - s) * (1 - s) / edge / whole;
    const double t = s - edge;
    return (0.5 * first * edge + (first + 0.5 * slope * t) * t) / whole;
}

}   // namespace patency
