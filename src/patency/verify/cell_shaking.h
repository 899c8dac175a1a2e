// SPDX-License-Identifier: Apache-2.0
// Disorder for the verification cases of cells.
#pragma once

#include "patency/stages/cell_scene.h"

namespace patency {

/// Moves every point by up to `share` of its spacing along each axis, but not out of the lumen's middle or near its walls.
void shake(const Lumen& lumen, double share, CellPoints& points);

}   // namespace patency
