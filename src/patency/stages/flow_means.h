// SPDX-License-Identifier: Apache-2.0
// Means of a flow over a window of time and the audit of its mass: the numbers of summary.json. Writes no files.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "patency/stages/scene.h"

namespace patency {

/// What the integrals of a scene stand at, at one moment.
struct FlowMark {
    double time = 0;                     ///< [s]
    std::vector<double> volume_out;      ///< per opening [m^3]
    std::vector<double> pressure_time;   ///< per opening [Pa s]
    double compressed = 0;     ///< volume at rest that the blood inside holds beyond its own, sum V p / (rho c^2) [m^3]
    std::int64_t inside = 0;   ///< particles between the openings' planes
};
FlowMark mark_flow(const Scene& scene);

/// From when means are taken: output.average_from, else the last period, else the last tenth of the run [s].
double window_start(const deck::Case& config);

/// Mean of one opening from one mark to a later one.
struct OpeningMean {
    double flow;       ///< out of the domain [m^3/s]
    double pressure;   ///< at the plane, as the deck counts it [Pa]
    double velocity;   ///< flow over area [m/s]
};
OpeningMean mean_between(const FlowMark& from, const FlowMark& to, std::size_t opening, double area);

/// What flowed out of all openings less what the blood inside was compressed less, over what flowed through [%]. The
/// lumen is rigid: its mass changes by compression only.
double mass_imbalance_percent(const FlowMark& from, const FlowMark& to);

/// The numbers of a flow's part of summary.json: a function of the scene and the mark only. Throws DivergedError where
/// a number is not finite.
nlohmann::ordered_json make_summary(const Scene& scene, const FlowMark& from);

/// Throws DivergedError naming the first number of a summary that is not finite.
void expect_finite(const nlohmann::ordered_json& json, const std::string& path);

/// The greatest and the mean speed of the blood inside [m/s], its kinetic energy [J], the mean pressure [Pa].
struct BulkValues {
    double largest_speed, mean_speed, kinetic_energy, mean_pressure;
};
BulkValues bulk_values(const Scene& scene);

}   // namespace patency
