// SPDX-License-Identifier: Apache-2.0
// Curves as SVG, along a vessel, over a beat or a sweep, for the page without a script and on paper. Colours are the style sheet's.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace patency {

struct PlotCurve {
    std::string label, style;   ///< style: a class of the style sheet: "before", "after", "estimate", one of a series
    std::vector<double> x, y;
};

/// The style sheet's class of one of several things of a kind; there are eight, then they begin again.
std::string series_style(std::size_t number);

struct Span {
    double from, to;
    std::string style;   ///< "lesion", "stent"
};

/// Axes fit the curves.
struct CurvePlot {
    std::string x_label, y_label;
    std::vector<PlotCurve> curves;
    std::vector<Span> spans;
    std::optional<double> least{};   ///< the axis reaches down to it, or farther
    std::vector<double> levels;      ///< horizontal lines, drawn where the axis has them
    std::string title{};             ///< for those who hear the page; empty: the y axis along the vessel
    bool has_points = false;         ///< a dot at every value; a curve of one then counts
};

/// Empty where no two values of x differ.
std::string draw_curves(const CurvePlot& plot);

}   // namespace patency
