// SPDX-License-Identifier: Apache-2.0
// Gradients at the points of cells, as weights of the values around: known once for a mesh. Solves for no flow.
#pragma once

#include <span>
#include <vector>

#include "patency/base/vec.h"
#include "patency/cells/cell_mesh.h"

namespace patency {

/// grad f_i = self f_i + sum_j row_j (f_j - f_i) + sum_b patch_b (f_b - f_i)                    [1/m]
struct CellGradients {
    std::vector<Vec3> row;     ///< as mesh.row
    std::vector<Vec3> patch;   ///< as mesh.patches; zero where no value is known
    std::vector<Vec3> self;    ///< per cell; zero away from walls
};

/// Of a field that is known at the openings with is_known, by weighted least squares. Exact for linear fields.
///                                                                                              THEORY.md (18.2)
CellGradients make_gradients(const CellMesh& mesh, std::span<const char> is_known);

/// Of a field that vanishes on the wall: in the cells at the wall that of the field over the wall's distance. Exact for
/// distance times a linear field.                                                               THEORY.md (18.3)
CellGradients make_gradients_at_rest_on_walls(const CellMesh& mesh, std::span<const char> is_known);

}   // namespace patency
