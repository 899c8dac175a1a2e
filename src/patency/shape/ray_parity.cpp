// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/ray_parity.h"

#include <array>
#include <utility>

namespace patency {

namespace {

struct Ray {
    Vec3 start, direction;

    /// Whether it passes through the box: the part of it between the two planes of every axis must have a length.
    bool meets(const Bounds& box) const {
        double from = 0, to = Bounds::infinity;
        const auto clip = [&](double low, double high, double at, double slope) {
            double a = (low - at) / slope, b = (high - at) / slope;
            if (b < a) std::swap(a, b);
            from = std::max(from, a), to = std::min(to, b);
        };
        clip(box.low.x, box.high.x, start.x, direction.x);
        clip(box.low.y, box.high.y, start.y, direction.y);
        clip(box.low.z, box.high.z, start.z, direction.z);
        return from <= to;
    }

    /// Its line passes through where the three tetrahedra that it makes with the sides turn the same way.
    bool meets(const Vec3& a, const Vec3& b, const Vec3& c) const {
        const Vec3 p = a - start, q = b - start, r = c - start;
        const double u = dot(direction, cross(r, q)), v = dot(direction, cross(p, r)), w = dot(direction, cross(q, p));
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) return false;
        const double all = u + v + w;
        return all != 0 && (u * dot(p, direction) + v * dot(q, direction) + w * dot(r, direction)) / all > 0;
    }
};

bool is_odd(const Ray& ray, const Surface& surface, const TriangleTree& tree) {
    bool odd = false;
    std::array<std::uint32_t, 64> waiting;   // the tree is at most 32 deep, two nodes each
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const TriangleTree::Node& node = tree.nodes()[waiting[--count]];
        if (!ray.meets(node.box)) continue;
        if (!node.is_leaf()) {
            waiting[count++] = node.right, waiting[count++] = node.left;
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.end; ++k) {
            const Triangle& t = surface.triangles[tree.order()[k]];
            odd ^= ray.meets(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
        }
    }
    return odd;
}

}   // namespace

bool is_enclosed(const Surface& surface, const TriangleTree& tree, const Vec3& x) {
    // Along no axis, no diagonal: models of vessels have sides there.
    constexpr std::array<Vec3, 3> directions{Vec3{0.4361, 0.7123, 0.5497}, Vec3{-0.8017, 0.3359, 0.4943},
                                             Vec3{0.2713, -0.5231, 0.8079}};
    int inside = 0;
    for (const Vec3& direction : directions) inside += is_odd({x, direction}, surface, tree);
    return inside >= 2;
}

}   // namespace patency
