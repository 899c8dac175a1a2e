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

}   // namespace patency
