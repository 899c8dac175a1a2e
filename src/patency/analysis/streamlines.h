// SPDX-License-Identifier: Apache-2.0
// Lines along the velocity of the blood at one instant. Reads particles; moves none.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "patency/analysis/sample.h"

namespace patency {

struct Streamline {
    std::vector<Vec3> points;       ///< [m], the seed first
    std::vector<Vec3> velocity;     ///< there [m/s]
    std::vector<double> pressure;   ///< there, above the reference pressure [Pa]
};

struct StreamlineRule {
    LocalLength step;                             ///< length from a place to the next [m]
    double longest;                               ///< [m]
    double slowest;                               ///< a line ends where the blood is slower [m/s]
    LocalLength reach;                            ///< of samples
    std::function<bool(const Vec3&)> is_inside;   ///< a line ends where this is false
};

/// One line per seed, downstream, by the midpoint rule. Lines that end at once have one point.
std::vector<Streamline> trace_streamlines(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> seeds,
                                          const StreamlineRule& rule, const WallHint& wall);

}   // namespace patency
