// SPDX-License-Identifier: Apache-2.0
// The linear equation of state of weakly compressible blood, both ways. The sound speed is a number of the computation,
// not of blood; which one is enough is decided elsewhere, THEORY (2.4).
#pragma once

namespace patency {

// T is double, float or a pack. Pressures [Pa] are above the reference pressure, densities in kg/m3, c in m/s.

/// rho = rho_0 + p / c^2, the inverse of THEORY (2.3).
template <class T>
T density_at_pressure(T pressure, T rest_density, T sound_speed) {
    return rest_density + pressure / (sound_speed * sound_speed);
}

/// p = c^2 (rho - rho_0), THEORY (2.3). Zero at rest_density; linear, so small differences keep their digits.
template <class T>
T pressure_at_density(T density, T rest_density, T sound_speed) {
    return sound_speed * sound_speed * (density - rest_density);
}

}   // namespace patency
