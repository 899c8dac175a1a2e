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

/// From 0 to 1 at one speed, but for the first and the last `share` of the way's time, in which it gathers and loses it: then
/// little energy of motion stands beside what a driven body has taken up.
inline double steady_rise(double s, double share = 0.05) {
    s = std::clamp(s, 0.0, 1.0);
    const double speed = 1 / (1 - share);
    if (s < share) return 0.5 * speed * s * s / share;
    if (s > 1 - share) return 1 - 0.5 * speed * (1 - s) * (1 - s) / share;
    return speed * (s - 0.5 * share);
}

}   // namespace patency
