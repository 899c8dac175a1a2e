// SPDX-License-Identifier: Apache-2.0
// The keys of solids, of what they are made of and how they touch.
#include "patency/config/schema_rows.h"

namespace patency::deck {

namespace {

constexpr double stiffest = 1e13;   // Pa; diamond has 1e12

Row modulus(std::string key, std::string help) {
    return {.key = std::move(key),
            .help = std::move(help),
            .unit = "Pa",
            .range = above_up_to(0, stiffest),
            .example = "1 MPa"};
}

}   // namespace

template <>
const Table& table_of<SolidShape>() {
    const Condition straight = where("type", {"box", "cylinder"}), round = where("type", {"cylinder", "sphere"});
    static const Table table = make_table<SolidShape>(
        "The solid's shape by its measures.",
        {
            row(&SolidShape::type, {.key = "type", .help = "the kind of shape", .need = always}),
            row(&SolidShape::from, {.key = "from",
                                    .help = "the box's lowest corner, or one end of the cylinder's axis",
                                    .unit = "mm",
                                    .range = between(-largest_length, largest_length),
                                    .only = straight,
                                    .need = always}),
            row(&SolidShape::to, {.key = "to",
                                  .help = "the box's highest corner, or the other end",
                                  .unit = "mm",
                                  .range = between(-largest_length, largest_length),
                                  .only = straight,
                                  .need = always}),
            row(&SolidShape::centre, {.key = "centre",
                                      .help = "the middle of the sphere",
                                      .unit = "mm",
                                      .range = between(-largest_length, largest_length),
                                      .only = where("type", {"sphere"}),
                                      .need = always}),
            row(&SolidShape::diameter, {.key = "diameter",
                                        .help = "the outer diameter",
                                        .unit = "mm",
                                        .range = above_up_to(0, largest_length),
                                        .only = round,
                                        .need = always}),
            row(&SolidShape::inner_diameter, {.key = "inner_diameter",
                                              .help = "the diameter of the hole; 0 if there is none",
                                              .unit = "mm",
                                              .range = between(0, largest_length),
                                              .only = where("type", {"cylinder"})}),
            row(&SolidShape::low,
                {.key = "low",
                 .help = "the lowest corner of a box; what lies out of it is cut off, and has no face there",
                 .unit = "mm",
                 .range = between(-largest_length, largest_length),
                 .only = round}),
            row(&SolidShape::high, {.key = "high",
                                    .help = "its highest corner",
                                    .unit = "mm",
                                    .range = between(-largest_length, largest_length),
                                    .only = round}),
        });
    return table;
}

template <>
const Table& table_of<SolidMaterialChoice>() {
    using M = SolidMaterialChoice;
    static const Table table = make_table<SolidMaterialChoice>(
        "What the solid is made of: a name of the program's table, or a law with its numbers, or numbers that go over "
        "the table's.",
        {
            row(&M::name, {.key = "name", .help = "a material of the table", .example = "316L"}),
            row(&M::law, {.key = "law", .help = "how stress follows from deformation"}),
            row(&M::density, {.key = "density",
                              .help = "mass per volume",
                              .unit = "kg/m^3",
                              .range = above_up_to(0, 3e4),
                              .example = "1100 kg/m^3"}),
            row(&M::young, modulus("young", "Young's modulus; exactly two of young, poisson, shear and bulk")),
            row(&M::poisson,
                {.key = "poisson", .help = "Poisson's ratio", .range = between(-0.999, 0.4999), .example = "0.45"}),
            row(&M::shear, modulus("shear", "the shear modulus")),
            row(&M::bulk, modulus("bulk", "the bulk modulus")),
            row(&M::c10, modulus("c10", "mooney_rivlin: of the first invariant; with bulk")),
            row(&M::c01, {.key = "c01",
                          .help = "mooney_rivlin: of the second invariant",
                          .unit = "Pa",
                          .range = between(0, stiffest),
                          .example = "10 kPa"}),
            row(&M::c1, modulus("c1", "yeoh: of the first invariant; with bulk")),
            row(&M::c2, {.key = "c2",
                         .help = "yeoh: of its square",
                         .unit = "Pa",
                         .range = between(-stiffest, stiffest),
                         .example = "1 kPa"}),
            row(&M::c3, {.key = "c3",
                         .help = "yeoh: of its cube",
                         .unit = "Pa",
                         .range = between(-stiffest, stiffest),
                         .example = "1 kPa"}),
            row(&M::fibre_stiffness, modulus("fibre_stiffness", "fibre_artery: k1; shear and bulk are the matrix's")),
            row(&M::fibre_growth,
                {.key = "fibre_growth", .help = "fibre_artery: k2", .range = above_up_to(0, 1e4), .example = "8"}),
            row(&M::fibre_dispersion, {.key = "fibre_dispersion",
                                       .help = "fibre_artery: kappa",
                                       .range = between(0, 1.0 / 3),
                                       .example = "0.1"}),
            row(&M::fibre_angle, {.key = "fibre_angle",
                                  .help = "fibre_artery: of both families, from around the cylinder to along it",
                                  .unit = "deg",
                                  .range = between(0, 1.58),
                                  .example = "40 deg"}),
            row(&M::yield_stress, modulus("yield_stress", "j2_plastic: where it begins to flow")),
            row(&M::hardening, {.key = "hardening",
                                .help = "j2_plastic: rise of the yield stress over plastic strain",
                                .unit = "Pa",
                                .range = between(0, stiffest),
                                .example = "1 GPa"}),
            row(&M::saturation_stress, modulus("saturation_stress", "j2_plastic, Voce: the yield stress in the end")),
            row(&M::saturation_rate, {.key = "saturation_rate",
                                      .help = "j2_plastic, Voce: 1 over the plastic strain of saturation",
                                      .range = between(0, 1e6),
                                      .example = "12"}),
        },
        {{.keys = {"name", "law"}}});
    return table;
}

template <>
const Table& table_of<Hold>() {
    static const Table table = make_table<Hold>(
        "Particles of a solid that are held or led.",
        {
            row(&Hold::face, {.key = "face", .help = "the face they lie at, instead of a box", .example = "\"outer\""}),
            row(&Hold::low,
                {.key = "low", .help = "the lowest corner of the box they are in at first; with high", .unit = "mm"}),
            row(&Hold::high, {.key = "high", .help = "its highest corner", .unit = "mm"}),
            row(&Hold::axes, {.key = "axes", .help = "which axes are held", .example = "[true, false, false]"}),
            row(&Hold::displacement,
                {.key = "displacement", .help = "where the held axes go; they stay if absent", .unit = "mm"}),
            row(&Hold::ramp,
                {.key = "ramp", .help = "the time in which they go there", .unit = "s", .range = between(0, 1e4)}),
        },
        {{.keys = {"face", "low"}}});
    return table;
}

template <>
const Table& table_of<FacePressure>() {
    static const Table table = make_table<FacePressure>(
        "A pressure on a face of a solid, on its deformed area.",
        {
            row(&FacePressure::face,
                {.key = "face",
                 .help = "x_low .. z_high of a box; inner, outer, from, to of a cylinder; outer of a sphere",
                 .example = "\"inner\"",
                 .need = always}),
            row(&FacePressure::times,
                {.key = "times", .help = "when", .unit = "s", .range = at_least(0), .need = always}),
            row(&FacePressure::pressures, {.key = "pressures",
                                           .help = "the pressure at these times, linear between",
                                           .unit = "Pa",
                                           .range = between(-1e12, 1e12),
                                           .need = always}),
        });
    return table;
}

template <>
const Table& table_of<SolidDeck>() {
    static const Table table = make_table<SolidDeck>(
        "A solid.",
        {
            row(&SolidDeck::name,
                {.key = "name", .help = "the name of the solid", .example = "\"wall\"", .need = always}),
            row(&SolidDeck::shape, {.key = "shape", .help = "its shape", .need = always}),
            row(&SolidDeck::material, {.key = "material", .help = "what it is made of", .need = always}),
            row(&SolidDeck::spacing, {.key = "spacing",
                                      .help = "the distance between its particles; that of numerics if absent",
                                      .unit = "mm",
                                      .range = above_up_to(0, 1),
                                      .example = "0.1 mm"}),
            row(&SolidDeck::mass_scaling,
                {.key = "mass_scaling",
                 .help = "a factor on its density: a longer step, where its inertia counts for nothing",
                 .range = between(1, 1e8),
                 .example = "100"}),
            row(&SolidDeck::velocity,
                {.key = "velocity", .help = "at the start", .unit = "m/s", .range = between(-1e4, 1e4)}),
            row(&SolidDeck::holds, {.key = "holds", .help = "particles that are held or led"}),
            row(&SolidDeck::pressures, {.key = "pressures", .help = "pressures on its faces"}),
        });
    return table;
}

template <>
const Table& table_of<Plane>() {
    static const Table table = make_table<Plane>(
        "A rigid plane at rest.",
        {
            row(&Plane::point, {.key = "point", .help = "a point on it", .unit = "mm", .need = always}),
            row(&Plane::normal, {.key = "normal",
                                 .help = "the direction from it to the solid",
                                 .example = "[0, 0, 1]",
                                 .need = always}),
        });
    return table;
}

template <>
const Table& table_of<RadialToolDeck>() {
    static const Table table = make_table<RadialToolDeck>(
        "A rigid tube of a diameter that changes.",
        {
            row(&RadialToolDeck::type,
                {.key = "type", .help = "a balloon pushes outwards, a crimper inwards", .need = always}),
            row(&RadialToolDeck::from, {.key = "from",
                                        .help = "one end of its axis",
                                        .unit = "mm",
                                        .range = between(-largest_length, largest_length),
                                        .need = always}),
            row(&RadialToolDeck::to, {.key = "to",
                                      .help = "the other end",
                                      .unit = "mm",
                                      .range = between(-largest_length, largest_length),
                                      .need = always}),
            row(&RadialToolDeck::times,
                {.key = "times", .help = "when", .unit = "s", .range = at_least(0), .need = always}),
            row(&RadialToolDeck::diameters, {.key = "diameters",
                                             .help = "its diameter at these times; between them it goes at one speed",
                                             .unit = "mm",
                                             .range = above_up_to(0, largest_length),
                                             .need = always}),
        });
    return table;
}

template <>
const Table& table_of<ContactDeck>() {
    static const Table table = make_table<ContactDeck>(
        "What touches what.",
        {
            row(&ContactDeck::solid,
                {.key = "solid", .help = "the name of a solid", .example = "\"stent\"", .need = always}),
            row(&ContactDeck::with, {.key = "with",
                                     .help = "the name of another, or the same: its parts touch each other",
                                     .example = "\"wall\""}),
            row(&ContactDeck::plane, {.key = "plane", .help = "a rigid plane"}),
            row(&ContactDeck::tool, {.key = "tool", .help = "a balloon or a crimper"}),
            row(&ContactDeck::friction, {.key = "friction", .help = "Coulomb's coefficient", .range = between(0, 10)}),
            row(&ContactDeck::damping, {.key = "damping",
                                        .help = "of the approach, over the critical; it never pulls",
                                        .range = between(0, 1)}),
        },
        {{.keys = {"with", "plane", "tool"}}});
    return table;
}

template <>
const Table& table_of<SolidSettings>() {
    static const Table table = make_table<SolidSettings>(
        "How solids are computed.",
        {
            row(&SolidSettings::plane_strain,
                {.key = "plane_strain", .help = "two-dimensional: z = 0, nothing moves or stretches along z"}),
            row(&SolidSettings::smoothing_ratio,
                {.key = "smoothing_ratio", .help = "smoothing length over spacing", .range = between(1, 2)}),
            row(&SolidSettings::hourglass,
                {.key = "hourglass",
                 .help = "stiffness against alternating displacements, over the shear modulus",
                 .range = between(0, 10)}),
            row(&SolidSettings::viscosity, {.key = "viscosity",
                                            .help = "artificial, over density x P-wave speed x smoothing length / 2",
                                            .range = between(0, 2)}),
            row(&SolidSettings::cfl, {.key = "cfl",
                                      .help = "time step over smoothing length / P-wave speed",
                                      .range = above_up_to(0, 0.75)}),
            row(&SolidSettings::relaxation,
                {.key = "relaxation", .help = "adaptive: motion is damped away, for a state of rest"}),
        });
    return table;
}

}   // namespace patency::deck
