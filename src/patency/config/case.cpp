// SPDX-License-Identifier: Apache-2.0
#include "patency/config/case.h"

#include <algorithm>

namespace patency::deck {

SchemeName Case::scheme() const {
    if (numerics.scheme) return *numerics.scheme;
    const bool has_waveform = std::any_of(openings.begin(), openings.end(), [](const auto& o) { return bool(o.second.waveform); });
    const bool is_still = wall.motion == WallMotion::rigid && wall.velocity.empty() && body_force.x == 0 && body_force.y == 0 && body_force.z == 0;
    const bool is_changing_once = about.mode == Mode::steady && has_waveform;
    return numerics.follows_vessel() || (has_vessel() && is_still && !is_changing_once) ? SchemeName::cells : SchemeName::sph;
}

}   // namespace patency::deck
