// SPDX-License-Identifier: Apache-2.0
// A picture of a vessel as SVG: its triangles shaded by their normals, its openings numbered, with their diameters; its
// centrelines and lesions.
#pragma once

#include <string>
#include <vector>

#include "patency/shape/surface_openings.h"

namespace patency {

/// What is drawn over the vessel, as if it were transparent.
struct DrawnLines {
    struct Mark {
        Vec3 place;         ///< [m]
        std::string text;   ///< "84 %"
    };
    std::vector<std::vector<Vec3>> lines{};   ///< centrelines [m]
    std::vector<Mark> marks{};                ///< lesions, numbered L1..
};

/// The picture as text, seen along the axis (x, y or z) from which the vessel is broadest.
std::string draw_surface(const Surface& surface, const std::vector<SurfaceOpening>& openings, const std::string& title,
                         const DrawnLines& drawn = {});

}   // namespace patency
