// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_voxels.h"

#include <omp.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <mutex>

namespace patency {

namespace {

/// How OpenVDB sees the surface: in voxels.
struct SurfaceInVoxels {
    const Surface& surface;
    Vec3 origin;
    double voxel;

    std::size_t polygonCount() const { return surface.triangles.size(); }
    std::size_t pointCount() const { return surface.points.size(); }
    std::size_t vertexCount(std::size_t) const { return 3; }
    void getIndexSpacePoint(std::size_t triangle, std::size_t vertex, openvdb::Vec3d& at) const {
        const Vec3 x = (surface.points[surface.triangles[triangle][vertex]] - origin) / voxel;
        at = {x.x, x.y, x.z};
    }
};

}   // namespace

struct VoxelSides::Grid {
    openvdb::FloatGrid::Ptr grid;
};

VoxelSides::VoxelSides(const Surface& closed, const Vec3& origin, double voxel) {
    static std::once_flag is_started;
    std::call_once(is_started, [] { openvdb::initialize(); });
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(omp_get_max_threads()));
    // The narrowest band that needs no widening; sides are all that is asked for.
    constexpr float band = 2;
    constexpr int flags = openvdb::tools::DISABLE_RENORMALIZATION;
    grid_ = std::make_shared<const Grid>(Grid{openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        SurfaceInVoxels{closed, origin, voxel}, *openvdb::math::Transform::createLinearTransform(1.0), band, band,
        flags)});
}

bool VoxelSides::is_inside(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return grid_->grid->constTree().getValue({i, j, k}) < 0;
}

}   // namespace patency
