// SPDX-License-Identifier: Apache-2.0
// What the reference paper (arXiv 2511.08745) prints, beside ours, as Markdown.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "patency/verify/figures.h"

namespace patency {

/// A row for every figure `paper_printed_X` of the reports, with `X` and `paper_X` (the paper's scheme, run here) where there are such.
std::string paper_figures_table(std::span<const CaseReport> reports);

/// The paper's table VI beside the summary.json of a run on its bifurcation with a stent: velocities, flows and the ratio of gauge
/// pressures, before -> after. What the run lacks is a dash.
std::string paper_table_six(const nlohmann::ordered_json& run);

}   // namespace patency
