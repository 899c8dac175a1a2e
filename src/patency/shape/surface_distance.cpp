// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/shape/surface_voxels.h"
#include "patency/shape/triangle_tree.h"

namespace patency {

namespace {

// A brick is 8 x 8 x 8 corners, z fastest: one page of memory for four voxels' width. Distances are found for an eighth of it
// at a time: the fewer corners, the fewer triangles may be the nearest of one of them.
constexpr int brick_size = 8, brick_cells = brick_size * brick_size * brick_size, part_size = 4,
              part_cells = part_size * part_size * part_size;
using BrickOrigin = std::array<std::int32_t, 3>;   // its first corner [voxels]; multiples of 8

/// What the grid knows at one corner of voxels: 16 bytes, one load.
struct alignas(16) Corner {
    float value, gx, gy, gz;   // [m], [1]
};

/// The corners of all voxels near the surface and inside, in bricks.
class Bricks {
public:
    Bricks(const std::vector<BrickOrigin>& bricks, const Vec3& origin, double voxel, double farthest);

    Corner* corners_of(std::size_t brick) { return &corners_[brick * cells]; }
    /// To be called when all corners have their values.
    void compute_gradients(const std::vector<BrickOrigin>& bricks);

    DistanceSample sample(const Vec3& x) const;

private:
    using Index = std::int32_t;
    static constexpr int cells = brick_cells;

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

