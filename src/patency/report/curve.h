// SPDX-License-Identifier: Apache-2.0
// Curves along a vessel as SVG, for the page without a script and on paper. Colours are the style sheet's.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace patency {

struct PullbackCurve {
    std::string label, style;   ///< style: a class of the style sheet: "before", "after", "estimate"
    std::vector<double> x, y;
};

struct Span {
    double from, to;
    std::string style;   ///< "lesion", "stent"
};

/// Axes fit the curves.
struct PullbackPlot {
    std::string x_label, y_label;
    std::vector<PullbackCurve> curves;
    std::vector<Span> spans;
    std::optional<double> least{};   ///< the axis reaches down to it, or farther
    std::vector<double> levels;      ///< horizontal lines, drawn where the axis has them
    std::string title{};             ///< for those who hear the page; empty: the y axis along the vessel
    bool has_points = false;         ///< a dot at every value; a curve of one then counts
};

/// Empty where no two values of x differ.
std::string draw_pullback(const PullbackPlot& plot);

}   // namespace patency
