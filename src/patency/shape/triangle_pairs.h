// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles of a surface that pass through each other. Triangles that only touch, or lie in one plane, do not.
#pragma once

#include <cstdint>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

struct TrianglePair {
    std::uint32_t a, b;   ///< indices of triangles, a < b
    Vec3 place;           ///< a point of both [m]
};

/// At most `limit` pairs, ordered by a, then b. The work is about n log n for a surface whose triangles keep apart.
std::vector<TrianglePair> find_crossing_triangles(const Surface& surface, std::size_t limit);

}   // namespace patency
