// SPDX-License-Identifier: Apache-2.0
// THE table: every key of the deck, once. To add a key: a member in case.h, a row here
// (docs/HOWTO-add-a-case-key.md); a rule between keys goes to checks.cpp.
#include "patency/config/table.h"

namespace patency::deck {

namespace {

Condition where(std::string key, std::vector<std::string> words_of_key) { return {std::move(key), std::move(words_of_key)}; }

constexpr double largest_length = 10;     // m; a vessel is millimetres, a bench model a metre
constexpr double largest_speed = 100;     // m/s
constexpr double largest_viscosity = 1e3; // Pa s

}  // namespace

template <>
const Table& table_of<About>() {
    static const Table table = make_table<About>("What the case is.", {
        row(&About::name, {.key = "name", .help = "the name of the case, in reports", .example = "\"pipe\""}),
        row(&About::mode, {.key = "mode", .help = "whether the flow settles to a steady or a periodic state"}),
        row(&About::period, {.key = "period", .help = "the time of one heart beat", .unit = "s",
                             .range = above_up_to(0, 1000), .example = "0.8 s", .need = where("mode", {"periodic"})}),
    });
    return table;
}

template <>
const Table& table_of<NozzleSection>() {
    static const Table table = make_table<NozzleSection>("A cross-section; the radius is linear between two.", {
        row(&NozzleSection::z, {.key = "z", .help = "the distance along the axis from the start", .unit = "mm",
                                .range = between(-largest_length, largest_length), .need = always}),
        row(&NozzleSection::diameter, {.key = "diameter", .help = "the diameter there", .unit = "mm",
                                       .range = above_up_to(0, largest_length), .example = "4 mm", .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Branch>() {
    static const Table table = make_table<Branch>("A tapered tube with round ends; free ends are openings.", {
        row(&Branch::name, {.key = "name", .help = "the name of the branch", .example = "\"left\"", .need = always}),
        row(&Branch::from, {.key = "from", .help = "the axis' first point", .unit = "mm", .need = always}),
        row(&Branch::to, {.key = "to", .help = "the axis' last point", .unit = "mm", .need = always}),
        row(&Branch::diameters, {.key = "diameters", .help = "the diameters at the first and at the last point",
                                 .unit = "mm", .range = above_up_to(0, largest_length), .count = 2, .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Shape>() {
    const Condition axial = where("type", {"tube", "cone", "nozzle"});
    static const Table table = make_table<Shape>("A shape by its measures, instead of a surface.", {
        row(&Shape::type, {.key = "type", .help = "the kind of shape; channel is planar: flow along x between two plates",
                           .need = always}),
        row(&Shape::gap, {.key = "gap", .help = "the distance between the plates", .unit = "mm",
                          .range = above_up_to(0, largest_length), .only = where("type", {"channel"}), .need = always}),
        row(&Shape::length, {.key = "length", .help = "the length along the axis", .unit = "mm",
                             .range = above_up_to(0, largest_length), .example = "20 mm",
                             .only = where("type", {"channel", "tube", "cone"}), .need = always}),
        row(&Shape::size, {.key = "size", .help = "the sides along x, y, z; z counts for nothing in a planar box",
                           .unit = "mm", .range = between(0, largest_length), .only = where("type", {"box"}),
                           .need = always}),
        row(&Shape::periodic, {.key = "periodic", .help = "in which directions the box repeats itself; walls elsewhere",
                               .example = "[true, true, false]", .only = where("type", {"box"})}),
        row(&Shape::planar, {.key = "planar", .help = "a two-dimensional box in x and y", .only = where("type", {"box"})}),
        row(&Shape::diameter, {.key = "diameter", .help = "the diameter of the tube", .unit = "mm",
                               .range = above_up_to(0, largest_length), .example = "3 mm",
                               .only = where("type", {"tube"}), .need = always}),
        row(&Shape::diameters, {.key = "diameters", .help = "the diameters at the start and at the end", .unit = "mm",
                                .range = above_up_to(0, largest_length), .count = 2, .only = where("type", {"cone"}),
                                .need = always}),
        row(&Shape::sections, {.key = "sections", .help = "cross-sections along the axis",
                               .example = R"([{z: "0 mm", diameter: "12 mm"}, {z: "20 mm", diameter: "4 mm"}])",
                               .only = where("type", {"nozzle"}), .need = always}),
        row(&Shape::branches, {.key = "branches", .help = "tapered tubes whose union is the lumen",
                               .only = where("type", {"branches"}), .need = always}),
        row(&Shape::axis, {.key = "axis", .help = "the direction of the axis; its length counts for nothing",
                           .example = "[1, 0, 0]", .only = axial}),
        row(&Shape::start, {.key = "start", .help = "the first point of the axis", .unit = "mm", .only = axial}),
    });
    return table;
}

template <>
const Table& table_of<Extensions>() {
    static const Table table = make_table<Extensions>("Straight pieces put on the openings of a surface.", {
        row(&Extensions::diameters, {.key = "diameters", .help = "their length, in diameters of each opening",
                                     .range = between(0, 20), .example = "2", .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Lesion>() {
    static const Table table = make_table<Lesion>("A narrowing of a branch, its profile a cosine.", {
        row(&Lesion::branch, {.key = "branch", .help = "the branch of the network that it lies in", .example = "\"left\"",
                              .need = always}),
        row(&Lesion::position, {.key = "position",
                                .help = "how far its middle lies along the branch, from the branch's first point or its opening there",
                                .unit = "mm", .range = between(0, largest_length), .example = "15 mm", .need = always}),
        row(&Lesion::length, {.key = "length", .help = "its length along the branch", .unit = "mm",
                              .range = above_up_to(0, largest_length), .example = "10 mm", .need = always}),
        row(&Lesion::diameter_stenosis_percent,
            {.key = "diameter_stenosis_percent", .help = "how much of the healthy diameter it takes at its middle, in percent",
             .range = between(0, 95), .example = "50", .need = always}),
        row(&Lesion::eccentricity,
            {.key = "eccentricity",
             .help = "0: plaque all around; 1: on one side only, so that the lumen touches the healthy wall on the other",
             .range = between(0, 1), .example = "0.5"}),
        row(&Lesion::side, {.key = "side", .help = "the direction from the axis to the plaque, if eccentric; chosen if absent",
                            .example = "[0, 1, 0]"}),
    });
    return table;
}

template <>
const Table& table_of<Geometry>() {
    static const Table table = make_table<Geometry>(
        "The lumen: a surface file, a network file or a shape.",
        {
            row(&Geometry::surface, {.key = "surface", .help = "a file with the surface of the lumen (STL, VTP)",
                                     .example = "\"lumen.stl\""}),
            row(&Geometry::network, {.key = "network", .help = "a file with centrelines and radii (JSON, VTP, VTK, SWC)",
                                     .example = "\"network.json\""}),
            row(&Geometry::shape, {.key = "shape", .help = "a shape by its measures"}),
            row(&Geometry::unit, {.key = "unit", .help = "the unit of the file's coordinates: m, cm, mm or um",
                                  .example = "mm"}),
            row(&Geometry::space, {.key = "space", .help = "the axes of the file's coordinates: LPS or RAS",
                                   .example = "LPS"}),
            row(&Geometry::inlet, {.key = "inlet", .help = "the opening of a surface that is the inlet, by its name or number; the largest if absent",
                                   .example = "\"outlet_2\""}),
            row(&Geometry::lesion, {.key = "lesion", .help = "a stenosis that narrows a branch of the network"}),
            row(&Geometry::extensions, {.key = "extensions", .help = "straight pieces put on the openings"}),
        },
        {{.keys = {"surface", "network", "shape"}}});
    return table;
}

template <>
const Table& table_of<Blood>() {
    const Range viscosities = above_up_to(0, largest_viscosity);
    static const Table table = make_table<Blood>("Blood: weakly compressible, Newtonian or shear-thinning.", {
        row(&Blood::density, {.key = "density", .help = "the mass per volume", .unit = "kg/m^3",
                              .range = between(500, 2000), .need = always}),
        row(&Blood::law, {.key = "law", .help = "how the viscosity depends on the shear rate"}),
        row(&Blood::viscosity, {.key = "viscosity", .help = "the dynamic viscosity", .unit = "mPa s",
                                .range = viscosities, .only = where("law", {"newtonian"}), .need = always}),
        row(&Blood::mu_0, {.key = "mu_0", .help = "the viscosity at rest", .unit = "mPa s", .range = viscosities,
                           .example = "56 mPa s", .only = where("law", {"carreau_yasuda"}), .need = always}),
        row(&Blood::mu_inf, {.key = "mu_inf", .help = "the viscosity at infinite shear rate", .unit = "mPa s",
                             .range = viscosities, .example = "3.45 mPa s", .only = where("law", {"carreau_yasuda"}),
                             .need = always}),
        row(&Blood::lambda, {.key = "lambda", .help = "the relaxation time", .unit = "s", .range = above_up_to(0, 1e4),
                             .example = "1.902 s", .only = where("law", {"carreau_yasuda"}), .need = always}),
        row(&Blood::n, {.key = "n", .help = "the power index; 1 is Newtonian", .range = above_up_to(0, 2),
                        .example = "0.22", .only = where("law", {"carreau_yasuda", "power_law"}), .need = always}),
        row(&Blood::a, {.key = "a", .help = "Yasuda's exponent; 2 is Carreau's law", .range = above_up_to(0, 10),
                        .example = "1.25", .only = where("law", {"carreau_yasuda"}), .need = always}),
        row(&Blood::yield_stress, {.key = "yield_stress", .help = "the stress below which nothing flows", .unit = "Pa",
                                   .range = between(0, 1e3), .example = "0.005 Pa", .only = where("law", {"casson"}),
                                   .need = always}),
        row(&Blood::plastic_viscosity, {.key = "plastic_viscosity", .help = "Casson's viscosity at infinite shear rate",
                                        .unit = "mPa s", .range = viscosities, .only = where("law", {"casson"}),
                                        .need = always}),
        row(&Blood::consistency, {.key = "consistency", .help = "the stress at a shear rate of 1/s", .unit = "Pa s^n",
                                  .range = viscosities, .only = where("law", {"power_law"}), .need = always}),
        row(&Blood::min_viscosity, {.key = "min_viscosity", .help = "the viscosity is never below", .unit = "mPa s",
                                    .range = viscosities, .example = "1 mPa s", .only = where("law", {"power_law"}),
                                    .need = always}),
        row(&Blood::max_viscosity, {.key = "max_viscosity", .help = "the viscosity is never above", .unit = "mPa s",
                                    .range = viscosities, .example = "100 mPa s",
                                    .only = where("law", {"power_law", "casson"}), .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Wall>() {
    static const Table table = make_table<Wall>("The vessel wall.", {
        row(&Wall::motion, {.key = "motion", .help = "rigid, loaded by the flow (one_way), or moving with it"}),
        row(&Wall::slip, {.key = "slip", .help = "whether blood sticks to the wall"}),
        row(&Wall::velocity, {.key = "velocity", .help = "velocities of walls that slide, by the wall's name or all",
                              .unit = "m/s", .range = between(-largest_speed, largest_speed)}),
        row(&Wall::thickness, {.key = "thickness", .help = "the thickness of the wall", .unit = "mm",
                               .range = above_up_to(0, largest_length), .example = "0.8 mm",
                               .need = where("motion", {"one_way", "deformable"})}),
        row(&Wall::law, {.key = "law", .help = "the material law of the wall", .example = "neo_hookean"}),
        row(&Wall::plaque, {.key = "plaque", .help = "the diseased part of the wall"}),
    });
    return table;
}

template <>
const Table& table_of<Fourier>() {
    static const Table table = make_table<Fourier>("mean + sum of cosines[k] cos(2 pi (k+1) t/period) and sines alike.", {
        row(&Fourier::mean, {.key = "mean", .help = "the mean", .unit = std::string(signal_unit), .need = always}),
        row(&Fourier::period, {.key = "period", .help = "the period of the first harmonic", .unit = "s",
                               .range = above_up_to(0, 1000), .example = "0.8 s", .need = always}),
        row(&Fourier::cosines, {.key = "cosines", .help = "amplitudes of the cosines, first harmonic first",
                                .unit = std::string(signal_unit), .need = always}),
        row(&Fourier::sines, {.key = "sines", .help = "amplitudes of the sines, as many",
                              .unit = std::string(signal_unit), .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Waveform>() {
    static const Table table = make_table<Waveform>(
        "A velocity, flow or pressure over time, as the opening's type says.",
        {
            row(&Waveform::file, {.key = "file", .help = "a CSV file with a time column and a value column",
                                  .example = "\"inflow.csv\""}),
            row(&Waveform::times, {.key = "times", .help = "the times of the values, increasing", .unit = "s",
                                   .range = at_least(0)}),
            row(&Waveform::values, {.key = "values", .help = "the values; linear in between",
                                    .unit = std::string(signal_unit)}),
            row(&Waveform::fourier, {.key = "fourier", .help = "a sum of harmonics"}),
            row(&Waveform::period, {.key = "period", .help = "the time after which it repeats; else the case's", .unit = "s",
                                    .range = above_up_to(0, 1000), .example = "0.8 s"}),
        },
        {{.keys = {"file", "times", "fourier"}}});
    return table;
}

template <>
const Table& table_of<ProfileTable>() {
    static const Table table = make_table<ProfileTable>("A velocity profile by numbers.", {
        row(&ProfileTable::radii, {.key = "radii", .help = "relative radii from 0 (axis) to 1 (wall), increasing",
                                   .range = between(0, 1), .example = "[0, 0.5, 1]", .need = always}),
        row(&ProfileTable::speeds, {.key = "speeds", .help = "velocities there, scaled to the opening's mean",
                                    .example = "[2, 1.5, 0]", .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Opening>() {
    const Condition inflow = where("type", {"velocity", "flow"});
    const Condition prescribed = where("type", {"velocity", "flow", "pressure"});
    const Condition windkessel = where("type", {"rcr", "coronary"});
    static const Table table = make_table<Opening>(
        "What happens at an opening; flows and velocities are positive into the domain.",
        {
            row(&Opening::type, {.key = "type", .help = "what is prescribed there", .need = always}),
            row(&Opening::profile, {.key = "profile", .help = "how the velocity is spread over the opening", .only = inflow}),
            row(&Opening::profile_table, {.key = "profile_table", .help = "the profile by numbers",
                                          .only = where("profile", {"table"}), .need = always}),
            row(&Opening::velocity, {.key = "velocity", .help = "the mean velocity", .unit = "m/s",
                                     .range = between(-largest_speed, largest_speed), .only = where("type", {"velocity"})}),
            row(&Opening::peak_velocity, {.key = "peak_velocity", .help = "the largest velocity, instead of the mean",
                                          .unit = "m/s", .range = between(-largest_speed, largest_speed),
                                          .example = "0.2 m/s", .only = where("type", {"velocity"})}),
            row(&Opening::flow, {.key = "flow", .help = "the volume per time; m^2/s in planar cases", .unit = "mL/min",
                                 .only = where("type", {"flow"})}),
            row(&Opening::pressure, {.key = "pressure", .help = "the pressure", .unit = "mmHg",
                                     .range = between(-1e6, 1e6), .only = where("type", {"pressure"})}),
            row(&Opening::waveform, {.key = "waveform", .help = "the mean velocity, flow or pressure over time",
                                     .only = prescribed}),
            row(&Opening::ramp, {.key = "ramp", .help = "the time over which the value rises from zero", .unit = "s",
                                 .range = between(0, 1000), .only = prescribed}),
            row(&Opening::resistance, {.key = "resistance", .help = "pressure above the distal pressure over outflow; tuned to the bed if absent",
                                       .unit = "Pa s/m^3", .range = between(0, 1e15),
                                       .only = where("type", {"resistance"})}),
            row(&Opening::proximal_resistance, {.key = "proximal_resistance", .help = "the resistance before the compliance",
                                                .unit = "Pa s/m^3", .range = between(0, 1e15), .only = windkessel,
                                                .need = always}),
            row(&Opening::distal_resistance, {.key = "distal_resistance", .help = "the resistance behind the compliance",
                                              .unit = "Pa s/m^3", .range = above_up_to(0, 1e15), .only = windkessel,
                                              .need = always}),
            row(&Opening::compliance, {.key = "compliance", .help = "stored volume per pressure", .unit = "m^3/Pa",
                                       .range = above_up_to(0, 1e-3), .only = windkessel, .need = always}),
            row(&Opening::microvascular_resistance, {.key = "microvascular_resistance",
                                                     .help = "the resistance between the arteries' compliance and the muscle's",
                                                     .unit = "Pa s/m^3", .range = above_up_to(0, 1e15),
                                                     .only = where("type", {"coronary"}), .need = always}),
            row(&Opening::myocardial_compliance, {.key = "myocardial_compliance",
                                                  .help = "the compliance of the vessels within the heart's muscle", .unit = "m^3/Pa",
                                                  .range = above_up_to(0, 1e-3), .only = where("type", {"coronary"}), .need = always}),
            row(&Opening::myocardial_pressure, {.key = "myocardial_pressure", .help = "the pressure of the heart's muscle on them over time",
                                                .only = where("type", {"coronary"}), .need = always, .signal = Dimension::pressure}),
            row(&Opening::distal_pressure, {.key = "distal_pressure", .help = "the pressure behind the resistance",
                                            .unit = "mmHg", .range = between(-1e6, 1e6), .example = "5 mmHg",
                                            .only = where("type", {"resistance", "rcr", "coronary"})}),
            row(&Opening::initial_pressure, {.key = "initial_pressure", .help = "the compliance's pressure at the start",
                                             .unit = "mmHg", .range = between(-1e6, 1e6), .example = "80 mmHg",
                                             .only = windkessel}),
        },
        {{.keys = {"velocity", "peak_velocity", "waveform"}, .only = where("type", {"velocity"})},
         {.keys = {"flow", "waveform"}, .only = where("type", {"flow"})},
         {.keys = {"pressure", "waveform"}, .only = where("type", {"pressure"})}});
    return table;
}

template <>
const Table& table_of<Aorta>() {
    static const Table table = make_table<Aorta>("The aorta, the reference of FFR.", {
        row(&Aorta::pressure, {.key = "pressure", .help = "the mean aortic pressure", .unit = "mmHg",
                               .range = above_up_to(0, 1e5)}),
    });
    return table;
}

template <>
const Table& table_of<Bed>() {
    static const Table table = make_table<Bed>("The small vessels behind the outlets, to which resistances without a value are tuned.", {
        row(&Bed::state, {.key = "state", .help = "how wide they are: what they take if no flow is given"}),
        row(&Bed::flow, {.key = "flow", .help = "what all these outlets take together in a vessel without a lesion", .unit = "mL/min",
                         .range = above_up_to(0, 1e-2), .example = "250 mL/min"}),
        row(&Bed::murray_exponent, {.key = "murray_exponent", .help = "an outlet takes its diameter to this power",
                                    .range = between(0, 5), .example = "3"}),
        row(&Bed::venous_pressure, {.key = "venous_pressure", .help = "the pressure behind the bed", .unit = "mmHg",
                                    .range = between(-1e5, 1e5), .example = "5 mmHg"}),
    });
    return table;
}

template <>
const Table& table_of<StentPattern>() {
    const Range width = above_up_to(0, 1e-3), length = above_up_to(0, 0.2);
    const auto measure = [](std::string key, std::string help, const Range& range, std::string example) {
        return Row{.key = std::move(key), .help = std::move(help), .unit = "mm", .range = range, .example = std::move(example), .need = always};
    };
    static const Table table = make_table<StentPattern>("Struts cut from a tube; all diameters are outer ones.", {
        row(&StentPattern::layout, {.key = "layout", .help = "rings of crowns, or one wave of crowns wound as a helix"}),
        row(&StentPattern::rings, {.key = "rings", .help = "rings; turns of a helix", .range = between(1, 200), .example = "8", .need = always}),
        row(&StentPattern::crowns, {.key = "crowns", .help = "peaks per ring; a turn of a helix has half a peak more",
                                    .range = between(2, 60), .example = "6", .need = always}),
        row(&StentPattern::length, measure("length", "the length over all", length, "10 mm")),
        row(&StentPattern::diameter, measure("diameter", "the diameter as cut", length, "2 mm")),
        row(&StentPattern::crimped_diameter, measure("crimped_diameter", "the diameter on the balloon", length, "1.2 mm")),
        row(&StentPattern::nominal_diameter, measure("nominal_diameter", "the diameter opened", length, "3.3 mm")),
        row(&StentPattern::strut_width, measure("strut_width", "the width of struts", width, "0.1 mm")),
        row(&StentPattern::strut_thickness, measure("strut_thickness", "the thickness of the tube's wall", width, "0.1 mm")),
        row(&StentPattern::crown_radius, measure("crown_radius", "the radius of a crown's centreline", width, "0.15 mm")),
        row(&StentPattern::gap, measure("gap", "the free length between the tips of neighbouring rings", between(0, 0.01), "0.2 mm")),
        row(&StentPattern::connectors, {.key = "connectors", .help = "connectors per gap; as many as crowns make closed cells",
                                        .range = between(0, 60), .example = "3"}),
        row(&StentPattern::connector_shift, {.key = "connector_shift", .help = "crowns from the connectors of one gap to the next's",
                                             .range = between(-60, 60)}),
        row(&StentPattern::connector_shape, {.key = "connector_shape", .help = "straight, or S-shaped"}),
        row(&StentPattern::facing, {.key = "facing", .help = "crowns of neighbouring rings tip to tip, or tip to gap"}),
        row(&StentPattern::connector_width, {.key = "connector_width", .help = "the width of connectors; the struts' if absent", .unit = "mm",
                                             .range = width, .example = "0.1 mm"}),
        row(&StentPattern::connector_swing, {.key = "connector_swing", .help = "how far a flex connector swings to both sides", .unit = "mm",
                                             .range = between(0, 1e-3)}),
        row(&StentPattern::edge_radius, {.key = "edge_radius", .help = "the rounding of the struts' edges", .unit = "um",
                                         .range = between(0, 1e-3)}),
    });
    return table;
}

template <>
const Table& table_of<StentPlacement>() {
    static const Table table = make_table<StentPlacement>(
        "Where the stent's middle lies.",
        {
            row(&StentPlacement::branch, {.key = "branch", .help = "the branch that is stented; the only one if absent", .example = "\"left\""}),
            row(&StentPlacement::arc_length, {.key = "arc_length", .help = "along the branch's centreline", .unit = "mm",
                                              .range = between(0, largest_length), .example = "12 mm"}),
            row(&StentPlacement::translation, {.key = "translation", .help = "the place instead", .unit = "mm",
                                               .range = between(-largest_length, largest_length)}),
            row(&StentPlacement::direction, {.key = "direction", .help = "of the stent's axis, with translation; its length counts for nothing",
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
            row(&Stent::pattern, {.key = "pattern", .help = "its own pattern instead"}),
            row(&Stent::surface, {.key = "surface", .help = "the closed surface of its metal instead", .example = "\"stent.stl\""}),
            row(&Stent::unit, {.key = "unit", .help = "the unit of the surface's coordinates", .example = "\"mm\""}),
            row(&Stent::alloy, {.key = "alloy", .help = "what it is made of: L605, MP35N, 316L, PtCr or nitinol; the design's if absent",
                                .example = "\"L605\""}),
            row(&Stent::placement, {.key = "placement", .help = "where it is"}),
            row(&Stent::spacing, {.key = "spacing", .help = "the distance between its particles; a quarter of a strut if absent", .unit = "um",
                                  .range = above_up_to(0, 1e-3), .example = "20 um"}),
        },
        {{.keys = {"design", "pattern", "surface"}}});
    return table;
}

template <>
const Table& table_of<Initial>() {
    static const Table table = make_table<Initial>("The blood at the start.", {
        row(&Initial::velocity, {.key = "velocity", .help = "the velocity field; that of the estimate if absent, of shapes rest", .example = "estimate"}),
        row(&Initial::speed, {.key = "speed", .help = "the mean velocity; taylor_green: the amplitude", .unit = "m/s",
                              .range = between(-largest_speed, largest_speed),
                              .need = where("velocity", {"plug", "parabola", "taylor_green"})}),
        row(&Initial::pressure, {.key = "pressure", .help = "zero, linear between the openings' pressures, or that of the estimate", .example = "estimate"}),
    });
    return table;
}

template <>
const Table& table_of<Convergence>() {
    static const Table table = make_table<Convergence>("When a flow has settled.", {
        row(&Convergence::tolerance_percent, {.key = "tolerance_percent",
                                              .help = "largest change of the openings' flows and pressures from window to window, twice in a row",
                                              .range = above_up_to(0, 10)}),
        row(&Convergence::window, {.key = "window", .help = "the length of a window; an eighth of a passage, or the period, if absent",
                                   .unit = "s", .range = above(0), .example = "0.05 s"}),
    });
    return table;
}

template <>
const Table& table_of<Numerics>() {
    static const Table table = make_table<Numerics>(
        "How it is computed.",
        {
            row(&Numerics::scheme, {.key = "scheme", .help = "moving particles, ours or the reference paper's, or a steady flow on the cells of still ones"}),
            row(&Numerics::spacing, {.key = "spacing", .help = "the distance between particles", .unit = "mm",
                                     .range = above_up_to(0, 1), .example = "0.2 mm", .need = always}),
            row(&Numerics::smoothing_ratio, {.key = "smoothing_ratio", .help = "smoothing length over spacing",
                                             .range = between(1, 2)}),
            row(&Numerics::sound_speed, {.key = "sound_speed", .help = "the artificial speed of sound; chosen if absent",
                                         .unit = "m/s", .range = above_up_to(0, 1e4), .example = "5 m/s"}),
            row(&Numerics::sound_speed_factor, {.key = "sound_speed_factor",
                                                .help = "speed of sound over reference speed, instead",
                                                .range = between(5, 1000), .example = "10"}),
            row(&Numerics::reference_speed, {.key = "reference_speed", .help = "the largest speed to expect; estimated if absent",
                                             .unit = "m/s", .range = above_up_to(0, largest_speed)}),
            row(&Numerics::precision, {.key = "precision", .help = "mixed: differences in single, sums in double"}),
            row(&Numerics::duration, {.key = "duration", .help = "the simulated time", .unit = "s",
                                      .range = above_up_to(0, 1e4), .example = "2 s", .need = always}),
            row(&Numerics::convergence, {.key = "convergence", .help = "ends the run when the flow has settled, the duration at the latest"}),
            row(&Numerics::advection_cfl, {.key = "advection_cfl", .help = "advection step over h / largest speed",
                                           .range = above_up_to(0, 1)}),
            row(&Numerics::acoustic_cfl, {.key = "acoustic_cfl", .help = "acoustic step over h / (sound speed + speed)",
                                          .range = above_up_to(0, 1)}),
            row(&Numerics::threads, {.key = "threads", .help = "threads; 0 is one per core", .range = between(0, 1024)}),
            row(&Numerics::pressure_reference, {.key = "pressure_reference",
                                                .help = "whether pressure is solved above a moving level"}),
            row(&Numerics::seed, {.key = "seed", .help = "of random numbers", .range = between(0, 2147483647)}),
        },
        {{.keys = {"sound_speed", "sound_speed_factor"}, .required = false}});
    return table;
}

template <>
const Table& table_of<Probe>() {
    static const Table table = make_table<Probe>("A point whose values are recorded over time.", {
        row(&Probe::name, {.key = "name", .help = "the name of the probe", .example = "\"throat\"", .need = always}),
        row(&Probe::point, {.key = "point", .help = "where it is", .unit = "mm", .need = always}),
    });
    return table;
}

template <>
const Table& table_of<LineProfile>() {
    static const Table table = make_table<LineProfile>("A line along which values are written.", {
        row(&LineProfile::name, {.key = "name", .help = "the name of the profile", .example = "\"middle\"", .need = always}),
        row(&LineProfile::from, {.key = "from", .help = "the line's first point", .unit = "mm", .need = always}),
        row(&LineProfile::to, {.key = "to", .help = "the line's last point", .unit = "mm", .need = always}),
        row(&LineProfile::points, {.key = "points", .help = "points along the line", .range = between(2, 100000)}),
        row(&LineProfile::times, {.key = "times", .help = "when; at the end if absent", .unit = "s", .range = at_least(0)}),
    });
    return table;
}

template <>
const Table& table_of<Output>() {
    static const Table table = make_table<Output>("What is written.", {
        row(&Output::interval, {.key = "interval", .help = "the time between frames; the last state only if absent",
                                .unit = "s", .range = above(0), .example = "10 ms"}),
        row(&Output::fields, {.key = "fields", .help = "the fields in the frames", .example = "[velocity, pressure]"}),
        row(&Output::probes, {.key = "probes", .help = "points recorded over time"}),
        row(&Output::profiles, {.key = "profiles", .help = "lines written at given times"}),
        row(&Output::average_from, {.key = "average_from", .help = "means are taken from this time to the end",
                                    .unit = "s", .range = at_least(0)}),
        row(&Output::checkpoint_interval, {.key = "checkpoint_interval",
                                           .help = "the simulated time between checkpoints; at the end only if absent",
                                           .unit = "s", .range = above(0)}),
    });
    return table;
}

template <>
const Table& table_of<Run>() {
    static const Table table = make_table<Run>("A variant of the deck.", {
        row(&Run::name, {.key = "name", .help = "the name of the variant", .example = "\"fine\"", .need = always}),
        row(&Run::set, {.key = "set", .help = "keys and their values in this variant",
                        .example = R"({numerics.spacing: "0.1 mm"})", .need = always}),
    });
    return table;
}

template <>
const Table& table_of<Case>() {
    static const Table table = make_table<Case>("A case.", {
        row(&Case::version, {.key = "version", .help = "the version of the deck's language", .range = between(1, 1),
                             .example = "1", .need = always}),
        row(&Case::about, {.key = "case", .help = "what the case is"}),
        row(&Case::geometry, {.key = "geometry", .help = "the lumen", .need = always}),
        row(&Case::blood, {.key = "blood", .help = "the blood's properties", .need = always}),
        row(&Case::wall, {.key = "wall", .help = "the vessel wall"}),
        row(&Case::body_force, {.key = "body_force", .help = "acceleration of the blood, such as gravity",
                                .unit = "m/s^2", .range = between(-1e4, 1e4)}),
        row(&Case::openings, {.key = "openings", .help = "what happens at each opening, by its name"}),
        row(&Case::aorta, {.key = "aorta", .help = "the aorta, the reference of FFR"}),
        row(&Case::bed, {.key = "bed", .help = "the small vessels behind the outlets"}),
        row(&Case::stent, {.key = "stent", .help = "the stent and where it is"}),
        row(&Case::initial, {.key = "initial", .help = "the blood at the start"}),
        row(&Case::numerics, {.key = "numerics", .help = "how it is computed", .need = always}),
        row(&Case::output, {.key = "output", .help = "what is written"}),
        row(&Case::runs, {.key = "runs", .help = "variants of the deck"}),
    });
    return table;
}

}  // namespace patency::deck
