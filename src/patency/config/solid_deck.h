// SPDX-License-Identifier: Apache-2.0
// What a deck says about solids, in SI: `solids`, `contacts` and `numerics.solid`. Included by case.h, read as all of it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patency/base/vec.h"

namespace patency::deck {

enum class SolidShapeType { box, cylinder, sphere, stent };
inline std::vector<std::string_view> words(SolidShapeType) { return {"box", "cylinder", "sphere", "stent"}; }

enum class RadialToolType { balloon, crimper };
inline std::vector<std::string_view> words(RadialToolType) { return {"balloon", "crimper"}; }

enum class SolidLawName { neo_hookean, st_venant_kirchhoff, mooney_rivlin, yeoh, fibre_artery, j2_plastic };
inline std::vector<std::string_view> words(SolidLawName) {
    return {"neo_hookean", "st_venant_kirchhoff", "mooney_rivlin", "yeoh", "fibre_artery", "j2_plastic"};
}

enum class Relaxation { none, adaptive };
inline std::vector<std::string_view> words(Relaxation) { return {"none", "adaptive"}; }

/// A solid by its measures, filled with particles that fit it: rows of a box, rings of a cylinder; or the deck's stent.
struct SolidShape {
    SolidShapeType type = SolidShapeType::box;
    Vec3 from, to;                   ///< box: corners; cylinder: ends of its axis (planar: any along z); m
    Vec3 centre;                     ///< sphere: m
    double diameter = 0;             ///< cylinder, sphere: m
    double inner_diameter = 0;       ///< cylinder: m; 0: it is full
    std::optional<Vec3> low, high;   ///< cylinder, sphere: corners of a box, m; what lies out of it is cut off
    bool operator==(const SolidShape&) const = default;
};

/// Either the name of a material of the table, or a law with its numbers; what stands beside a name goes over it.
struct SolidMaterialChoice {
    std::optional<std::string> name;
    std::optional<SolidLawName> law;
    std::optional<double> density;                       ///< kg/m^3
    std::optional<double> young, poisson, shear, bulk;   ///< Pa; exactly two of them
    std::optional<double> c10, c01;                      ///< mooney_rivlin: Pa
    std::optional<double> c1, c2, c3;                    ///< yeoh: Pa
    std::optional<double> fibre_stiffness;               ///< fibre_artery: k1 [Pa]
    std::optional<double> fibre_growth;                  ///< fibre_artery: k2
    std::optional<double> fibre_dispersion;              ///< fibre_artery: kappa
    std::optional<double> fibre_angle;                   ///< fibre_artery: rad from around to along the cylinder
    std::optional<double> yield_stress;                  ///< j2_plastic: Pa
    std::optional<double> hardening;                     ///< j2_plastic: Pa
    std::optional<double> saturation_stress;             ///< j2_plastic: Pa
    std::optional<double> saturation_rate;               ///< j2_plastic
    bool operator==(const SolidMaterialChoice&) const = default;
};

/// Particles within a box of the reference configuration, or those that lie at a face, some of whose axes are told how to move.
struct Hold {   // exactly one of face, low + high
    std::optional<std::string> face;
    std::optional<Vec3> low, high;   ///< m, corners of the box
    std::array<bool, 3> axes{true, true, true};
    Vec3 displacement;   ///< m, of the held axes, in the end
    double ramp = 0;     ///< s in which it is reached, smoothly
    bool operator==(const Hold&) const = default;
};

/// A pressure on a face, on its area as it is deformed.
struct FacePressure {
    std::string face;                ///< box: x_low, x_high, ..; cylinder: inner, outer, from, to; sphere: outer
    std::vector<double> times;       ///< s, increasing
    std::vector<double> pressures;   ///< Pa at these times, linear between and constant after
    bool operator==(const FacePressure&) const = default;
};

struct SolidDeck {
    std::string name;
    SolidShape shape;
    SolidMaterialChoice material;
    std::optional<double> spacing;   ///< m; absent: that of numerics
    double mass_scaling = 1;         ///< on its density, for a longer step where inertia counts for nothing
    Vec3 velocity;                   ///< m/s at the start
    std::vector<Hold> holds;
    std::vector<FacePressure> pressures;
    bool operator==(const SolidDeck&) const = default;
};

struct Plane {
    Vec3 point;    ///< m
    Vec3 normal;   ///< out of what it bounds, to the solid; any length
    bool operator==(const Plane&) const = default;
};

/// A rigid tube of a radius that changes: a balloon pushes what is within it outwards, a crimper what is outside inwards.
struct RadialToolDeck {
    RadialToolType type = RadialToolType::balloon;
    Vec3 from, to;                   ///< m, the ends of its axis
    std::vector<double> times;       ///< s, increasing
    std::vector<double> diameters;   ///< m at these times, smooth between and constant after
    bool operator==(const RadialToolDeck&) const = default;
};

struct ContactDeck {   // exactly one of with, plane, tool
    std::string solid;
    std::optional<std::string> with;   ///< the other solid; the same: parts of it touch each other
    std::optional<Plane> plane;        ///< rigid, at rest
    std::optional<RadialToolDeck> tool;
    double friction = 0;   ///< Coulomb's coefficient
    double damping = 0;    ///< of the approach, over the critical
    bool operator==(const ContactDeck&) const = default;
};

struct SolidSettings {
    bool plane_strain = false;       ///< two-dimensional, z = 0
    double smoothing_ratio = 1.15;   ///< h over spacing
    double hourglass = 1;            ///< over the shear modulus
    double viscosity = 0;            ///< alpha
    double cfl = 0.6;
    Relaxation relaxation = Relaxation::none;
    bool operator==(const SolidSettings&) const = default;
};

}   // namespace patency::deck
