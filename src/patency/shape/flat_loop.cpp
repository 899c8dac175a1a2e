// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/flat_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace patency {

double FlatLoop::diameter() const { return std::sqrt(4 * area / std::numbers::pi); }
double FlatLoop::roundness() const { return perimeter > 0 ? 4 * std::numbers::pi * area / (perimeter * perimeter) : 0; }

FlatLoop measured_loop(const Surface& surface, std::vector<std::uint32_t> rim) {
    FlatLoop loop{.rim = std::move(rim)};
    const std::size_t n = loop.rim.size();
    const auto point = [&](std::size_t k) -> const Vec3& { return surface.points[loop.rim[k % n]]; };
    Vec3 mean{}, sum{};
    for (std::size_t k = 0; k < n; ++k) mean += point(k) / double(n);
    for (std::size_t k = 0; k < n; ++k) {
        sum += 0.5 * cross(point(k) - mean, point(k + 1) - mean);
        loop.perimeter += norm(point(k + 1) - point(k));
    }
    loop.area = norm(sum);
    loop.centre = mean;
    if (loop.area > 0) {
        loop.normal = sum / loop.area;
        Vec3 moment{};
        for (std::size_t k = 0; k < n; ++k) {
            const Vec3 a = point(k) - mean, b = point(k + 1) - mean;
            moment += 0.5 * dot(cross(a, b), loop.normal) * ((a + b) / 3.0);
        }
        // A loop that crosses itself has areas that cancel: the centroid of what is left is anywhere, perhaps far from the points.
        double farthest = 0;
        for (std::size_t k = 0; k < n; ++k) farthest = std::max(farthest, norm(point(k) - mean));
        if (const Vec3 shift = moment / loop.area; norm(shift) <= farthest) loop.centre += shift;
    }
    for (std::size_t k = 0; k < n; ++k) {
        loop.reach = std::max(loop.reach, norm(point(k) - loop.centre));
        loop.flatness = std::max(loop.flatness, std::abs(dot(point(k) - loop.centre, loop.normal)));
    }
    return loop;
}

std::vector<FlatLoop> find_loops(const Surface& surface, std::span<const EdgeUse> boundary) {
    // A face that closes the surface runs along each edge the other way round than the triangle that has it.
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> next;
    for (const EdgeUse& use : boundary) next[use.rises ? use.high : use.low].push_back(use.rises ? use.low : use.high);
    std::vector<FlatLoop> loops;
    for (const EdgeUse& use : boundary) {
        std::vector<std::uint32_t> path{use.rises ? use.high : use.low};
        std::unordered_map<std::uint32_t, std::size_t> place{{path[0], 0}};
        while (!path.empty()) {
            auto& onward = next[path.back()];
            if (onward.empty()) {   // nowhere to go: done, or an edge on no closed line
                place.erase(path.back());
                path.pop_back();
                continue;
            }
            const std::uint32_t point = onward.back();
            onward.pop_back();
            const auto seen = place.find(point);
            if (seen == place.end()) {
                place[point] = path.size();
                path.push_back(point);
                continue;
            }
            std::vector<std::uint32_t> rim(path.begin() + std::ptrdiff_t(seen->second), path.end());
            for (std::size_t k = 1; k < rim.size(); ++k) place.erase(rim[k]);
            path.resize(seen->second + 1);
            loops.push_back(measured_loop(surface, std::move(rim)));
        }
    }
    return loops;
}

std::vector<EdgeUse> boundary_edges(std::span<const EdgeUse> uses) {
    std::vector<EdgeUse> boundary;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 1) boundary.push_back(edge[0]);
    });
    return boundary;
}

Surface closed_at(Surface surface, std::span<const FlatLoop> loops) {
    for (const FlatLoop& loop : loops) {
        const auto centre = std::uint32_t(surface.points.size());
        surface.points.push_back(loop.centre);
        for (std::size_t k = 0; k < loop.rim.size(); ++k) {   // the rim runs as a face that closes the surface would
            surface.triangles.push_back({centre, loop.rim[k], loop.rim[(k + 1) % loop.rim.size()]});
            if (!surface.face_ids.empty()) surface.face_ids.push_back(-1);
        }
    }
    return surface;
}

double closed_volume(const Surface& surface, std::span<const FlatLoop> loops) {
    double sum = volume(surface);
    if (surface.points.empty()) return sum;
    for (const FlatLoop& loop : loops) sum += dot(loop.centre - surface.points[0], loop.area * loop.normal) / 3;
    return sum;
}

}   // namespace patency
