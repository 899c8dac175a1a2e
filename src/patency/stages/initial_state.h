// SPDX-License-Identifier: Apache-2.0
// The blood at time zero: velocity and pressure as the deck says, with the pressure gradient that belongs to them.
#pragma once

#include "patency/stages/scene.h"

namespace patency {

/// Overwrites velocity, pressure (above scene.reference_pressure), pressure gradient, pressure rate and viscosity.
/// Throws DeckError where the shape knows no such field.
void compute_initial_state(Scene& scene);

}  // namespace patency
