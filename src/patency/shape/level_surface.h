// SPDX-License-Identifier: Apache-2.0
// Triangles on the zero level of any field: for shapes that a formula or an image gives.
#pragma once

#include <array>
#include <functional>

#include "patency/shape/surface.h"

namespace patency {

/// A number at every place, negative inside; pure, safe to call from several threads.
using LevelField = std::function<double(const Vec3&)>;

/// Where a field is looked at: cells[k] cells of size cell[k] along axis k, from origin on [m].
struct LevelGrid {
    Vec3 origin, cell;
    std::array<int, 3> cells;
};
/// Cubic cells around a box.
LevelGrid level_grid_around(const Bounds& box, double cell);

/// The zero level within the grid: one point in every cell that it crosses (two or more where it crosses twice), moved
/// onto the level; open where the grid ends. Details below a cell are lost, and holes below a cell in a thin gap.
/// may_cross: false for boxes that the level does not cross, which are passed over. Throws GeometryError for a surface that
/// is too large.
Surface make_level_surface(const LevelField& field, const LevelGrid& grid,
                           const std::function<bool(const Bounds&)>& may_cross);

/// Volume between a closed surface's triangles and the field's zero level near them [m^3], by Newton's distance at the
/// middles of the sides: what the triangles' flatness costs, to fourth order in their size.
double volume_beyond(const Surface& surface, const LevelField& field);

/// The slope of a field by central differences over +-step [m].
Vec3 gradient(const LevelField& field, const Vec3& x, double step);

}   // namespace patency
