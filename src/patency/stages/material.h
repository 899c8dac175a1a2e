// SPDX-License-Identifier: Apache-2.0
// The blood of a deck as a material.
#pragma once

#include "patency/bodies/fluid.h"
#include "patency/config/case.h"

namespace patency {

/// Density and viscosity; the sound speed is chosen later (speeds.h).
FluidMaterial make_material(const deck::Blood& blood);

}   // namespace patency
