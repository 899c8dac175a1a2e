// SPDX-License-Identifier: Apache-2.0
// A treated vessel has no lesion any more; what its flow does where the lesions were.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "patency/io/csv.h"

namespace patency {

/// The outlet (from 1) whose line in a pullback runs through a lesion of that flow's part of summary.json: of the lines that reach its
/// throat, the one with the lesion's flow. 1 if there is none.
double outlet_through(const CsvTable& pullback, const nlohmann::ordered_json& lesion);

/// Where a lesion of a flow's part of summary.json begins [mm].
double start_arc_mm(const nlohmann::ordered_json& lesion);

/// The number that an outlet of one flow has in another: openings are numbered by their areas, which a cut may have changed.
double outlet_of_other(const nlohmann::ordered_json& flow, const nlohmann::ordered_json& other, double outlet);

/// For each of `before`'s lesions, `after`'s flow at the same arcs of the same line: branch, arcs, flow, drop, velocities, ratio of gauge
/// pressures and FFR under the keys that lesions have, for summary.json (after.at_lesions). Arguments: parts of summary.json and their
/// pullback.csv. The drop begins where the lesion did.
nlohmann::ordered_json at_lesions_of(const nlohmann::ordered_json& before, const CsvTable& pullback_before,
                                     const nlohmann::ordered_json& after, const CsvTable& pullback_after);

/// Puts these places into `after` (after.at_lesions). If it has no lesion of its own any more, its ratio of gauge pressures and the
/// worst FFR are those there, and ffr.read_at says so.
void add_at_lesions(nlohmann::ordered_json& after, const nlohmann::ordered_json& places);

}   // namespace patency
