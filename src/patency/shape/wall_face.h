// SPDX-License-Identifier: Apache-2.0
// The faces of a vessel's wall as triangles of even size, open where the wall is cut.
#pragma once

#include "patency/shape/surface.h"
#include "patency/shape/wall_field.h"

namespace patency {

enum class WallFace { lumen, outer };

/// Triangles of about `size` [m], out of the wall: the lumen's into the blood.
Surface wall_face(const WallField& field, WallFace face, double size);

}   // namespace patency
