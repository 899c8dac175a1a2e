// SPDX-License-Identifier: Apache-2.0
// The repairs of a surface that cannot change the vessel's shape. Each mends what it can and returns what it found;
// nothing is mended in silence. What would be a guess (filling a hole) is not done here or anywhere.
#pragma once

#include <vector>

#include "patency/shape/surface_finding.h"

namespace patency {

/// Two places nearer than this are one: far below any spacing, far above the rounding of 32-bit files [m].
double same_place_tolerance(const Surface& surface);

/// Equal points become one (STL writes each point once per triangle).
std::vector<Finding> repair_equal_points(Surface& surface, double tolerance);

/// Triangles lower than the tolerance go. One whose three points lie on a line splits the triangle across its longest
/// side, so that no slit stays.
std::vector<Finding> repair_flat_triangles(Surface& surface, double tolerance);

/// Of equal triangles one stays; two back to back (a fold without thickness) both go.
std::vector<Finding> repair_duplicates(Surface& surface);

/// Pieces beside the largest that have less than 1 % of the area together go; larger ones are refused.
std::vector<Finding> repair_components(Surface& surface);

/// All triangles of a piece get the same side outward, the one that most of its area has; then outward is made out, judged
/// by the volume with the loops closed. A one-sided surface is refused.
std::vector<Finding> repair_orientation(Surface& surface);

}   // namespace patency
