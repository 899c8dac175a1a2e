// SPDX-License-Identifier: Apache-2.0
// A wall of particles behind a surface, some kernel supports thick.
#pragma once

#include "patency/particles/particle_set.h"

namespace patency {

struct WallParticles : ParticleSet {
    Field<Vec3> position{*this, "position", "m", Keep::state};
    Field<Vec3> velocity{*this, "velocity", "m/s", Keep::state};   ///< of the wall's surface nearest to the particle
    Field<Vec3> normal{*this, "normal", "1", Keep::state};         ///< of that surface, out of the blood
    Field<double> depth{*this, "depth", "m", Keep::state};         ///< distance behind the surface
    Field<double> curvature{*this, "curvature", "1/m", Keep::state};   ///< divergence of the normal
    Field<double> volume{*this, "volume", "m^3", Keep::state};
};

}   // namespace patency
