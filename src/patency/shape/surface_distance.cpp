// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/shape/surface_voxels.h"
#include "patency/shape/triangle_tree.h"

namespace patency {

namespace {

// Deeper inside [voxels], OpenVDB's rough values will do: no wall is near, and half of all triangles are equally far.
constexpr float exact_inside = 6;

/// What the grid knows at one corner of voxels: 16 bytes, one load.
struct alignas(16) Corner {
    float value, gx, gy, gz;   // [m], [1]
};

/// The corners of all voxels near the surface and inside, in bricks.
class Bricks {
public:
    Bricks(const std::vector<VoxelBrick>& bricks, const Surface& surface, const Vec3& origin, double voxel,
           double farthest);

    DistanceSample sample(const Vec3& x) const;

private:
    using Index = std::int32_t;
    static constexpr int cells = VoxelBrick::cells;

    /// The corner (i, j, k), or nothing far outside.
    const Corner* find(Index i, Index j, Index k) const {
        const Index bi = (i >> 3) - low_[0], bj = (j >> 3) - low_[1], bk = (k >> 3) - low_[2];
        if (std::uint32_t(bi) >= std::uint32_t(count_[0]) || std::uint32_t(bj) >= std::uint32_t(count_[1]) ||
            std::uint32_t(bk) >= std::uint32_t(count_[2]))
            return nullptr;
        const Index brick = table_[(std::size_t(bi) * count_[1] + bj) * count_[2] + bk];
        return brick < 0 ? nullptr
                         : &corners_[std::size_t(brick) * cells + (((i & 7) << 6) | ((j & 7) << 3) | (k & 7))];
    }
    void compute_gradients(const std::vector<VoxelBrick>& bricks);

    Vec3 origin_;
    double voxel_, farthest_;
    Index low_[3], count_[3];    // of bricks
    std::vector<Index> table_;   // where a brick's corners are; -1 for none
    std::vector<Corner> corners_;
};

Bricks::Bricks(const std::vector<VoxelBrick>& bricks, const Surface& surface, const Vec3& origin, double voxel,
               double farthest)
    : origin_(origin), voxel_(voxel), farthest_(farthest) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto [least, most] = std::minmax_element(bricks.begin(), bricks.end(), [&](const auto& a, const auto& b) {
            return a.origin[axis] < b.origin[axis];
        });
        low_[axis] = least->origin[axis] >> 3;
        count_[axis] = (most->origin[axis] >> 3) - low_[axis] + 1;
    }
    table_.assign(std::size_t(count_[0]) * count_[1] * count_[2], -1);
    for (std::size_t b = 0; b < bricks.size(); ++b) {
        const auto& o = bricks[b].origin;
        table_[(std::size_t((o[0] >> 3) - low_[0]) * count_[1] + ((o[1] >> 3) - low_[1])) * count_[2] +
               ((o[2] >> 3) - low_[2])] = Index(b);
    }
    corners_.resize(bricks.size() * cells);
    const TriangleTree tree(surface);
    const auto outermost = float(farthest / voxel);
    for_each_index(bricks.size(), [&](std::size_t b) {
        const auto& o = bricks[b].origin;
        for (int n = 0; n < cells; ++n) {
            const float rough = bricks[b].value[std::size_t(n)];
            double value = voxel * double(rough);
            if (rough < outermost && rough > -exact_inside) {
                const Vec3 place{double(o[0] + (n >> 6)), double(o[1] + ((n >> 3) & 7)), double(o[2] + (n & 7))};
                const double bound = std::min(farthest, (1 + 1e-5) * std::abs(value));   // a triangle's, rounded
                value = std::copysign(std::sqrt(tree.square_distance(origin_ + voxel * place, bound * bound)), value);
            }
            corners_[b * cells + std::size_t(n)] = {float(value), 0, 0, 0};
        }
    });
    compute_gradients(bricks);
}

void Bricks::compute_gradients(const std::vector<VoxelBrick>& bricks) {
    // Values at the band's outer face are cut off: there the slope is one-sided.
    const auto limit = float(farthest_ * (1 - 1e-6));
    const auto slope = [&](const Corner& here, const Corner* before, const Corner* after) {
        const bool has_before = before && before->value < limit, has_after = after && after->value < limit;
        if (has_before && has_after) return (after->value - before->value) / float(2 * voxel_);
        if (has_after) return (after->value - here.value) / float(voxel_);
        return has_before ? (here.value - before->value) / float(voxel_) : 0.0f;
    };
    for_each_index(bricks.size(), [&](std::size_t b) {
        for (int n = 0; n < cells; ++n) {
            const Index i = bricks[b].origin[0] + (n >> 6), j = bricks[b].origin[1] + ((n >> 3) & 7),
                        k = bricks[b].origin[2] + (n & 7);
            Corner& here = corners_[b * cells + n];
            here.gx = slope(here, find(i - 1, j, k), find(i + 1, j, k));
            here.gy = slope(here, find(i, j - 1, k), find(i, j + 1, k));
            here.gz = slope(here, find(i, j, k - 1), find(i, j, k + 1));
        }
    });
}

