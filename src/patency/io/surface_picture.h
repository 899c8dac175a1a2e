// SPDX-License-Identifier: Apache-2.0
// A picture of a vessel as SVG: its triangles shaded by their normals, its openings numbered, with their diameters.
#pragma once

#include <string>
#include <vector>

#include "patency/shape/surface_openings.h"

namespace patency {

/// The picture as text, seen along the axis (x, y or z) from which the vessel is broadest.
std::string draw_surface(const Surface& surface, const std::vector<SurfaceOpening>& openings, const std::string& title);

}   // namespace patency
