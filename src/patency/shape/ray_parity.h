// SPDX-License-Identifier: Apache-2.0
// On which side of a closed surface a place lies, by what a ray from it passes through: where triangles are crumpled into
// each other, normals do not know.
#pragma once

#include "patency/shape/triangle_tree.h"

namespace patency {

/// By the majority of three rays, each of which tells unless it grazes a side to round-off. The surface must be closed and
/// that of the tree.
bool is_enclosed(const Surface& surface, const TriangleTree& tree, const Vec3& x);

}   // namespace patency
