// SPDX-License-Identifier: Apache-2.0
// Pictures of verification cases as SVG text: curves against each other, and fields of particles in the plane. Small on
// purpose; the report of a patient's case is made elsewhere.
#pragma once

#include <string>
#include <vector>

namespace patency {

struct Picture {
    std::string name;   ///< of the file, without .svg
    std::string caption;
    std::string svg;
};

struct Curve {
    std::string label;   ///< none: one of those before it, in their colour
    std::vector<double> x, y;
    bool is_dotted = false;   ///< points instead of a line
};

struct Plot {
    std::string x_label, y_label;
    std::vector<Curve> curves;
};
/// Axes fit the data. @throws UsageError without any point.
std::string format_plot(const Plot& plot);

/// Particles at x, y [m] as squares of a side [m], coloured by a value from `low` to `high`.
struct FieldMap {
    std::vector<double> x, y, value;
    double side, low, high;
    std::string label;   ///< of the value, with its unit
};
std::string format_field(const FieldMap& map);

}   // namespace patency
