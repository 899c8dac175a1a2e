// SPDX-License-Identifier: Apache-2.0
// Blood: its particles and its material. How they move is a scheme's business.
#pragma once

#include <functional>

#include "patency/particles/particle_set.h"

namespace patency {

/// Weakly compressible blood: p = c^2 (rho - rho_0) above the reference pressure.             THEORY.md (2.1)
struct FluidMaterial {
    double density = 1060;                        ///< rho_0 [kg/m^3]
    double viscosity = 3.5e-3;                    ///< dynamic; the largest there is, where it varies [Pa s]
    double sound_speed = 1;                       ///< c of the artificial compressibility [m/s]
    std::function<double(double)> viscosity_at;   ///< of the shear rate [1/s]; empty: constant

    double kinematic_viscosity() const { return viscosity / density; }
};

/// Particles of blood. Those beyond an opening's plane are its buffer: they carry the opening's number.
struct FluidParticles : ParticleSet {
    Field<Vec3> position{*this, "position", "m", Keep::state};
    Field<Vec3> velocity{*this, "velocity", "m/s", Keep::state};
    Field<double> pressure{*this, "pressure", "Pa", Keep::state};   ///< above the reference pressure
    Field<double> pressure_rate{*this, "pressure_rate", "Pa/s", Keep::state};
    Field<double> volume{*this, "volume", "m^3", Keep::state};   ///< at rest; m^2 in the plane
    Field<std::int32_t> opening{*this, "opening", "1",
                                Keep::state};   ///< 0 inside, else 1 + the opening's index; negative in the tail
    Field<Vec3> pressure_gradient{*this, "pressure_gradient", "Pa/m", Keep::state};
    Field<Mat3> velocity_gradient{*this, "velocity_gradient", "1/s", Keep::state};   ///< row a: gradient of v_a
    Field<double> viscosity{*this, "viscosity", "Pa s", Keep::state};
    Field<Vec3> slow_acceleration{*this, "slow_acceleration", "m/s^2", Keep::scratch};

    /// Mean divergence that the sums of the last acoustic step report beyond what leaves through the openings, of all
    /// blood but that in their entrances [1/s].
    double excess_divergence = 0;   //                                                            THEORY.md (4.10)
};

}   // namespace patency
