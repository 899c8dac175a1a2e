// SPDX-License-Identifier: Apache-2.0
#include "patency/config/case.h"

#include <algorithm>

namespace patency::deck {

bool Case::fits_cells() const {
    const bool has_waveform =
        std::any_of(openings.begin(), openings.end(), [](const auto& o) { return bool(o.second.waveform); });
    const bool is_still = wall.motion == WallMotion::rigid && wall.velocity.empty() && body_force.x == 0 &&
                          body_force.y == 0 && body_force.z == 0;
    const bool is_changing_once = about.mode == Mode::steady && has_waveform;
    return is_still && !is_changing_once;
}

SchemeName Case::scheme() const {
    if (numerics.scheme) return *numerics.scheme;
    return numerics.follows_vessel() || (has_vessel() && fits_cells()) ? SchemeName::cells : SchemeName::sph;
}

namespace {

bool starts_on_cells(const Case& c) {
    return c.about.mode == Mode::steady && c.numerics.convergence && c.scheme() != SchemeName::cells && c.fits_cells();
}

}   // namespace

InitialVelocity Case::initial_velocity() const {
    if (initial.velocity) return *initial.velocity;
    if (!has_vessel()) return InitialVelocity::rest;
    return starts_on_cells(*this) ? InitialVelocity::cells : InitialVelocity::estimate;
}

InitialPressure Case::initial_pressure() const {
    if (initial.pressure) return *initial.pressure;
    if (!has_vessel()) return InitialPressure::zero;
    return starts_on_cells(*this) ? InitialPressure::cells : InitialPressure::estimate;
}

}   // namespace patency::deck
