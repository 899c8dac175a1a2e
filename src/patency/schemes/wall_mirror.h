// SPDX-License-Identifier: Apache-2.0
// What the linear mirror of a wall leaves out of a velocity gradient beside it: blood that rests at a wall may move along it
// faster here than there, and then rises from it. Arithmetic in any unit of length.                       THEORY.md (5)
#pragma once

#include <algorithm>

#include "patency/base/vec.h"

namespace patency {

/// Wall as a particle before it sees it, the sums over the wall's particles with their depth D.
struct WallBehind {
    Vec3 normal;       ///< out of the blood
    double distance;   ///< s, of the particle from the surface
    Mat3 spread;       ///< sum w D d d
    Vec3 bend;         ///< sum w D (D + s)/2 d
};

/// L of a particle beside a wall at rest, from its sums with the mirror (5.2) and the inverse of its second moment: exact for the
/// velocities g(a) s along a plane wall, a a place on it, and what rises from it so that nothing expands. Nearer to the wall than
/// `nearest` the particle rises no steeper.                                                      THEORY.md (5.5), (5.6)
inline Mat3 gradient_beside_wall(const Mat3& sums, const Mat3& correction, const WallBehind& wall, double nearest) {
    const Vec3& n = wall.normal;
    const Mat3 along = identity<double>() - outer(n, n);
    const Mat3 solve =
        inverse(identity<double>() + (1 / wall.distance) * (correction * (along * wall.spread))) * correction;
    const Mat3 level = sums * solve;
    const double spreading = trace(level) - dot(n, level * n);
    return level - (spreading / std::max(wall.distance, nearest)) * (outer(n, wall.bend) * solve);
}

}   // namespace patency
