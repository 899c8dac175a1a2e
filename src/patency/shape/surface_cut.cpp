// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "patency/shape/flat_loop.h"

namespace patency {

namespace {

/// Heights of points over the plane [m]; those beyond the cut's reach count as far behind it.
class Heights {
public:
    explicit Heights(const FlatCut& cut) : cut_(cut) {}
    double of(const Vec3& x) const {
        const Vec3 d = x - cut_.point;
        const double height = dot(d, cut_.normal);
        const bool is_reached = norm(d - height * cut_.normal) <= cut_.reach && height <= cut_.length;
        return is_reached ? height : -Bounds::infinity;
    }

private:
    const FlatCut& cut_;
};

void close_rim(Surface& surface, const FlatLoop& loop, std::int32_t cap_id) {
    const auto centre = std::uint32_t(surface.points.size());
    surface.points.push_back(loop.centre);
    for (std::size_t k = 0; k < loop.rim.size(); ++k) {
        surface.triangles.push_back({centre, loop.rim[k], loop.rim[(k + 1) % loop.rim.size()]});
        surface.face_ids.push_back(cap_id);
    }
}

}   // namespace

std::size_t cut_flat(Surface& surface, const FlatCut& cut, double snap, std::optional<std::int32_t> cap_id) {
    const Heights heights(cut);
    std::vector<double> height(surface.points.size());
    for (std::size_t k = 0; k < height.size(); ++k) {
        height[k] = cut.points.empty() || cut.points[k] ? heights.of(surface.points[k]) : -Bounds::infinity;
        if (std::abs(height[k]) > snap) continue;
        surface.points[k] -= height[k] * cut.normal;
        height[k] = 0;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings;
    const auto crossing = [&](std::uint32_t a, std::uint32_t b) {   // of an edge whose ends lie on both sides
        const auto [low, high] = std::minmax(a, b);
        const auto [found, is_new] = crossings.try_emplace({low, high}, std::uint32_t(surface.points.size()));
        if (is_new) {
            const double t =
                std::isfinite(height[low] - height[high]) ? height[low] / (height[low] - height[high]) : 0.5;
            surface.points.push_back(surface.points[low] + t * (surface.points[high] - surface.points[low]));
        }
        return found->second;
    };

    Surface kept{.space = surface.space};
    const bool has_ids = !surface.face_ids.empty();
    for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
        const Triangle t = surface.triangles[k];
        std::vector<std::uint32_t> polygon;   // the part behind the plane
        bool has_area = false;
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = t[side], b = t[(side + 1) % 3];
            has_area |= height[a] < 0;
            if (height[a] <= 0) polygon.push_back(a);
            if (height[a] * height[b] < 0) polygon.push_back(crossing(a, b));
        }
        for (std::size_t c = 2; has_area && c < polygon.size(); ++c) {
            kept.triangles.push_back({polygon[0], polygon[c - 1], polygon[c]});
            if (has_ids || cap_id) kept.face_ids.push_back(has_ids ? surface.face_ids[k] : 1);
        }
    }
    kept.points = std::move(surface.points);
    surface = std::move(kept);

    std::vector<EdgeUse> rim;   // open edges in the plane
    const auto is_on_plane = [&](std::uint32_t point) { return point >= height.size() || height[point] == 0; };
    for (const EdgeUse& use : boundary_edges(edge_uses(surface)))
        if (is_on_plane(use.low) && is_on_plane(use.high)) rim.push_back(use);
    const std::vector<FlatLoop> loops = find_loops(surface, rim);
    if (cap_id)
        for (const FlatLoop& loop : loops) close_rim(surface, loop, *cap_id);
    merge_points(surface, 0);   // what lay past the plane goes
    return loops.size();
}

}   // namespace patency