DistanceSample Bricks::sample(const Vec3& x) const {
    const Vec3 place = (x - origin_) / voxel_;
    const auto far_away = [&] {
        const Vec3 from_middle = x - origin_;
        const double length = norm(from_middle);
        return DistanceSample{farthest_, length > 0 && length < Bounds::infinity ? from_middle / length : Vec3{1, 0, 0},
                              0};
    };
    constexpr double most = 1e9;   // an index in 32 bits; NaN fails too
    if (!(std::abs(place.x) < most && std::abs(place.y) < most && std::abs(place.z) < most)) return far_away();
    const double fi = std::floor(place.x), fj = std::floor(place.y), fk = std::floor(place.z);
    const Index i = Index(fi), j = Index(fj), k = Index(fk);
    const double u = place.x - fi, v = place.y - fj, w = place.z - fk;
    const Corner outside{float(farthest_), 0, 0, 0};
    const Corner* corner[8];
    if ((i & 7) < 7 && (j & 7) < 7 && (k & 7) < 7) {   // all in one brick
        const Corner* first = find(i, j, k);
        if (!first) return far_away();
        for (int n = 0; n < 8; ++n) corner[n] = first + ((n >> 2) << 6) + (((n >> 1) & 1) << 3) + (n & 1);
    } else {
        for (int n = 0; n < 8; ++n) {
            const Corner* found = find(i + (n >> 2), j + ((n >> 1) & 1), k + (n & 1));
            corner[n] = found ? found : &outside;
        }
    }
    double value = 0, divergence = 0;
    Vec3 gradient{};
    for (int n = 0; n < 8; ++n) {
        const bool a = n >> 2, b = (n >> 1) & 1, c = n & 1;
        const double wu = a ? u : 1 - u, wv = b ? v : 1 - v, ww = c ? w : 1 - w;
        const Vec3 g{corner[n]->gx, corner[n]->gy, corner[n]->gz};
        value += wu * wv * ww * double(corner[n]->value);
        gradient += (wu * wv * ww) * g;
        divergence += (a ? 1 : -1) * wv * ww * g.x + (b ? 1 : -1) * wu * ww * g.y + (c ? 1 : -1) * wu * wv * g.z;
    }
    const double length = norm(gradient);
    if (!(length > 1e-3)) {   // on the medial axis any direction to the wall will do; outside the band there is none
        DistanceSample s = far_away();
        s.value = value;
        return s;
    }
    return {value, gradient / length, divergence / voxel_};
}

void expect_closed(const Surface& surface) {
    for (const Vec3& x : surface.points)
        if (!std::isfinite(x.x + x.y + x.z)) throw GeometryError("A point of the surface is not a number.");
    std::size_t open = 0;
    const std::vector<EdgeUse> uses = edge_uses(surface);
    for_each_edge(uses,
                  [&](std::span<const EdgeUse> edge) { open += edge.size() != 2 || edge[0].rises == edge[1].rises; });
    if (open > 0 || surface.triangles.empty())
        throw GeometryError(
            fmt::format("The distance to a surface needs a closed one, all triangles facing outward; {} edges of "
                        "this one have not just two triangles that agree.",
                        open));
    if (!(volume(surface) > 0)) throw GeometryError("The surface is inside out: its triangles face into the lumen.");
}

/// The corners that OpenVDB will fill, within a factor of two. Too many are refused before anything is allocated.
void expect_room(const Surface& surface, double voxel, double outside) {
    constexpr double most = 5e8;   // corners: 8 GB
    const Bounds box = grown(bounds(surface), outside);
    const Vec3 size = box.high - box.low;
    const double filled = (volume(surface) + outside * area(surface)) / (voxel * voxel * voxel),
                 boxed = size.x * size.y * size.z / std::pow(VoxelBrick::size * voxel, 3);
    if (!(filled < most && boxed < most && norm(size) / voxel < 1e8))
        throw GeometryError(
            fmt::format("The distance to this surface in voxels of {:.3g} mm needs {:.1e} of them, which is too many: "
                        "take a larger spacing.",
                        1e3 * voxel, std::max(filled, boxed)));
}

}   // namespace

SignedDistance make_surface_distance(const Surface& closed, double voxel, double outside) {
    if (!(voxel > 0) || !std::isfinite(voxel))
        throw GeometryError("The voxels of a distance must be larger than nothing.");
    if (!(outside > 0)) outside = 10 * voxel;
    expect_closed(closed);
    expect_room(closed, voxel, outside);

    const Bounds box = bounds(closed);
    // Two voxels more, for the corners around a place at `outside` and their slopes.
    const double outermost = outside / voxel + 2;
    const auto bricks = std::make_shared<const Bricks>(make_voxel_bricks(closed, box.low, voxel, outermost), closed,
                                                       box.low, voxel, voxel * outermost);
    return {[bricks](const Vec3& x) { return bricks->sample(x); }, box};
}

}   // namespace patency
