// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/triangle_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace patency {

namespace {

Vec3 middle_of(const Bounds& box) { return 0.5 * (box.low + box.high); }

double square_to_box(const Vec3& x, const Bounds& box) {
    const auto beyond = [](double at, double low, double high) { return std::max(std::max(low - at, at - high), 0.0); };
    const Vec3 d{beyond(x.x, box.low.x, box.high.x), beyond(x.y, box.low.y, box.high.y),
                 beyond(x.z, box.low.z, box.high.z)};
    return dot(d, d);
}

double square_to_farthest(const Vec3& x, const Bounds& box) {
    const auto away = [](double at, double low, double high) { return std::max(at - low, high - at); };
    const Vec3 d{away(x.x, box.low.x, box.high.x), away(x.y, box.low.y, box.high.y), away(x.z, box.low.z, box.high.z)};
    return dot(d, d);
}

}   // namespace

Vec3 nearest_place(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ax = x - a;
    // Least |ax - u ab - v ac|^2: the normal equations, then the sides if that lies outside.
    const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), xb = dot(ax, ab), xc = dot(ax, ac),
                 det = bb * cc - bc * bc;
    const double u = cc * xb - bc * xc, v = bb * xc - bc * xb;
    if (det > 0 && u >= 0 && v >= 0 && u + v <= det) return a + (u / det) * ab + (v / det) * ac;
    const auto on_side = [&](const Vec3& p, const Vec3& q) {
        const Vec3 d = q - p;
        const double length = dot(d, d);
        return length > 0 ? p + std::clamp(dot(x - p, d) / length, 0.0, 1.0) * d : p;
    };
    const auto nearer = [&](const Vec3& p, const Vec3& q) { return dot(x - p, x - p) <= dot(x - q, x - q) ? p : q; };
    return nearer(nearer(on_side(a, b), on_side(b, c)), on_side(c, a));
}

TriangleTree::TriangleTree(const Surface& surface) : surface_(surface), order_(surface.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    for (const Triangle& t : surface.triangles) {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        boxes_.push_back(joined(joined({a, a}, {b, b}), {c, c}));
    }
    if (!order_.empty()) build(0, std::uint32_t(order_.size()));
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
    const Vec3 first = middle_of(boxes_[order_[begin]]);
    Bounds box = boxes_[order_[begin]], centres{first, first};
    for (std::uint32_t k = begin; k < end; ++k) {
        const Vec3 middle = middle_of(boxes_[order_[k]]);
        box = joined(box, boxes_[order_[k]]);
        centres = joined(centres, {middle, middle});
    }
    const auto index = std::uint32_t(nodes_.size());
    nodes_.push_back({box, begin, end, 0, 0});
    if (end - begin <= leaf_size) return index;
    const Vec3 d = centres.high - centres.low;
    const auto along = [&](std::uint32_t t) {
        const Vec3 x = middle_of(boxes_[t]);
        return d.x >= d.y && d.x >= d.z ? x.x : d.y >= d.z ? x.y : x.z;
    };
    const std::uint32_t half = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](auto i, auto j) { return std::pair(along(i), i) < std::pair(along(j), j); });
    const std::uint32_t left = build(begin, half), right = build(half, end);
    nodes_[index].left = left, nodes_[index].right = right;
    return index;
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& x, double bound) const {
    Nearest best{bound, {}};
    std::pair<std::uint32_t, double> waiting[64];   // halving 2^32 triangles is 32 deep, two nodes each
    int count = 0;
    waiting[count++] = {0, square_to_box(x, nodes_[0].box)};
    while (count > 0) {
        const auto [index, square] = waiting[--count];
        if (square >= best.square) continue;
        const Node& node = nodes_[index];
        if (node.is_leaf()) {
            for (std::uint32_t k = node.begin; k < node.end; ++k) {
                if (square_to_box(x, boxes_[order_[k]]) >= best.square) continue;
                const auto& [a, b, c] = surface_.triangles[order_[k]];
                const Vec3 place = nearest_place(x, surface_.points[a], surface_.points[b], surface_.points[c]),
                           d = x - place;
                if (dot(d, d) < best.square) best = {dot(d, d), place};
            }
            continue;
        }
        std::pair nearer(node.left, square_to_box(x, nodes_[node.left].box)),
            farther(node.right, square_to_box(x, nodes_[node.right].box));
        if (farther.second < nearer.second) std::swap(nearer, farther);
        waiting[count++] = farther;
        waiting[count++] = nearer;
    }
    return best;
}

void TriangleTree::find_rivals(const Vec3& place, const Vec3& x, double radius,
                               std::vector<std::uint32_t>& found) const {
    // For p = x + e and q of a box: |p - q|^2 - |p - place|^2 = |q - x|^2 - |place - x|^2 - 2 e (q - place).
    const double own = dot(place - x, place - x) * (1 + 1e-12);
    const auto is_beaten = [&](const Bounds& box) {
        const double gain = square_to_box(x, box) - own;
        return gain > 0 && gain * gain > 4 * radius * radius * square_to_farthest(place, box);
    };
    std::uint32_t waiting[64];
    int count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const Node& node = nodes_[waiting[--count]];
        if (is_beaten(node.box)) continue;
        if (!node.is_leaf()) {
            waiting[count++] = node.right, waiting[count++] = node.left;
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.end; ++k)
            if (!is_beaten(boxes_[order_[k]])) found.push_back(order_[k]);
    }
}

}   // namespace patency
