// SPDX-License-Identifier: Apache-2.0
// Fewer triangles for the same shape, for pictures; not for computing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

struct Decimated {
    std::vector<std::uint32_t> kept;   ///< points that are left, by their old numbers
    std::vector<Triangle> triangles;   ///< of the points that are left, by their new numbers
};

/// About `most` triangles, flat places losing theirs first (Schroeder, Zarge and Lorensen, SIGGRAPH 1992, as VTK has it). No point
/// moves, so what is known at points stays known. A surface that has few enough only loses points without triangles.
Decimated decimate(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t most);

}   // namespace patency
