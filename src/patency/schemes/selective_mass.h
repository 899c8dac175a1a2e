// SPDX-License-Identifier: Apache-2.0
// A body that is heavy for what its particles do against each other and has its own mass for what they do together: the
// fastest vibrations, which set the time step, become slow; a strut swings as it would. For bodies that are driven so slowly
// that inertia should count for nothing.                                                            THEORY (20.17)
#pragma once

#include <vector>

#include "patency/bodies/solid_surface.h"

namespace patency {

class SelectiveMass {
public:
    /// Finds patches of particles that are connected, about five spacings wide. scaling >= 1, one for each particle: how many times heavier
    /// it is against its neighbours. spacing [m]. Particles must be in their final order.
    SelectiveMass(const SolidParticles& particles, double spacing, const std::vector<double>& scaling);

    /// Overwrites the particles' velocities: v = S p / m, of the momenta p [kg m/s]. Their sum p is that of m v.
    void compute_velocity(const std::vector<Vec3>& momentum, SolidParticles& particles) const;

private:
    struct Share {
        std::uint32_t index;
        double weight;   // all of a particle's are together what it is not alone: 1 - 1 / scaling
    };
    std::vector<double> alone_;   // 1 / scaling
    Ragged<Share> patches_;       // of a particle
    Ragged<Share> members_;       // of a patch
    std::vector<double> mass_;
    mutable std::vector<Vec3> together_;   // velocities of the patches
};

}   // namespace patency
