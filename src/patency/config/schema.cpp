// SPDX-License-Identifier: Apache-2.0
// The keys of the case as a whole, of how it is computed and of what is written.
#include "patency/config/schema_rows.h"

namespace patency::deck {

template <>
const Table& table_of<About>() {
    static const Table table = make_table<About>(
        "What the case is.",
        {
            row(&About::name, {.key = "name", .help = "the name of the case, in reports", .example = "\"pipe\""}),
            row(&About::mode, {.key = "mode", .help = "whether the flow settles to a steady or a periodic state"}),
            row(&About::period, {.key = "period",
                                 .help = "the time of one heart beat",
                                 .unit = "s",
                                 .range = above_up_to(0, 1000),
                                 .example = "0.8 s",
                                 .need = where("mode", {"periodic"})}),
        });
    return table;
}

template <>
const Table& table_of<Convergence>() {
    static const Table table = make_table<Convergence>(
        "When a flow has settled.",
        {
            row(&Convergence::tolerance_percent,
                {.key = "tolerance_percent",
                 .help = "largest change of the openings' flows and pressures from window to window, twice in a row",
                 .range = above_up_to(0, 10)}),
            row(&Convergence::window,
                {.key = "window",
                 .help = "the length of a window; an eighth of a passage, or the period, if absent",
                 .unit = "s",
                 .range = above(0),
                 .example = "0.05 s"}),
        });
    return table;
}

template <>
const Table& table_of<Numerics>() {
    static const Table table = make_table<Numerics>(
        "How it is computed.",
        {
            row(&Numerics::scheme, {.key = "scheme",
                                    .help = "moving particles, ours or the reference paper's, or a flow on the cells "
                                            "of still ones; absent: cells for a steady or periodic flow between "
                                            "walls at rest in a surface or network, else sph"}),
            row(&Numerics::spacing, {.key = "spacing",
                                     .help = "the distance between particles",
                                     .unit = "mm",
                                     .range = above_up_to(0, 1),
                                     .example = "0.2 mm"}),
            row(&Numerics::across,
                {.key = "across",
                 .help = "of scheme cells: particles in the local diameter, instead of one spacing everywhere",
                 .range = between(4, 200),
                 .example = "12"}),
            row(&Numerics::smallest_spacing, {.key = "smallest_spacing",
                                              .help = "of scheme cells with `across`: no particles are nearer",
                                              .unit = "mm",
                                              .range = above_up_to(0, 1)}),
            row(&Numerics::largest_spacing, {.key = "largest_spacing",
                                             .help = "of scheme cells with `across`: no particles are farther apart",
                                             .unit = "mm",
                                             .range = above_up_to(0, 1)}),
            row(&Numerics::smoothing_ratio,
                {.key = "smoothing_ratio", .help = "smoothing length over spacing", .range = between(1, 2)}),
            row(&Numerics::sound_speed, {.key = "sound_speed",
                                         .help = "the artificial speed of sound; chosen if absent",
                                         .unit = "m/s",
                                         .range = above_up_to(0, 1e4),
                                         .example = "5 m/s"}),
            row(&Numerics::sound_speed_factor, {.key = "sound_speed_factor",
                                                .help = "speed of sound over reference speed, instead",
                                                .range = between(5, 1000),
                                                .example = "10"}),
            row(&Numerics::reference_speed, {.key = "reference_speed",
                                             .help = "the largest speed to expect; estimated if absent",
                                             .unit = "m/s",
                                             .range = above_up_to(0, largest_speed)}),
            row(&Numerics::precision, {.key = "precision", .help = "mixed: differences in single, sums in double"}),
            row(&Numerics::duration, {.key = "duration",
                                      .help = "the simulated time",
                                      .unit = "s",
                                      .range = above_up_to(0, 1e4),
                                      .example = "2 s",
                                      .need = always}),
            row(&Numerics::convergence,
                {.key = "convergence", .help = "ends the run when the flow has settled, the duration at the latest"}),
            row(&Numerics::without_rest, {.key = "without_rest",
                                          .help = "of scheme cells, a steady flow whose jet finds no rest by itself: "
                                                  "means, to look for the steady flow nevertheless and, if there "
                                                  "is none, give marked means over iterations; follow, to follow it in "
                                                  "time, which takes ten times as long, for means over time"}),
            row(&Numerics::steps_per_period, {.key = "steps_per_period",
                                              .help = "of scheme cells: steps in a period of a periodic flow",
                                              .range = between(20, 100000)}),
            row(&Numerics::advection_cfl,
                {.key = "advection_cfl", .help = "advection step over h / largest speed", .range = above_up_to(0, 1)}),
            row(&Numerics::acoustic_cfl, {.key = "acoustic_cfl",
                                          .help = "acoustic step over h / (sound speed + speed)",
                                          .range = above_up_to(0, 1)}),
            row(&Numerics::threads,
                {.key = "threads", .help = "threads; 0 is one per core", .range = between(0, 1024)}),
            row(&Numerics::pressure_reference,
                {.key = "pressure_reference", .help = "whether pressure is solved above a moving level"}),
            row(&Numerics::solid, {.key = "solid", .help = "how solids are computed"}),
            row(&Numerics::seed, {.key = "seed", .help = "of random numbers", .range = between(0, 2147483647)}),
        },
        {{.keys = {"spacing", "across"}, .required = true},
         {.keys = {"sound_speed", "sound_speed_factor"}, .required = false}});
    return table;
}

template <>
const Table& table_of<Probe>() {
    static const Table table = make_table<Probe>(
        "A point whose values are recorded over time.",
        {
            row(&Probe::name,
                {.key = "name", .help = "the name of the probe", .example = "\"throat\"", .need = always}),
            row(&Probe::point, {.key = "point", .help = "where it is", .unit = "mm", .need = always}),
        });
    return table;
}

template <>
const Table& table_of<LineProfile>() {
    static const Table table = make_table<LineProfile>(
        "A line along which values are written.",
        {
            row(&LineProfile::name,
                {.key = "name", .help = "the name of the profile", .example = "\"middle\"", .need = always}),
            row(&LineProfile::from, {.key = "from", .help = "the line's first point", .unit = "mm", .need = always}),
            row(&LineProfile::to, {.key = "to", .help = "the line's last point", .unit = "mm", .need = always}),
            row(&LineProfile::points, {.key = "points", .help = "points along the line", .range = between(2, 100000)}),
            row(&LineProfile::times,
                {.key = "times", .help = "when; at the end if absent", .unit = "s", .range = at_least(0)}),
        });
    return table;
}

template <>
const Table& table_of<Output>() {
    static const Table table = make_table<Output>(
        "What is written.",
        {
            row(&Output::interval, {.key = "interval",
                                    .help = "the time between frames; the last state only if absent",
                                    .unit = "s",
                                    .range = above(0),
                                    .example = "10 ms"}),
            row(&Output::fields,
                {.key = "fields", .help = "the fields in the frames", .example = "[velocity, pressure]"}),
            row(&Output::probes, {.key = "probes", .help = "points recorded over time"}),
            row(&Output::profiles, {.key = "profiles", .help = "lines written at given times"}),
            row(&Output::average_from, {.key = "average_from",
                                        .help = "means are taken from this time to the end",
                                        .unit = "s",
                                        .range = at_least(0)}),
            row(&Output::checkpoint_interval,
                {.key = "checkpoint_interval",
                 .help = "the simulated time between checkpoints; at the end only if absent",
                 .unit = "s",
                 .range = above(0)}),
        });
    return table;
}

template <>
const Table& table_of<Run>() {
    static const Table table = make_table<Run>(
        "A variant of the deck.",
        {
            row(&Run::name, {.key = "name", .help = "the name of the variant", .example = "\"fine\"", .need = always}),
            row(&Run::set, {.key = "set",
                            .help = "keys and their values in this variant",
                            .example = R"({numerics.spacing: "0.1 mm"})",
                            .need = always}),
        });
    return table;
}

template <>
const Table& table_of<Case>() {
    const Condition flow = without("solids");
    static const Table table = make_table<Case>(
        "A case.",
        {
            row(&Case::version, {.key = "version",
                                 .help = "the version of the deck's language",
                                 .range = between(1, 1),
                                 .example = "1",
                                 .need = always}),
            row(&Case::about, {.key = "case", .help = "what the case is"}),
            row(&Case::geometry, {.key = "geometry", .help = "the lumen", .only = flow, .need = flow}),
            row(&Case::blood, {.key = "blood", .help = "the blood's properties", .only = flow, .need = flow}),
            row(&Case::wall, {.key = "wall", .help = "the vessel wall", .only = flow}),
            row(&Case::body_force, {.key = "body_force",
                                    .help = "acceleration of blood or solids, such as gravity",
                                    .unit = "m/s^2",
                                    .range = between(-1e4, 1e4)}),
            row(&Case::openings,
                {.key = "openings", .help = "what happens at each opening, by its name", .only = flow}),
            row(&Case::aorta, {.key = "aorta", .help = "the aorta, the reference of FFR", .only = flow}),
            row(&Case::bed, {.key = "bed", .help = "the small vessels behind the outlets", .only = flow}),
            row(&Case::stent, {.key = "stent", .help = "the stent and where it is"}),
            row(&Case::deployment, {.key = "deployment", .help = "how the stent is implanted", .only = flow}),
            row(&Case::solids, {.key = "solids", .help = "solids by themselves, instead of a flow"}),
            row(&Case::contacts, {.key = "contacts", .help = "which solids touch"}),
            row(&Case::initial, {.key = "initial", .help = "the blood at the start", .only = flow}),
            row(&Case::numerics, {.key = "numerics", .help = "how it is computed", .need = always}),
            row(&Case::output, {.key = "output", .help = "what is written"}),
            row(&Case::runs, {.key = "runs", .help = "variants of the deck"}),
        });
    return table;
}

}   // namespace patency::deck
