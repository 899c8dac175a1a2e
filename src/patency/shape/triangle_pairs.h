// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles of a surface that pass through each other, or lie on each other in one plane. Triangles that only touch do not.
#pragma once

#include <cstdint>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

struct TrianglePair {
    std::uint32_t a, b;   ///< indices of triangles, a < b
    Vec3 place;           ///< a point of both [m]; in one plane, between their centres
};

/// In one plane are triangles that are off each other's by no more than same_place_tolerance; they lie on each other if they would have to
/// be moved apart by more. Equal triangles are repair_duplicates's.
/// At most `limit` pairs, ordered by a, then b. The work is about n log n for a surface whose triangles keep apart.
std::vector<TrianglePair> find_crossing_triangles(const Surface& surface, std::size_t limit);

}   // namespace patency
