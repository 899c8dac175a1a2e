// SPDX-License-Identifier: Apache-2.0
// Which side of a closed surface the corners of voxels are on: OpenVDB's answer. Distances are surface_distance.h's.
#pragma once

#include <cstdint>
#include <memory>

#include "patency/shape/surface.h"

namespace patency {

/// Sides are found by flooding from outside, so that they are right also where parts of the surface touch.
class VoxelSides {
public:
    /// Corner (0, 0, 0) is at origin [m]. The surface must be closed. The same for any number of threads.
    VoxelSides(const Surface& closed, const Vec3& origin, double voxel);

    bool is_inside(std::int32_t i, std::int32_t j, std::int32_t k) const;   ///< safe to call from several threads

private:
    struct Grid;
    std::shared_ptr<const Grid> grid_;
};

}   // namespace patency
