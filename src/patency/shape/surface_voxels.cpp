// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_voxels.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "patency/base/parallel.h"

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

std::vector<VoxelBrick> make_voxel_bricks(const Surface& closed, const Vec3& origin, double voxel, double outermost) {
    static std::once_flag is_started;
    std::call_once(is_started, [] { openvdb::initialize(); });
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(omp_get_max_threads()));
    // The triangles' own distance, not one smoothed by solving for a slope of one.
    constexpr int flags = openvdb::tools::DISABLE_RENORMALIZATION;
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        SurfaceInVoxels{closed, origin, voxel}, *openvdb::math::Transform::createLinearTransform(1.0), float(outermost),
        std::numeric_limits<float>::max(), flags);
    std::vector<const openvdb::FloatTree::LeafNodeType*> leaves;
    grid->tree().getNodes(leaves);
    static_assert(openvdb::FloatTree::LeafNodeType::SIZE == VoxelBrick::cells);
    std::vector<VoxelBrick> bricks(leaves.size());
    for_each_index(leaves.size(), [&](std::size_t b) {
        const openvdb::Coord o = leaves[b]->origin();
        bricks[b].origin = {o.x(), o.y(), o.z()};
        for (int n = 0; n < VoxelBrick::cells; ++n)
            bricks[b].value[std::size_t(n)] = std::min(float(outermost), leaves[b]->getValue(openvdb::Index(n)));
    });
    return bricks;
}

}   // namespace patency
