// SPDX-License-Identifier: Apache-2.0
// A vessel's haemodynamics from what was recorded along it: pressure pullbacks, what every lesion does, FFR, wall shear on the
// surface. Numbers and files for the user; computes no flow.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patency/io/output_folder.h"
#include "patency/stages/vessel_recorder.h"

namespace patency {

/// Fewer particles than this across a place do not resolve its flow: the value stands with a mark, and the estimate's beside it.
inline constexpr double fewest_across = 8;

/// Pressure and flow at a section, means over the recorded instants.
struct StationFlow {
    std::size_t station;   ///< in VesselRecorder::stations()
    SectionFlow flow, deviation;
    double across;               ///< particles over the largest inscribed sphere
    std::optional<double> ffr;   ///< none without an aortic pressure
};

/// What the flow does at a lesion.
struct LesionFlow {
    std::size_t number;   ///< in Assessment::lesions
    double flow;          ///< at its throat [m^3/s]
    double drop;          ///< from its start to where FFR is read [Pa]
    double read_arc;      ///< 15 mm behind its end along its line, or the line's last section [m]
    double across;        ///< particles over the narrowest sphere
    double velocity_before,
        velocity_behind;   ///< means over the sections a lesion's length before and behind its throat [m/s]
    std::optional<double>
        gauge_ratio;   ///< of pressures above the lowest outlet's, a lesion's length behind and before its throat
    std::optional<double> ffr;   ///< where it is read
};

struct VesselFlow {
    std::vector<StationFlow> stations;   ///< those with blood at every instant
    std::vector<LesionFlow> lesions;     ///< as Assessment::lesions, those that have stations on both sides
    double level = 0;                    ///< added to pressures for FFR: aortic less the inlet's [Pa]
    std::optional<double> worst_ffr;
};

/// `inlet_pressure` and `lowest_outlet`: means over the same time, as the deck counts pressures [Pa]. `out`: what flows out of the
/// openings, of a lumen that stores nothing: all sections of a branch then carry what leaves behind it, to the last digit, where a
/// measured flow errs by about a per cent (8.9). Empty: flows are measured.
VesselFlow evaluate_vessel(const Scene& scene, const VesselRecorder& recorder, double inlet_pressure,
                           double lowest_outlet, std::span<const double> out = {});

/// Branches, lesions, gauge_pressure_ratio and ffr of summary.json, in place of those that know no vessel.
void add_vessel_summary(nlohmann::ordered_json& summary, const Scene& scene, const VesselRecorder& recorder,
                        const VesselFlow& flow);

/// sections.csv: every station. pullback.csv: along the line to every outlet. wall.vtp: pressure and shear on the surface's
/// triangles. centerline.vtp: the lines with pressure, flow, velocities and FFR. cut.vtp: means on the surface that they sweep out.
/// streamlines.vtp: from the inlet through the last state. Throws FileError.
void write_vessel_files(const OutputFolder& folder, const Scene& scene, const VesselRecorder& recorder,
                        const VesselFlow& flow);

}   // namespace patency
