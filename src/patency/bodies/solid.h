// SPDX-License-Identifier: Apache-2.0
// A solid: its particles, what they are made of, and what holds them. How they move is a scheme's business.
#pragma once

#include <array>
#include <functional>
#include <variant>
#include <vector>

#include "patency/particles/particle_set.h"
#include "patency/physics/solid/fibre_artery.h"
#include "patency/physics/solid/hyperelastic.h"
#include "patency/physics/solid/plastic.h"

namespace patency {

using SolidLaw = std::variant<NeoHookean, StVenantKirchhoff, MooneyRivlin, Yeoh, FibreArtery, J2Plastic>;

struct SolidMaterial {
    double density = 0;   ///< rho_0 [kg/m^3]
    SolidLaw law;

    ElasticModuli moduli() const {
        return std::visit([](const auto& l) { return l.moduli(); }, law);
    }
};

/// Particles of one solid. Volumes are those of the reference configuration, which is free of stress.
struct SolidParticles : ParticleSet {
    Field<Vec3> position{*this, "position", "m", Keep::state};
    Field<Vec3> reference{*this, "reference_position", "m", Keep::state};
    Field<Vec3> velocity{*this, "velocity", "m/s", Keep::state};
    Field<double> volume{*this, "volume", "m^3", Keep::state};           ///< m^2 in the plane
    Field<double> mass{*this, "mass", "kg", Keep::state};                ///< kg/m in the plane
    Field<std::int32_t> material{*this, "material", "1", Keep::state};   ///< index into the body's materials
    Field<std::int32_t> constraint{*this, "constraint", "1",
                                   Keep::state};                       ///< 0: free; else 1 + index of its constraint
    Field<Vec3> first_fibre{*this, "first_fibre", "1", Keep::state};   ///< unit vectors; zero: none
    Field<Vec3> second_fibre{*this, "second_fibre", "1", Keep::state};
    Field<Mat3> inverse_plastic{*this, "inverse_plastic", "1", Keep::state};   ///< C_p^-1
    Field<double> plastic_strain{*this, "plastic_strain", "1", Keep::state};
    Field<Vec3> force{*this, "force", "N", Keep::scratch};   ///< by the stress in the body
    Field<Vec3> load{*this, "load", "N", Keep::scratch};     ///< by everything else
};

/// What some particles must do: `held` axes follow `displacement` (reference place [m], time [s]) -> [m], or stay.
struct Constraint {
    std::array<bool, 3> held{true, true, true};
    std::function<Vec3(const Vec3& reference, double time)> displacement;   ///< empty: stay
};

/// A solid body. Particles may be reordered by a scheme.
struct Solid {
    SolidParticles particles;
    std::vector<SolidMaterial> materials;
    std::vector<Constraint> constraints;
};

/// New particles at rest at `places` [m], each `volume` [m^3] (planar: m^2) of material 0, without constraint.
void place_particles(Solid& solid, const std::vector<Vec3>& places, double volume);

}   // namespace patency
