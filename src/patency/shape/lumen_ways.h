// SPDX-License-Identifier: Apache-2.0
// Rough ways through a lumen from its inlet to its outlets, which keep away from the wall. They find out how the vessels
// hang together; centring is centreline.h's.
#pragma once

#include <vector>

#include "patency/shape/lumen.h"

namespace patency {

/// A ball inside the lumen.
struct Ball {
    Vec3 centre;     ///< [m]
    double radius;   ///< not larger than its distance to the wall [m]
};

/// Whether the distance sees a flat cap at the opening, and does not go on through it.
bool is_capped(const SignedDistance& distance, const Opening& opening);
/// From this depth behind a cap on, the wall is nearer than the cap [m].
double depth_of_cap(const Opening& opening);

/// The distance to the wall alone, roughly: behind caps it is that of a lumen that goes on straight from depth_of_cap.
SignedDistance without_caps(SignedDistance distance, const std::vector<Opening>& openings);

/// For every opening but the inlet, in their order, a row of balls from the inlet's centre to its own, each overlapping
/// the next, so that a straight line from centre to centre stays inside; rows part once and do not meet again. Of all
/// rows it is the one with the least cost (14.1), among balls on cells that are halved until they are as small as the
/// narrowest place needs: no throat is lost, and nothing leaks from a vessel to its neighbour.
/// Throws GeometryError if an opening's centre is not inside, or no way leads to it.
std::vector<std::vector<Ball>> find_ways(const SignedDistance& distance, const std::vector<Opening>& openings,
                                         std::size_t inlet);

}   // namespace patency
