// SPDX-License-Identifier: Apache-2.0
// The keys of the blood, the walls, the openings and what lies behind them.
#include "patency/config/schema_rows.h"

namespace patency::deck {

namespace {

constexpr double largest_viscosity = 1e3;   // Pa s

}   // namespace

template <>
const Table& table_of<Blood>() {
    const Range viscosities = above_up_to(0, largest_viscosity);
    static const Table table =
        make_table<Blood>("Blood: weakly compressible, Newtonian or shear-thinning.",
                          {
                              row(&Blood::density, {.key = "density",
                                                    .help = "the mass per volume",
                                                    .unit = "kg/m^3",
                                                    .range = between(500, 2000),
                                                    .need = always}),
                              row(&Blood::law, {.key = "law", .help = "how the viscosity depends on the shear rate"}),
                              row(&Blood::viscosity, {.key = "viscosity",
                                                      .help = "the dynamic viscosity",
                                                      .unit = "mPa s",
                                                      .range = viscosities,
                                                      .only = where("law", {"newtonian"}),
                                                      .need = always}),
                              row(&Blood::mu_0, {.key = "mu_0",
                                                 .help = "the viscosity at rest",
                                                 .unit = "mPa s",
                                                 .range = viscosities,
                                                 .example = "56 mPa s",
                                                 .only = where("law", {"carreau_yasuda"}),
                                                 .need = always}),
                              row(&Blood::mu_inf, {.key = "mu_inf",
                                                   .help = "the viscosity at infinite shear rate",
                                                   .unit = "mPa s",
                                                   .range = viscosities,
                                                   .example = "3.45 mPa s",
                                                   .only = where("law", {"carreau_yasuda"}),
                                                   .need = always}),
                              row(&Blood::lambda, {.key = "lambda",
                                                   .help = "the relaxation time",
                                                   .unit = "s",
                                                   .range = above_up_to(0, 1e4),
                                                   .example = "1.902 s",
                                                   .only = where("law", {"carreau_yasuda"}),
                                                   .need = always}),
                              row(&Blood::n, {.key = "n",
                                              .help = "the power index; 1 is Newtonian",
                                              .range = above_up_to(0, 2),
                                              .example = "0.22",
                                              .only = where("law", {"carreau_yasuda", "power_law"}),
                                              .need = always}),
                              row(&Blood::a, {.key = "a",
                                              .help = "Yasuda's exponent; 2 is Carreau's law",
                                              .range = above_up_to(0, 10),
                                              .example = "1.25",
                                              .only = where("law", {"carreau_yasuda"}),
                                              .need = always}),
                              row(&Blood::yield_stress, {.key = "yield_stress",
                                                         .help = "the stress below which nothing flows",
                                                         .unit = "Pa",
                                                         .range = between(0, 1e3),
                                                         .example = "0.005 Pa",
                                                         .only = where("law", {"casson"}),
                                                         .need = always}),
                              row(&Blood::plastic_viscosity, {.key = "plastic_viscosity",
                                                              .help = "Casson's viscosity at infinite shear rate",
                                                              .unit = "mPa s",
                                                              .range = viscosities,
                                                              .only = where("law", {"casson"}),
                                                              .need = always}),
                              row(&Blood::consistency, {.key = "consistency",
                                                        .help = "the stress at a shear rate of 1/s",
                                                        .unit = "Pa s^n",
                                                        .range = viscosities,
                                                        .only = where("law", {"power_law"}),
                                                        .need = always}),
                              row(&Blood::min_viscosity, {.key = "min_viscosity",
                                                          .help = "the viscosity is never below",
                                                          .unit = "mPa s",
                                                          .range = viscosities,
                                                          .example = "1 mPa s",
                                                          .only = where("law", {"power_law"}),
                                                          .need = always}),
                              row(&Blood::max_viscosity, {.key = "max_viscosity",
                                                          .help = "the viscosity is never above",
                                                          .unit = "mPa s",
                                                          .range = viscosities,
                                                          .example = "100 mPa s",
                                                          .only = where("law", {"power_law", "casson"}),
                                                          .need = always}),
                          });
    return table;
}

template <>
const Table& table_of<Fourier>() {
    static const Table table = make_table<Fourier>(
        "mean + sum of cosines[k] cos(2 pi (k+1) t/period) and sines alike.",
        {
            row(&Fourier::mean, {.key = "mean", .help = "the mean", .unit = std::string(signal_unit), .need = always}),
            row(&Fourier::period, {.key = "period",
                                   .help = "the period of the first harmonic",
                                   .unit = "s",
                                   .range = above_up_to(0, 1000),
                                   .example = "0.8 s",
                                   .need = always}),
            row(&Fourier::cosines, {.key = "cosines",
                                    .help = "amplitudes of the cosines, first harmonic first",
                                    .unit = std::string(signal_unit),
                                    .need = always}),
            row(&Fourier::sines, {.key = "sines",
                                  .help = "amplitudes of the sines, as many",
                                  .unit = std::string(signal_unit),
                                  .need = always}),
        });
    return table;
}

template <>
const Table& table_of<Waveform>() {
    static const Table table = make_table<Waveform>(
        "A velocity, flow or pressure over time, as the opening's type says.",
        {
            row(&Waveform::file, {.key = "file",
                                  .help = "a CSV file with a time column and a value column",
                                  .example = "\"inflow.csv\""}),
            row(&Waveform::times,
                {.key = "times", .help = "the times of the values, increasing", .unit = "s", .range = at_least(0)}),
            row(&Waveform::values,
                {.key = "values", .help = "the values; linear in between", .unit = std::string(signal_unit)}),
            row(&Waveform::fourier, {.key = "fourier", .help = "a sum of harmonics"}),
            row(&Waveform::period, {.key = "period",
                                    .help = "the time after which it repeats; else the case's",
                                    .unit = "s",
                                    .range = above_up_to(0, 1000),
                                    .example = "0.8 s"}),
        },
        {{.keys = {"file", "times", "fourier"}}});
    return table;
}

template <>
const Table& table_of<ProfileTable>() {
    static const Table table = make_table<ProfileTable>(
        "A velocity profile by numbers.",
        {
            row(&ProfileTable::radii, {.key = "radii",
                                       .help = "relative radii from 0 (axis) to 1 (wall), increasing",
                                       .range = between(0, 1),
                                       .example = "[0, 0.5, 1]",
                                       .need = always}),
            row(&ProfileTable::speeds, {.key = "speeds",
                                        .help = "velocities there, scaled to the opening's mean",
                                        .example = "[2, 1.5, 0]",
                                        .need = always}),
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
            row(&Opening::profile,
                {.key = "profile", .help = "how the velocity is spread over the opening", .only = inflow}),
            row(&Opening::profile_table, {.key = "profile_table",
                                          .help = "the profile by numbers",
                                          .only = where("profile", {"table"}),
                                          .need = always}),
            row(&Opening::velocity, {.key = "velocity",
                                     .help = "the mean velocity",
                                     .unit = "m/s",
                                     .range = between(-largest_speed, largest_speed),
                                     .only = where("type", {"velocity"})}),
            row(&Opening::peak_velocity, {.key = "peak_velocity",
                                          .help = "the largest velocity, instead of the mean",
                                          .unit = "m/s",
                                          .range = between(-largest_speed, largest_speed),
                                          .example = "0.2 m/s",
                                          .only = where("type", {"velocity"})}),
            row(&Opening::flow, {.key = "flow",
                                 .help = "the volume per time; m^2/s in planar cases",
                                 .unit = "mL/min",
                                 .only = where("type", {"flow"})}),
            row(&Opening::pressure, {.key = "pressure",
                                     .help = "the pressure; the aorta's if absent",
                                     .unit = "mmHg",
                                     .range = between(-1e6, 1e6),
                                     .only = where("type", {"pressure"})}),
            row(&Opening::waveform,
                {.key = "waveform", .help = "the mean velocity, flow or pressure over time", .only = prescribed}),
            row(&Opening::ramp, {.key = "ramp",
                                 .help = "the time over which the value rises from zero",
                                 .unit = "s",
                                 .range = between(0, 1000),
                                 .only = prescribed}),
            row(&Opening::resistance,
                {.key = "resistance",
                 .help = "pressure above the distal pressure over outflow; tuned to the bed if absent",
                 .unit = "Pa s/m^3",
                 .range = between(0, 1e15),
                 .only = where("type", {"resistance"})}),
            row(&Opening::proximal_resistance,
                {.key = "proximal_resistance",
                 .help = "the resistance before the compliance; tuned to the bed if no number is given",
                 .unit = "Pa s/m^3",
                 .range = between(0, 1e15),
                 .only = windkessel}),
            row(&Opening::distal_resistance, {.key = "distal_resistance",
                                              .help = "the resistance behind the compliance",
                                              .unit = "Pa s/m^3",
                                              .range = above_up_to(0, 1e15),
                                              .only = windkessel}),
            row(&Opening::compliance, {.key = "compliance",
                                       .help = "stored volume per pressure",
                                       .unit = "m^3/Pa",
                                       .range = above_up_to(0, 1e-3),
                                       .only = windkessel}),
            row(&Opening::microvascular_resistance,
                {.key = "microvascular_resistance",
                 .help = "the resistance between the arteries' compliance and the muscle's",
                 .unit = "Pa s/m^3",
                 .range = above_up_to(0, 1e15),
                 .only = where("type", {"coronary"})}),
            row(&Opening::myocardial_compliance, {.key = "myocardial_compliance",
                                                  .help = "the compliance of the vessels within the heart's muscle",
                                                  .unit = "m^3/Pa",
                                                  .range = above_up_to(0, 1e-3),
                                                  .only = where("type", {"coronary"})}),
            row(&Opening::myocardial_pressure,
                {.key = "myocardial_pressure",
                 .help = "the pressure of the heart's muscle on them over time; the left ventricle's if absent",
                 .only = where("type", {"coronary"}),
                 .signal = Dimension::pressure}),
            row(&Opening::distal_pressure, {.key = "distal_pressure",
                                            .help = "the pressure behind the resistance",
                                            .unit = "mmHg",
                                            .range = between(-1e6, 1e6),
                                            .example = "5 mmHg",
                                            .only = where("type", {"resistance", "rcr", "coronary"})}),
            row(&Opening::initial_pressure, {.key = "initial_pressure",
                                             .help = "the compliance's pressure at the start",
                                             .unit = "mmHg",
                                             .range = between(-1e6, 1e6),
                                             .example = "80 mmHg",
                                             .only = windkessel}),
        },
        {{.keys = {"velocity", "peak_velocity", "waveform"}, .only = where("type", {"velocity"})},
         {.keys = {"flow", "waveform"}, .only = where("type", {"flow"})},
         {.keys = {"pressure", "waveform"}, .required = false, .only = where("type", {"pressure"})}});
    return table;
}

template <>
const Table& table_of<Aorta>() {
    static const Table table = make_table<Aorta>(
        "The aorta, the reference of FFR.",
        {
            row(&Aorta::pressure,
                {.key = "pressure", .help = "the mean aortic pressure", .unit = "mmHg", .range = above_up_to(0, 1e5)}),
            row(&Aorta::pulse, {.key = "pulse",
                                .help = "the largest aortic pressure less the least, of a periodic flow",
                                .unit = "mmHg",
                                .range = above_up_to(0, 1e5),
                                .example = "40 mmHg"}),
        });
    return table;
}

template <>
const Table& table_of<Bed>() {
    static const Table table = make_table<Bed>(
        "The small vessels behind the outlets, to which outlets without numbers are tuned.",
        {
            row(&Bed::state, {.key = "state", .help = "how wide they are: what they take if no flow is given"}),
            row(&Bed::flow, {.key = "flow",
                             .help = "what all these outlets take together in a vessel without a lesion",
                             .unit = "mL/min",
                             .range = above_up_to(0, 1e-2),
                             .example = "250 mL/min"}),
            row(&Bed::murray_exponent, {.key = "murray_exponent",
                                        .help = "an outlet takes its diameter to this power",
                                        .range = between(0, 5),
                                        .example = "3"}),
            row(&Bed::venous_pressure, {.key = "venous_pressure",
                                        .help = "the pressure behind the bed",
                                        .unit = "mmHg",
                                        .range = between(-1e5, 1e5),
                                        .example = "5 mmHg"}),
        });
    return table;
}

template <>
const Table& table_of<Initial>() {
    static const Table table = make_table<Initial>(
        "The blood at the start.",
        {
            row(&Initial::velocity, {.key = "velocity",
                                     .help = "the velocity field; absent: that of a steady flow on cells if one is "
                                             "waited for in a vessel, else of the estimate, in shapes rest",
                                     .example = "estimate"}),
            row(&Initial::speed, {.key = "speed",
                                  .help = "the mean velocity; taylor_green: the amplitude",
                                  .unit = "m/s",
                                  .range = between(-largest_speed, largest_speed),
                                  .need = where("velocity", {"plug", "parabola", "taylor_green"})}),
            row(&Initial::pressure,
                {.key = "pressure",
                 .help = "zero, linear between the openings' pressures, that of the estimate or of the flow on cells",
                 .example = "estimate"}),
        });
    return table;
}

}   // namespace patency::deck
