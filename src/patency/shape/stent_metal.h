// SPDX-License-Identifier: Apache-2.0
// The metal of a stent: a tube from which the pattern is cut along radii, its edges slightly rounded, straight or bent
// along a line.
#pragma once

#include "patency/shape/signed_distance.h"
#include "patency/shape/stent_axis.h"
#include "patency/shape/strut_map.h"

namespace patency {

/// NEGATIVE in the metal; the gradient points out of it. The zero set is the metal's surface; the value is the length of
/// a straight way to it, the shortest to second order in (value / radius of the tube), and at least the shortest farther
/// away. Its curvature is that of the tube's faces, and 0 beside struts.
SignedDistance make_stent_metal(const StrutCurves& curves, const StentAxis& axis = {});

/// The thickness of metal at this depth inside the edge of a strut [m]: the wall's, less where edges are rounded.
double thickness_at(const StrutCurves& curves, double depth);

/// The outer radius [m].
inline double outer_radius(const StrutCurves& curves) { return curves.middle_radius + curves.thickness / 2; }

}   // namespace patency
