// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace patency {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A cell of a regular grid of space.
struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
};
struct CellHash {
    std::size_t operator()(const Cell& c) const {
        // Large odd factors spread neighbouring cells; which ones does not matter.
        return std::size_t(c.x) * 0x9E3779B97F4A7C15ull ^ std::size_t(c.y) * 0xC2B2AE3D27D4EB4Full ^
               std::size_t(c.z) * 0x165667B19E3779F9ull;
    }
};

/// For every point the first one that equals it exactly.
std::vector<std::uint32_t> find_equal(const std::vector<Vec3>& points) {
    std::vector<std::uint32_t> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) { return std::tuple(points[i].x, points[i].y, points[i].z); };
    std::sort(order.begin(), order.end(), [&](auto i, auto j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first[order[k - 1]] : order[k];
    return first;
}

/// Lets points that are `first` follow an earlier one within the tolerance.
void join_near(const std::vector<Vec3>& points, double tolerance, std::vector<std::uint32_t>& first) {
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells;
    const Vec3 corner = points.empty() ? Vec3{} : points[0];
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (first[i] != i) continue;
        const Vec3 x = (points[i] - corner) / tolerance;
        const Cell home{std::int64_t(std::floor(x.x)), std::int64_t(std::floor(x.y)), std::int64_t(std::floor(x.z))};
        for (int k = 0; k < 27 && first[i] == i; ++k) {
            const auto found = cells.find({home.x + k % 3 - 1, home.y + k / 3 % 3 - 1, home.z + k / 9 - 1});
            if (found == cells.end()) continue;
            for (std::uint32_t j : found->second)
                if (norm(points[i] - points[j]) <= tolerance) first[i] = std::min(first[i], j);
        }
        if (first[i] == i) cells[home].push_back(i);
    }
    for (std::uint32_t& f : first) f = first[f];   // two steps at most: an equal point, then a near one
}

}   // namespace

Vec3 area_vector(const Surface& surface, const Triangle& t) {
    const auto& p = surface.points;
    return 0.5 * cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
}

Vec3 centroid(const Surface& surface, const Triangle& t) {
    const auto& p = surface.points;
    return (p[t[0]] + p[t[1]] + p[t[2]]) / 3.0;
}

double area(const Surface& surface) {
    double sum = 0;
    for (const Triangle& t : surface.triangles) sum += norm(area_vector(surface, t));
    return sum;
}

double volume(const Surface& surface) {
    if (surface.points.empty()) return 0;
    const Vec3 origin = surface.points[0];   // near the surface, so that nothing large cancels
    double sum = 0;
    for (const Triangle& t : surface.triangles) sum += dot(centroid(surface, t) - origin, area_vector(surface, t)) / 3;
    return sum;
}

Bounds bounds(const Surface& surface) {
    if (surface.points.empty()) return {};
    Bounds box{surface.points[0], surface.points[0]};
    for (const Vec3& x : surface.points) box = joined(box, {x, x});
    return box;
}

double diagonal(const Bounds& box) { return norm(box.high - box.low); }

Surface part_of(const Surface& surface, std::span<const std::uint32_t> triangles) {
    Surface part{.space = surface.space};
    std::vector<std::uint32_t> index(surface.points.size(), none);
    for (std::uint32_t t : triangles) {
        Triangle& added = part.triangles.emplace_back(surface.triangles[t]);
        for (std::uint32_t& point : added) {
            if (index[point] == none) {
                index[point] = std::uint32_t(part.points.size());
                part.points.push_back(surface.points[point]);
            }
            point = index[point];
        }
        if (!surface.face_ids.empty()) part.face_ids.push_back(surface.face_ids[t]);
    }
    return part;
}

std::size_t merge_points(Surface& surface, double tolerance) {
    const std::size_t before = surface.points.size();
    std::vector<std::uint32_t> first = find_equal(surface.points);
    if (tolerance > 0) join_near(surface.points, tolerance, first);
    for (Triangle& t : surface.triangles)
        for (std::uint32_t& point : t) point = first[point];
    std::vector<std::uint32_t> all(surface.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    surface = part_of(surface, all);
    return before - surface.points.size();
}

std::vector<EdgeUse> edge_uses(const Surface& surface) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * surface.triangles.size());
    for (std::uint32_t k = 0; k < surface.triangles.size(); ++k) {
        const Triangle& t = surface.triangles[k];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = t[side], b = t[(side + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), k, a < b});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return uses;
}

Groups::Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

std::uint32_t Groups::group_of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void Groups::join(std::uint32_t i, std::uint32_t j) {
    i = group_of(i), j = group_of(j);
    parent_[std::max(i, j)] = std::min(i, j);
}

}   // namespace patency
