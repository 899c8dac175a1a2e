// SPDX-License-Identifier: Apache-2.0
// A stent that comes as a surface: where its axis is and what its measures are.
#pragma once

#include "patency/shape/surface.h"

namespace patency {

struct ImportedStent {
    Surface surface;          ///< in the stent's own frame: along x, its middle at the origin
    RigidMotion placement;    ///< from there to where it was in the file
    double diameter;          ///< outer [m]
    double length;            ///< [m]
    double strut_thickness;   ///< [m]: outer less inner radius, the means of the faces that look out and in
    double volume, area;      ///< [m^3], [m^2]
    double asymmetry;         ///< of the two moments of inertia across the axis: their difference over their sum
};

/// Finds the axis: that of the principal inertia about which the other two are alike. Throws GeometryError, with what is
/// wrong, for a surface that is not closed, has no such axis, or is no stent in size (0.5 to 50 mm wide).
ImportedStent recognise_stent(Surface surface);

}   // namespace patency
