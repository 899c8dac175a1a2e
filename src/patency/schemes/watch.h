// SPDX-License-Identifier: Apache-2.0
// What every scheme watches: that particles are where they can be and move as fast as they may. A computation that went
// wrong ends here, with the particle, its place and its values.
#pragma once

#include "patency/schemes/flow_scheme.h"

namespace patency {

/// Throws DeckError where a difference of positions in double precision would have to take the short way round a box.
void check_precision(Precision precision, const Frame& frame);

/// Throws DivergedError if a particle has left the frame.
void check_inside(const FluidParticles& fluid, const Frame& frame);

/// The largest speed [m/s]. Throws DivergedError if there is a velocity that is no number or far beyond the speed of
/// sound [m/s].
double find_fastest(const FluidParticles& fluid, double sound_speed);

}   // namespace patency
