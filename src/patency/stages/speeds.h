// SPDX-License-Identifier: Apache-2.0
// What speeds and pressures a case will reach, estimated before it runs, and the sound speed that follows.
#pragma once

#include <span>
#include <vector>

#include "patency/bodies/fluid.h"
#include "patency/config/case.h"
#include "patency/shape/lumen.h"
#include "patency/stages/end_law.h"
#include "patency/stages/estimated_field.h"

namespace patency {

struct Expected {
    double speed = 0;            ///< the largest to be reached [m/s]
    double pressure_range = 0;   ///< of the blood, above the reference level [Pa]
    double outflow = 0;          ///< largest flow through the domain; 0 where it is not prescribed [m^3/s]
};

/// From the openings' velocities and flows, through the narrowest section; else from the pressures that drive: the
/// smallest of Poiseuille's, Bernoulli's and what the resistances behind the outlets let out; walls, body force and initial
/// velocity alike.
Expected estimate_expected(const deck::Case& config, const Lumen& lumen, std::span<const EndLaw> laws,
                           const FluidMaterial& material);

/// What the estimate of a vessel says of the same, at the height of the pulse that drives it; it overrules what was told from
/// the openings alone, but no reference_speed of the deck.
void expect_estimate(Expected& expected, const deck::Case& config, const EstimatedField& field,
                     std::span<const EndLaw> laws, const FluidMaterial& material);

/// numerics.sound_speed, or sound_speed_factor times the expected speed; else the largest of 10 times that speed
/// (density within 1 %), sqrt(pressure range / (0.01 rho)) and, of a pulse, omega L / 0.1 (a wave passes in a sixtieth of
/// the period).
double choose_sound_speed(const deck::Case& config, const Lumen& lumen, const Expected& expected,
                          const FluidMaterial& material);

}   // namespace patency
