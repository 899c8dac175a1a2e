// SPDX-License-Identifier: Apache-2.0
// The Riemann problem between two particles of weakly compressible blood, linearised, with a limited dissipation (Zhang,
// Hu & Adams 2017). One sound speed on both sides; what a pair does with the answer is its scheme's business.
#pragma once

#include "patency/base/pack.h"

namespace patency {

/// One side of the pair's interface. The line runs from the left particle i to the right one j: with e_ij from j to i the
/// velocities are U = -v.e_ij, THEORY (4.1), and U_L - U_R > 0 means that the particles approach each other.
template <class T>
struct RiemannSide {
    T density;    // kg/m3
    T velocity;   // m/s, along the line from left to right
    T pressure;   // Pa
};

/// beta [m/s] = min(3 max(U_L - U_R, 0), c), THEORY (4.3): nothing between particles that part, at most c.
template <class T>
T riemann_limiter(T approach, T sound_speed) {
    return min(T(3) * max(approach, T(0)), sound_speed);
}

/// U* [m/s] = (U_L + U_R)/2 + (P_L - P_R) / (c (rho_L + rho_R)), THEORY (11.3). Swapping the particles changes its sign.
template <class T>
T star_velocity(const RiemannSide<T>& left, const RiemannSide<T>& right, T sound_speed) {
    return T(0.5f) * (left.velocity + right.velocity) +
           (left.pressure - right.pressure) / (sound_speed * (left.density + right.density));
}

/// P* [Pa] = (P_L + P_R)/2 + rho_L rho_R beta (U_L - U_R) / (rho_L + rho_R), THEORY (11.3). Swapping the particles
/// changes nothing, bit for bit: the pair's forces are opposite.
template <class T>
T star_pressure(const RiemannSide<T>& left, const RiemannSide<T>& right, T sound_speed) {
    const T approach = left.velocity - right.velocity;
    return T(0.5f) * (left.pressure + right.pressure) + left.density * right.density / (left.density + right.density) *
                                                            (riemann_limiter(approach, sound_speed) * approach);
}

}   // namespace patency
