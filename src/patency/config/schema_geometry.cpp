// SPDX-License-Identifier: Apache-2.0
// The keys of the vessel and the stent.
#include "patency/config/schema_rows.h"

namespace patency::deck {

template <>
const Table& table_of<NozzleSection>() {
    static const Table table =
        make_table<NozzleSection>("A cross-section; the radius is linear between two.",
                                  {
                                      row(&NozzleSection::z, {.key = "z",
                                                              .help = "the distance along the axis from the start",
                                                              .unit = "mm",
                                                              .range = between(-largest_length, largest_length),
                                                              .need = always}),
                                      row(&NozzleSection::diameter, {.key = "diameter",
                                                                     .help = "the diameter there",
                                                                     .unit = "mm",
                                                                     .range = above_up_to(0, largest_length),
                                                                     .example = "4 mm",
                                                                     .need = always}),
                                  });
    return table;
}

template <>
const Table& table_of<Branch>() {
    static const Table table = make_table<Branch>(
        "A tapered tube with round ends; free ends are openings.",
        {
            row(&Branch::name,
                {.key = "name", .help = "the name of the branch", .example = "\"left\"", .need = always}),
            row(&Branch::from, {.key = "from", .help = "the axis' first point", .unit = "mm", .need = always}),
            row(&Branch::to, {.key = "to", .help = "the axis' last point", .unit = "mm", .need = always}),
            row(&Branch::diameters, {.key = "diameters",
                                     .help = "the diameters at the first and at the last point",
                                     .unit = "mm",
                                     .range = above_up_to(0, largest_length),
                                     .count = 2,
                                     .need = always}),
        });
    return table;
}

template <>
const Table& table_of<Shape>() {
    const Condition axial = where("type", {"tube", "cone", "nozzle"}), plates = where("type", {"channel", "step"});
    static const Table table = make_table<Shape>(
        "A shape by its measures, instead of a surface.",
        {
            row(&Shape::type, {.key = "type",
                               .help = "the kind of shape; planar are channel, flow along x between two plates, and "
                                       "step, whose lower plate drops once",
                               .need = always}),
            row(&Shape::gap, {.key = "gap",
                              .help = "the distance between the plates",
                              .unit = "mm",
                              .range = above_up_to(0, largest_length),
                              .only = plates,
                              .need = always}),
            row(&Shape::length, {.key = "length",
                                 .help = "the length along the axis",
                                 .unit = "mm",
                                 .range = above_up_to(0, largest_length),
                                 .example = "20 mm",
                                 .only = where("type", {"channel", "step", "tube", "cone"}),
                                 .need = always}),
            row(&Shape::step_height, {.key = "step_height",
                                      .help = "how much narrower the gap is ahead of the step",
                                      .unit = "mm",
                                      .range = above_up_to(0, largest_length),
                                      .example = "1 mm",
                                      .only = where("type", {"step"}),
                                      .need = always}),
            row(&Shape::step_at, {.key = "step_at",
                                  .help = "the distance from the inlet to the step",
                                  .unit = "mm",
                                  .range = above_up_to(0, largest_length),
                                  .example = "5 mm",
                                  .only = where("type", {"step"}),
                                  .need = always}),
            row(&Shape::size, {.key = "size",
                               .help = "the sides along x, y, z; z counts for nothing in a planar box",
                               .unit = "mm",
                               .range = between(0, largest_length),
                               .only = where("type", {"box"}),
                               .need = always}),
            row(&Shape::periodic, {.key = "periodic",
                                   .help = "in which directions the box repeats itself; walls elsewhere",
                                   .example = "[true, true, false]",
                                   .only = where("type", {"box"})}),
            row(&Shape::planar,
                {.key = "planar", .help = "a two-dimensional box in x and y", .only = where("type", {"box"})}),
            row(&Shape::diameter, {.key = "diameter",
                                   .help = "the diameter of the tube",
                                   .unit = "mm",
                                   .range = above_up_to(0, largest_length),
                                   .example = "3 mm",
                                   .only = where("type", {"tube"}),
                                   .need = always}),
            row(&Shape::diameters, {.key = "diameters",
                                    .help = "the diameters at the start and at the end",
                                    .unit = "mm",
                                    .range = above_up_to(0, largest_length),
                                    .count = 2,
                                    .only = where("type", {"cone"}),
                                    .need = always}),
            row(&Shape::sections, {.key = "sections",
                                   .help = "cross-sections along the axis",
                                   .example = R"([{z: "0 mm", diameter: "12 mm"}, {z: "20 mm", diameter: "4 mm"}])",
                                   .only = where("type", {"nozzle"}),
                                   .need = always}),
            row(&Shape::branches, {.key = "branches",
                                   .help = "tapered tubes whose union is the lumen",
                                   .only = where("type", {"branches"}),
                                   .need = always}),
            row(&Shape::axis, {.key = "axis",
                               .help = "the direction of the axis; its length counts for nothing",
                               .example = "[1, 0, 0]",
                               .only = axial}),
            row(&Shape::start, {.key = "start", .help = "the first point of the axis", .unit = "mm", .only = axial}),
        });
    return table;
}

template <>
const Table& table_of<Extensions>() {
    static const Table table =
        make_table<Extensions>("Straight pieces put on the openings of a surface.",
                               {
                                   row(&Extensions::diameters, {.key = "diameters",
                                                                .help = "their length, in diameters of each opening",
                                                                .range = between(0, 20),
                                                                .example = "2",
                                                                .need = always}),
                               });
    return table;
}

template <>
const Table& table_of<Lesion>() {
    static const Table table = make_table<Lesion>(
        "A narrowing of a branch, its profile a cosine.",
        {
            row(&Lesion::branch, {.key = "branch",
                                  .help = "the branch of the network that it lies in",
                                  .example = "\"left\"",
                                  .need = always}),
            row(&Lesion::position,
                {.key = "position",
                 .help = "how far its middle lies along the branch, from the branch's first point or its opening there",
                 .unit = "mm",
                 .range = between(0, largest_length),
                 .example = "15 mm",
                 .need = always}),
            row(&Lesion::length, {.key = "length",
                                  .help = "its length along the branch",
                                  .unit = "mm",
                                  .range = above_up_to(0, largest_length),
                                  .example = "10 mm",
                                  .need = always}),
            row(&Lesion::diameter_stenosis_percent,
                {.key = "diameter_stenosis_percent",
                 .help = "how much of the healthy diameter it takes at its middle, in percent",
                 .range = between(0, 95),
                 .example = "50",
                 .need = always}),
            row(&Lesion::eccentricity, {.key = "eccentricity",
                                        .help = "0: plaque all around; 1: on one side only, so that the lumen touches "
                                                "the healthy wall on the other",
                                        .range = between(0, 1),
                                        .example = "0.5"}),
            row(&Lesion::side, {.key = "side",
                                .help = "the direction from the axis to the plaque, if eccentric; chosen if absent",
                                .example = "[0, 1, 0]"}),
        });
    return table;
}

template <>
const Table& table_of<Geometry>() {
    static const Table table = make_table<Geometry>(
        "The lumen: a surface file, a network file or a shape.",
        {
            row(&Geometry::surface, {.key = "surface",
                                     .help = "a file with the surface of the lumen (STL, VTP)",
                                     .example = "\"lumen.stl\""}),
            row(&Geometry::network, {.key = "network",
                                     .help = "a file with centrelines and radii (JSON, VTP, VTK, SWC)",
                                     .example = "\"network.json\""}),
            row(&Geometry::shape, {.key = "shape", .help = "a shape by its measures"}),
            row(&Geometry::unit,
                {.key = "unit", .help = "the unit of the file's coordinates: m, cm, mm or um", .example = "mm"}),
            row(&Geometry::space,
                {.key = "space", .help = "the axes of the file's coordinates: LPS or RAS", .example = "LPS"}),
            row(&Geometry::label, {.key = "label",
                                   .help = "of a label map with several labels, which one is the vessel",
                                   .range = between(-1e9, 1e9),
                                   .example = "2"}),
            row(&Geometry::inlet,
                {.key = "inlet",
                 .help = "the opening of a surface that is the inlet, by its name or number; the largest if absent",
                 .example = "\"outlet_2\""}),
            row(&Geometry::names,
                {.key = "names",
                 .help =
                     "own names for the openings of a surface, by the names or numbers that patency inspect gives them",
                 .example = "{outlet_1: circumflex}"}),
            row(&Geometry::cut_back, {.key = "cut_back",
                                      .help = "how far before their ends, along the centreline, openings of a surface "
                                              "are cut square to it, by their names",
                                      .unit = "mm",
                                      .range = above_up_to(0, largest_length),
                                      .example = "{outlet_1: 2.7 mm}"}),
            row(&Geometry::branches, {.key = "branches",
                                      .help = "names for the branches of a surface, by a point within each",
                                      .unit = "mm",
                                      .range = between(-largest_length, largest_length),
                                      .example = "{circumflex: [12 mm, -3 mm, 40 mm]}"}),
            row(&Geometry::lesion, {.key = "lesion", .help = "a stenosis that narrows a branch of the network"}),
            row(&Geometry::extensions, {.key = "extensions", .help = "straight pieces put on the openings"}),
        },
        {{.keys = {"surface", "network", "shape"}}});
    return table;
}

template <>
const Table& table_of<StentPattern>() {
    const Range width = above_up_to(0, 1e-3), length = above_up_to(0, 0.2);
    const auto measure = [](std::string key, std::string help, const Range& range, std::string example) {
        return Row{.key = std::move(key),
                   .help = std::move(help),
                   .unit = "mm",
                   .range = range,
                   .example = std::move(example),
                   .need = always};
    };
    static const Table table = make_table<StentPattern>(
        "Struts cut from a tube; all diameters are outer ones.",
        {
            row(&StentPattern::layout,
                {.key = "layout", .help = "rings of crowns, or one wave of crowns wound as a helix"}),
            row(&StentPattern::rings, {.key = "rings",
                                       .help = "rings; turns of a helix",
                                       .range = between(1, 200),
                                       .example = "8",
                                       .need = always}),
            row(&StentPattern::crowns, {.key = "crowns",
                                        .help = "peaks per ring; a turn of a helix has half a peak more",
                                        .range = between(2, 60),
                                        .example = "6",
                                        .need = always}),
            row(&StentPattern::length, measure("length", "the length over all", length, "10 mm")),
            row(&StentPattern::diameter, measure("diameter", "the diameter as cut", length, "2 mm")),
            row(&StentPattern::crimped_diameter,
                measure("crimped_diameter", "the diameter on the balloon", length, "1.2 mm")),
            row(&StentPattern::nominal_diameter, measure("nominal_diameter", "the diameter opened", length, "3.3 mm")),
            row(&StentPattern::strut_width, measure("strut_width", "the width of struts", width, "0.1 mm")),
            row(&StentPattern::strut_thickness,
                measure("strut_thickness", "the thickness of the tube's wall", width, "0.1 mm")),
            row(&StentPattern::crown_radius,
                measure("crown_radius", "the radius of a crown's centreline", width, "0.15 mm")),
            row(&StentPattern::gap,
                measure("gap", "the free length between the tips of neighbouring rings", between(0, 0.01), "0.2 mm")),
            row(&StentPattern::connectors, {.key = "connectors",
                                            .help = "connectors per gap; as many as crowns make closed cells",
                                            .range = between(0, 60),
                                            .example = "3"}),
            row(&StentPattern::connector_shift, {.key = "connector_shift",
                                                 .help = "crowns from the connectors of one gap to the next's",
                                                 .range = between(-60, 60)}),
            row(&StentPattern::connector_shape, {.key = "connector_shape", .help = "straight, or S-shaped"}),
            row(&StentPattern::facing,
                {.key = "facing", .help = "crowns of neighbouring rings tip to tip, or tip to gap"}),
            row(&StentPattern::connector_width, {.key = "connector_width",
                                                 .help = "the width of connectors; the struts' if absent",
                                                 .unit = "mm",
                                                 .range = width,
                                                 .example = "0.1 mm"}),
            row(&StentPattern::connector_swing, {.key = "connector_swing",
                                                 .help = "how far a flex connector swings to both sides",
                                                 .unit = "mm",
                                                 .range = between(0, 1e-3)}),
            row(&StentPattern::edge_radius, {.key = "edge_radius",
                                             .help = "the rounding of the struts' edges",
                                             .unit = "um",
                                             .range = between(0, 1e-3)}),
        });
    return table;
}

template <>
const Table& table_of<StentPlacement>() {
    static const Table table = make_table<StentPlacement>(
        "Where the stent's middle lies.",
        {
            row(&StentPlacement::branch,
                {.key = "branch", .help = "the branch that is stented; the only one if absent", .example = "\"left\""}),
            row(&StentPlacement::arc_length, {.key = "arc_length",
                                              .help = "along the branch's centreline",
                                              .unit = "mm",
                                              .range = between(0, largest_length),
                                              .example = "12 mm"}),
            row(&StentPlacement::translation, {.key = "translation",
                                               .help = "the place instead",
                                               .unit = "mm",
                                               .range = between(-largest_length, largest_length)}),
            row(&StentPlacement::direction,
                {.key = "direction",
                 .help = "of the stent's axis, with translation; its length counts for nothing",
                 .example = "[1, 0, 0]"}),
            row(&StentPlacement::rotation, {.key = "rotation", .help = "around the axis", .unit = "deg"}),
        },
        {{.keys = {"arc_length", "translation"}}, {.keys = {"branch", "translation"}, .required = false}});
    return table;
}

template <>
const Table& table_of<Stent>() {
    static const Table table = make_table<Stent>(
        "The stent; `patency stent list` shows the designs.",
        {
            row(&Stent::design, {.key = "design", .help = "a design of the library", .example = "\"open_cell\""}),
            row(&Stent::length, {.key = "length",
                                 .help = "of a design: with as many rings as come nearest; as in the library if absent",
                                 .unit = "mm",
                                 .range = above_up_to(0, 0.2),
                                 .example = "15 mm"}),
            row(&Stent::pattern, {.key = "pattern", .help = "its own pattern instead"}),
            row(&Stent::surface,
                {.key = "surface", .help = "the closed surface of its metal instead", .example = "\"stent.stl\""}),
            row(&Stent::unit, {.key = "unit", .help = "the unit of the surface's coordinates", .example = "\"mm\""}),
            row(&Stent::alloy,
                {.key = "alloy",
                 .help = "what it is made of: L605, MP35N, 316L, PtCr or nitinol; the design's if absent",
                 .example = "\"L605\""}),
            row(&Stent::placement, {.key = "placement", .help = "where it is; around the worst lesion if absent"}),
            row(&Stent::spacing, {.key = "spacing",
                                  .help = "the distance between its particles; a quarter of a strut if absent",
                                  .unit = "um",
                                  .range = above_up_to(0, 1e-3),
                                  .example = "20 um"}),
            row(&Stent::material, {.key = "material", .help = "what it is made of as a solid; the alloy's if absent"}),
        },
        {{.keys = {"design", "pattern", "surface"}}});
    return table;
}

}   // namespace patency::deck
