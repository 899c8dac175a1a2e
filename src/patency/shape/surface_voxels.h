// SPDX-License-Identifier: Apache-2.0
// Which side of a closed surface the corners of voxels are on, and how far, roughly: OpenVDB's answer in plain bricks.
// Exact distances are surface_distance.h's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

/// 8 x 8 x 8 corners; z varies fastest.
struct VoxelBrick {
    static constexpr int size = 8, cells = size * size * size;
    std::array<std::int32_t, 3> origin;   ///< of its first corner, in voxels; multiples of 8
    std::array<float, cells> value;       ///< [voxels], negative inside; the outermost for corners farther outside
};

/// All bricks with a corner inside or less than `outermost` [voxels] outside. Corner (0, 0, 0) is at origin [m]. The sign
/// is right; values within two voxels of the wall are too, those farther away may err by a quarter of a voxel, as each
/// takes its triangle from its neighbours'. The same for any number of threads. The surface must be closed.
std::vector<VoxelBrick> make_voxel_bricks(const Surface& closed, const Vec3& origin, double voxel, double outermost);

}   // namespace patency
