// SPDX-License-Identifier: Apache-2.0
// Smaller triangles on the same surface, where they are needed to follow a deformation.
#pragma once

#include <functional>

#include "patency/shape/surface.h"

namespace patency {

/// Halves edges that are longer than longest(middle of the edge) [m] until there is none. Points of the surface stay where they are and
/// new ones lie on its edges, so that its shape does not change. Face ids are kept. `longest` may rise by half of the way at most: no
/// triangle has one long edge and two short ones. Throws GeometryError if there is no end after 20 rounds.
void refine_surface(Surface& surface, const std::function<double(const Vec3&)>& longest);

}   // namespace patency