    Vec3 origin_;
    double voxel_, farthest_;
    Index low_[3], count_[3];    // of bricks
    std::vector<Index> table_;   // where a brick's corners are; -1 for none
    std::vector<Corner> corners_;
};

Bricks::Bricks(const std::vector<BrickOrigin>& bricks, const Vec3& origin, double voxel, double farthest)
    : origin_(origin), voxel_(voxel), farthest_(farthest) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [least, most] = std::minmax_element(bricks.begin(), bricks.end(),
                                                       [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        low_[axis] = (*least)[axis] >> 3;
        count_[axis] = ((*most)[axis] >> 3) - low_[axis] + 1;
    }
    table_.assign(std::size_t(count_[0]) * count_[1] * count_[2], -1);
    for (std::size_t b = 0; b < bricks.size(); ++b) {
        const auto& o = bricks[b];
        table_[(std::size_t((o[0] >> 3) - low_[0]) * count_[1] + ((o[1] >> 3) - low_[1])) * count_[2] +
               ((o[2] >> 3) - low_[2])] = Index(b);
    }
    corners_.resize(bricks.size() * cells);
}

void Bricks::compute_gradients(const std::vector<BrickOrigin>& bricks) {
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
            const Index i = bricks[b][0] + (n >> 6), j = bricks[b][1] + ((n >> 3) & 7), k = bricks[b][2] + (n & 7);
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

/// The distances of corners from a surface.
class CornerDistances {
public:
    CornerDistances(const Surface& surface, const Vec3& origin, double voxel, double farthest)
        : surface_(surface),
          origin_(origin),
          voxel_(voxel),
          farthest_(farthest),
          tree_(surface),
          sides_(surface, origin, voxel) {}

    /// All bricks with a corner inside or less than `farthest` outside.
    std::vector<BrickOrigin> find_bricks() const;
    /// Writes the values of a brick.
    void fill(const BrickOrigin& brick, Corner* corners) const;

private:
    Vec3 place(double i, double j, double k) const { return origin_ + voxel_ * Vec3{i, j, k}; }
    /// From the middle of size^3 corners to the outermost of them [m].
    double reach_of(int size) const { return std::sqrt(3.0) * 0.5 * (size - 1) * voxel_; }
    /// Whether one of size^3 corners may be inside or nearer than `farthest`.
    bool is_wanted(const BrickOrigin& first, int size) const {
        const double half = 0.5 * (size - 1), beyond = farthest_ + reach_of(size);
        const Vec3 middle = place(first[0] + half, first[1] + half, first[2] + half);
        if (tree_.square_distance(middle, beyond * beyond) < beyond * beyond) return true;
        return sides_.is_inside(first[0], first[1], first[2]);   // no wall is near: all are
    }

    const Surface& surface_;
    Vec3 origin_;
    double voxel_, farthest_;
    TriangleTree tree_;
    VoxelSides sides_;
};

std::vector<BrickOrigin> CornerDistances::find_bricks() const {
    constexpr int group = 4;   // bricks along each axis are asked for together first
    const Bounds box = grown(bounds(surface_), farthest_);
    const auto brick_at = [&](double at, double origin) {
        return std::int32_t(std::floor((at - origin) / (brick_size * voxel_)));
    };
    const std::array<std::int32_t, 3> low{brick_at(box.low.x, origin_.x), brick_at(box.low.y, origin_.y),
                                          brick_at(box.low.z, origin_.z)};
    const std::array<std::int32_t, 3> high{brick_at(box.high.x, origin_.x), brick_at(box.high.y, origin_.y),
                                           brick_at(box.high.z, origin_.z)};
    std::array<std::size_t, 3> groups;
    for (std::size_t axis = 0; axis < 3; ++axis)
        groups[axis] = std::size_t(high[axis] - low[axis]) / std::size_t(group) + 1;
    std::vector<std::vector<BrickOrigin>> found(groups[0] * groups[1]);
    for_each_task(found.size(), [&](std::size_t column) {
        const auto a = std::int32_t(column / groups[1]), b = std::int32_t(column % groups[1]);
        for (std::int32_t c = 0; c < std::int32_t(groups[2]); ++c) {
            const BrickOrigin first{brick_size * (low[0] + group * a), brick_size * (low[1] + group * b),
                                    brick_size * (low[2] + group * c)};
            if (!is_wanted(first, group * brick_size)) continue;
            for (std::int32_t n = 0; n < group * group * group; ++n) {
                const BrickOrigin brick{first[0] + brick_size * (n / (group * group)),
                                        first[1] + brick_size * (n / group % group),
                                        first[2] + brick_size * (n % group)};
                if (is_wanted(brick, brick_size)) found[column].push_back(brick);
            }
        }
    });
    std::vector<BrickOrigin> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

/// The squares of the distances of places from the triangle abc, where that is less than `square`. Without branches, so that
/// places go side by side.
void lower_to_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const double* x, const double* y, const double* z,
                       double* square) {
    const Vec3 ab = b - a, ac = c - a, bc = c - b, normal = cross(ab, ac);
    const double bb = dot(ab, ab), mixed = dot(ab, ac), cc = dot(ac, ac), ee = dot(bc, bc), area = dot(normal, normal);
    const auto inverse = [](double length) { return length > 0 ? 1 / length : 0.0; };
    const double per_bb = inverse(bb), per_cc = inverse(cc), per_ee = inverse(ee), per_area = inverse(area);
    const double least = area > 0 ? 0 : 1;   // nothing is over a triangle without area
    for (int n = 0; n < part_cells; ++n) {
        const double px = x[n] - a.x, py = y[n] - a.y, pz = z[n] - a.z;
        const double qx = x[n] - b.x, qy = y[n] - b.y, qz = z[n] - b.z;
        const double pb = px * ab.x + py * ab.y + pz * ab.z, pc = px * ac.x + py * ac.y + pz * ac.z;
        const double qc = qx * bc.x + qy * bc.y + qz * bc.z, over = px * normal.x + py * normal.y + pz * normal.z;
        // Least |p - u ab - v ac|^2 by the normal equations; the sides if that lies outside.
        const double u = (cc * pb - mixed * pc) * per_area, v = (bb * pc - mixed * pb) * per_area;
        const auto squared = [](double dx, double dy, double dz) { return dx * dx + dy * dy + dz * dz; };
        const double s = std::min(std::max(pb * per_bb, 0.0), 1.0), t = std::min(std::max(pc * per_cc, 0.0), 1.0),
                     w = std::min(std::max(qc * per_ee, 0.0), 1.0);
        const double to_ab = squared(px - s * ab.x, py - s * ab.y, pz - s * ab.z),
                     to_ac = squared(px - t * ac.x, py - t * ac.y, pz - t * ac.z),
                     to_bc = squared(qx - w * bc.x, qy - w * bc.y, qz - w * bc.z);
        const double to_sides = std::min(std::min(to_ab, to_ac), to_bc), to_plane = over * over * per_area;
        const double inside = std::min(std::min(u, v), 1 - u - v);
        square[n] = std::min(square[n], inside >= least ? to_plane : to_sides);
    }
}

void CornerDistances::fill(const BrickOrigin& brick, Corner* corners) const {
    thread_local std::vector<std::uint32_t> near;
    const double reach = reach_of(part_size), beyond = farthest_ + reach;
    for (int part = 0; part < 8; ++part) {
        const int pi = (part >> 2) * part_size, pj = ((part >> 1) & 1) * part_size, pk = (part & 1) * part_size;
        double x[part_cells], y[part_cells], z[part_cells], square[part_cells];
        std::int32_t at[part_cells];   // in the brick
        for (int n = 0; n < part_cells; ++n) {
            const int i = pi + n / 16, j = pj + n / 4 % 4, k = pk + n % 4;
            const Vec3 corner = place(brick[0] + i, brick[1] + j, brick[2] + k);
            x[n] = corner.x, y[n] = corner.y, z[n] = corner.z;
            square[n] = Bounds::infinity;
            at[n] = (i << 6) | (j << 3) | k;
        }
        const auto is_inside = [&](int n) {
            return sides_.is_inside(brick[0] + (at[n] >> 6), brick[1] + ((at[n] >> 3) & 7), brick[2] + (at[n] & 7));
        };
        const double half = 0.5 * (part_size - 1);
        const Vec3 middle = place(brick[0] + pi + half, brick[1] + pj + half, brick[2] + pk + half);
        TriangleTree::Nearest nearest = tree_.nearest(middle, beyond * beyond);
        const bool is_far = nearest.square >= beyond * beyond, no_wall = nearest.square > reach * reach * (1 + 1e-9),
                   is_first_inside = is_inside(0);
        if (!is_far || is_first_inside) {
            if (is_far) nearest = tree_.nearest(middle, Bounds::infinity);
            near.clear();
            tree_.find_rivals(nearest.place, middle, reach, near);
            for (const std::uint32_t k : near) {
                const Triangle& t = surface_.triangles[k];
                lower_to_triangle(surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]], x, y, z, square);
            }
        }
        for (int n = 0; n < part_cells; ++n) {
            const bool inside = no_wall ? is_first_inside : is_inside(n);
            const double distance = std::sqrt(square[n]);
            corners[at[n]] = {float(inside ? -distance : std::min(distance, farthest_)), 0, 0, 0};
        }
    }
}

Bricks make_bricks(const Surface& surface, const Vec3& origin, double voxel, double farthest) {
    const CornerDistances distances(surface, origin, voxel, farthest);
    const std::vector<BrickOrigin> found = distances.find_bricks();
    Bricks bricks(found, origin, voxel, farthest);
    for_each_task(found.size(), [&](std::size_t b) { distances.fill(found[b], bricks.corners_of(b)); });
    bricks.compute_gradients(found);
    return bricks;
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
                 boxed = size.x * size.y * size.z / std::pow(brick_size * voxel, 3);
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
    const auto bricks = std::make_shared<const Bricks>(make_bricks(closed, box.low, voxel, outside + 2 * voxel));
    return {[bricks](const Vec3& x) { return bricks->sample(x); }, box};
}

}   // namespace patency
