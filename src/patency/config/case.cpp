// SPDX-License-Identifier: Apache-2.0
#include "patency/config/case.h"

#include <algorithm>

namespace patency::deck {

SchemeName Case::scheme() const {
    if (numerics.scheme) return *numerics.scheme;
    const bool has_waveform = std::any_of(openings.begin(), openings.end(), [](const auto& o) { return bool(o.second.waveform); });
    const bool is_steady = about.mode == Mode::steady && wall.motion == WallMotion::rigid && wall.velocity.empty() && !has_waveform &&
                           body_force.x == 0 && body_force.y == 0 && body_force.z == 0;
    return numerics.follows_vessel() || (has_vessel() && is_steady) ? SchemeName::cells : SchemeName::sph;
}

}   // namespace patency::deck
