// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/solid.h"

namespace patency {

void place_particles(Solid& solid, const std::vector<Vec3>& places, double volume) {
    SolidParticles& p = solid.particles;
    p.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        p.position[i] = p.reference[i] = places[i];
        p.velocity[i] = {};
        p.volume[i] = volume;
        p.mass[i] = solid.materials.at(0).density * volume;
        p.material[i] = p.constraint[i] = 0;
        p.first_fibre[i] = p.second_fibre[i] = {};
        p.inverse_plastic[i] = identity<double>();
        p.plastic_strain[i] = 0;
    }
}

}   // namespace patency
