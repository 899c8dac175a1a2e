// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/material.h"

#include <cmath>

#include "patency/physics/fluid/rheology.h"

namespace patency {

Rheology make_rheology(const deck::Blood& blood) {
    switch (blood.law) {
        case deck::BloodLaw::newtonian: break;
        case deck::BloodLaw::carreau_yasuda:
            return CarreauYasuda{blood.mu_0, blood.mu_inf, blood.lambda, blood.n, blood.a};
        case deck::BloodLaw::casson: {
            // Regularised so that the viscosity at rest is the deck's largest: THEORY.md (10.3) at g = 0.
            const double root = std::sqrt(blood.max_viscosity) - std::sqrt(blood.plastic_viscosity);
            const double time = blood.yield_stress > 0 ? root * root / blood.yield_stress : 0;
            return Casson{blood.yield_stress, blood.plastic_viscosity, time};
        }
        case deck::BloodLaw::power_law:
            return PowerLaw{blood.consistency, blood.n, blood.min_viscosity, blood.max_viscosity};
    }
    return Newtonian{blood.viscosity};
}

FluidMaterial make_material(const deck::Blood& blood) {
    const Rheology law = make_rheology(blood);
    FluidMaterial material{
        .density = blood.density, .viscosity = largest_viscosity(law), .sound_speed = 0, .viscosity_at = {}};
    if (!std::holds_alternative<Newtonian>(law))
        material.viscosity_at = [law](double shear_rate) { return viscosity(law, shear_rate); };
    return material;
}

}   // namespace patency
