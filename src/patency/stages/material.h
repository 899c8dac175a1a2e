// SPDX-License-Identifier: Apache-2.0
// The blood of a deck as a material.
#pragma once

#include "patency/bodies/fluid.h"
#include "patency/config/case.h"
#include "patency/physics/fluid/rheology.h"

namespace patency {

/// The law of the blood's viscosity.
Rheology make_rheology(const deck::Blood& blood);

/// Density and viscosity; the sound speed is chosen later (speeds.h).
FluidMaterial make_material(const deck::Blood& blood);

}   // namespace patency
