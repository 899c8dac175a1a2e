// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/triangle_pairs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

namespace patency {

namespace {

bool overlap(const Bounds& a, const Bounds& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
           a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/// Where the line from p to q passes through the triangle. Ends that touch its plane within round-off do not.
std::optional<Vec3> find_passage(const Surface& surface, std::uint32_t p, std::uint32_t q, const Triangle& t) {
    const Vec3 &a = surface.points[t[0]], &x = surface.points[p], &y = surface.points[q];
    const Vec3 ab = surface.points[t[1]] - a, ac = surface.points[t[2]] - a, n = cross(ab, ac);
    const double height_x = dot(n, x - a), height_y = dot(n, y - a);
    constexpr double round_off = 1e-10;   // of the product of lengths that a height is made of
    const double touch = round_off * norm(n) * (norm(x - a) + norm(y - a));
    if (!(std::min(height_x, height_y) < -touch && std::max(height_x, height_y) > touch)) return {};
    const Vec3 place = x + (height_x / (height_x - height_y)) * (y - x);
    const double nn = dot(n, n), u = dot(cross(place - a, ac), n) / nn, v = dot(cross(ab, place - a), n) / nn;
    if (u < 0 || v < 0 || u + v > 1) return {};
    return place;
}

bool has(const Triangle& t, std::uint32_t point) { return t[0] == point || t[1] == point || t[2] == point; }

/// A side of a that passes through b. Sides that begin at a point of b only touch it.
std::optional<Vec3> find_side_through(const Surface& surface, const Triangle& a, const Triangle& b) {
    for (int side = 0; side < 3; ++side) {
        const std::uint32_t p = a[side], q = a[(side + 1) % 3];
        if (has(b, p) || has(b, q)) continue;
        if (const auto place = find_passage(surface, p, q, b)) return place;
    }
    return {};
}

/// A tree of boxes around triangles; each node halves its triangles along the longest axis of their centres.
class BoxTree {
public:
    explicit BoxTree(const Surface& surface) : surface_(surface), order_(surface.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        for (const Triangle& t : surface.triangles) {
            const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
            boxes_.push_back(joined(joined({a, a}, {b, b}), {c, c}));
        }
        if (!order_.empty()) root_ = build(0, order_.size());
    }

    std::vector<TrianglePair> crossings(std::size_t limit) {
        limit_ = limit;
        if (!nodes_.empty()) search_within(root_);
        std::sort(found_.begin(), found_.end(),
                  [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
        return std::move(found_);
    }

private:
    static constexpr std::size_t leaf_size = 4;   // fewer make the tree deep, more are compared in vain
    struct Node {
        Bounds box;
        std::size_t begin, end;    // of order_
        std::size_t left, right;   // equal in a leaf
    };

    std::size_t build(std::size_t begin, std::size_t end) {
        Bounds box = boxes_[order_[begin]], centres{middle(order_[begin]), middle(order_[begin])};
        for (std::size_t k = begin; k < end; ++k) {
            box = joined(box, boxes_[order_[k]]);
            centres = joined(centres, {middle(order_[k]), middle(order_[k])});
        }
        const std::size_t index = nodes_.size();
        nodes_.push_back({box, begin, end, 0, 0});
        if (end - begin <= leaf_size) return index;
        const Vec3 d = centres.high - centres.low;
        const auto along = [&](const Vec3& x) { return d.x >= d.y && d.x >= d.z ? x.x : d.y >= d.z ? x.y : x.z; };
        const std::size_t half = (begin + end) / 2;
        const auto at = [&](std::size_t k) { return order_.begin() + std::ptrdiff_t(k); };
        std::nth_element(at(begin), at(half), at(end), [&](auto i, auto j) {
            return std::pair(along(middle(i)), i) < std::pair(along(middle(j)), j);
        });
        const std::size_t left = build(begin, half), right = build(half, end);
        nodes_[index].left = left, nodes_[index].right = right;
        return index;
    }

    Vec3 middle(std::uint32_t t) const { return 0.5 * (boxes_[t].low + boxes_[t].high); }
    bool is_leaf(const Node& node) const { return node.left == node.right; }

    void search_within(std::size_t index) {
        const Node node = nodes_[index];
        if (is_leaf(node)) {
            for (std::size_t i = node.begin; i < node.end; ++i)
                for (std::size_t j = i + 1; j < node.end; ++j) compare(order_[i], order_[j]);
            return;
        }
        search_within(node.left);
        search_within(node.right);
        search_between(node.left, node.right);
    }

    void search_between(std::size_t one, std::size_t two) {
        const Node &a = nodes_[one], &b = nodes_[two];
        if (found_.size() >= limit_ || !overlap(a.box, b.box)) return;
        if (is_leaf(a) && is_leaf(b)) {
            for (std::size_t i = a.begin; i < a.end; ++i)
                for (std::size_t j = b.begin; j < b.end; ++j) compare(order_[i], order_[j]);
        } else if (is_leaf(b) || (!is_leaf(a) && a.end - a.begin >= b.end - b.begin)) {
            search_between(a.left, two);
            search_between(a.right, two);
        } else {
            search_between(one, b.left);
            search_between(one, b.right);
        }
    }

    void compare(std::uint32_t i, std::uint32_t j) {
        if (found_.size() >= limit_ || !overlap(boxes_[i], boxes_[j])) return;
        const Triangle &a = surface_.triangles[i], &b = surface_.triangles[j];
        if (has(b, a[0]) + has(b, a[1]) + has(b, a[2]) > 1) return;   // neighbours across an edge touch there
        auto place = find_side_through(surface_, a, b);
        if (!place) place = find_side_through(surface_, b, a);
        if (place) found_.push_back({std::min(i, j), std::max(i, j), *place});
    }

    const Surface& surface_;
    std::vector<Bounds> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
    std::vector<TrianglePair> found_;
    std::size_t root_ = 0, limit_ = 0;
};

}   // namespace

std::vector<TrianglePair> find_crossing_triangles(const Surface& surface, std::size_t limit) {
    return BoxTree(surface).crossings(limit);
}

}   // namespace patency
