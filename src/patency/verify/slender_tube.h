// SPDX-License-Identifier: Apache-2.0
// Steady flow through a round tube whose radius changes slowly, with inertia: the reference of the tapered pipe. Numbers in,
// numbers out.                                                                                     THEORY (12.10), (12.11)
#pragma once

#include <functional>

namespace patency {

struct SlenderTube {
    std::function<double(double)> radius;   ///< of the place along the axis [m]
    double length;                          ///< [m]
    double flow;                            ///< [m^3/s]
    double density, viscosity;              ///< [kg/m^3], [Pa s]
};

/// How fine it is computed: rings of equal area, and steps along the tube; the error falls with the square of both.
struct SlenderGrid {
    int rings = 200, steps = 400;
};

/// The pressure [Pa] that is lost from `from` to `to` [m along the axis], of a flow that enters at 0 as a parabola. What it leaves
/// out is of the order of the squared slope of the wall: a third of it of the loss of a creeping flow in a cone.
/// Throws DivergedError for a flow that runs backwards somewhere: the equations cannot be marched then.
double slender_tube_pressure_drop(const SlenderTube& tube, double from, double to, const SlenderGrid& grid = {});

}   // namespace patency
