// SPDX-License-Identifier: Apache-2.0
// A stent unrolled, as an SVG drawing: along the axis to the right, around upwards.
#pragma once

#include <string>
#include <vector>

#include "patency/shape/stent_chart.h"

namespace patency {

/// Struts in their width, the ends of the circumference dashed, the largest circle in a cell, a scale. `lines` stand
/// below the title.
std::string draw_stent(const StrutCurves& curves, const std::vector<StentCell>& cells, const std::string& title,
                       const std::vector<std::string>& lines);

/// The outer faces of a stent that came as a surface, in its own frame (stent_import.h), of this outer diameter [m].
std::string draw_stent(const Surface& surface, double diameter, const std::string& title,
                       const std::vector<std::string>& lines);

}   // namespace patency
