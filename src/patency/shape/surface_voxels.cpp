// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_voxels.h"

#include <omp.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <mutex>

namespace patency {

struct VoxelSides::Grid {
    openvdb::FloatGrid::Ptr grid;
};

VoxelSides::VoxelSides(const Surface& closed, const Vec3& origin, double voxel) {
    static std::once_flag is_started;
    std::call_once(is_started, [] { openvdb::initialize(); });
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(omp_get_max_threads()));
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const Vec3& x : closed.points) {
        const Vec3 at = (x - origin) / voxel;
        points.emplace_back(at.x, at.y, at.z);
    }
    for (const auto& t : closed.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    // The narrowest band that needs no widening; sides are all that is asked for. Of the kinds that OpenVDB's library holds compiled.
    constexpr float band = 2;
    constexpr int flags = openvdb::tools::DISABLE_RENORMALIZATION;
    openvdb::util::NullInterrupter never;
    using Mesh = openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I>;
    grid_ = std::make_shared<const Grid>(Grid{openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        never, Mesh{points, triangles}, *openvdb::math::Transform::createLinearTransform(1.0), band, band, flags)});
}

bool VoxelSides::is_inside(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return grid_->grid->constTree().getValue({i, j, k}) < 0;
}

}   // namespace patency
