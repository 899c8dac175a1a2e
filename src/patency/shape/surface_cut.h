// SPDX-License-Identifier: Apache-2.0
// Flat cuts through a surface of triangles: the ends of vessels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

/// A plane that ends a vessel: it acts up to `reach` from the axis through point along normal (out of the vessel), and
/// as far as `length` past the plane [m].
struct FlatCut {
    Vec3 point, normal;
    double reach = Bounds::infinity, length = Bounds::infinity;
    std::vector<char> points{};   ///< per point of the surface, whether the cut sees it; it sees all if empty
};

/// Takes away what lies past the plane. Points nearer to it than `snap` [m] move onto it, so that no slivers arise. The
/// new rim stays open, or is closed by flat triangles with the face id given (the surface's other triangles get 1 if it
/// had no ids). Returns how many closed lines the rim has.
std::size_t cut_flat(Surface& surface, const FlatCut& cut, double snap, std::optional<std::int32_t> cap_id = {});

}   // namespace patency
