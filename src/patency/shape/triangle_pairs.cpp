// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/triangle_pairs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "patency/shape/surface_repair.h"
#include "patency/shape/triangle_tree.h"

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

/// Over the plane of t, the farthest of the triangle's points; infinite if t has no plane.
double farthest_from_plane(const Surface& surface, const Triangle& t, const Triangle& other) {
    const Vec3 &a = surface.points[t[0]], n = area_vector(surface, t);
    double farthest = 0;
    for (const std::uint32_t point : other)
        farthest = std::max(farthest, std::abs(dot(n, surface.points[point] - a)) / norm(n));
    return std::isfinite(farthest) ? farthest : Bounds::infinity;
}

/// How far two triangles in one plane would have to be moved apart: the least overlap of their shadows on the lines
/// across their sides. At most 0 if they only touch, and less than the height of the flatter one.
double overlap_in_plane(const Surface& surface, const Triangle& a, const Triangle& b) {
    double least = Bounds::infinity;
    for (const auto& [own, normal] : {std::pair(&a, area_vector(surface, a)), {&b, area_vector(surface, b)}})
        for (int side = 0; side < 3; ++side) {
            const Vec3 across =
                normalized(cross(normal, surface.points[(*own)[(side + 1) % 3]] - surface.points[(*own)[side]]));
            double low[2], high[2];
            for (int k = 0; k < 2; ++k) {
                low[k] = Bounds::infinity, high[k] = -Bounds::infinity;
                for (const std::uint32_t point : k == 0 ? a : b) {
                    const double x = dot(surface.points[point] - surface.points[a[0]], across);
                    low[k] = std::min(low[k], x), high[k] = std::max(high[k], x);
                }
            }
            least = std::min(least, std::min(high[0], high[1]) - std::max(low[0], low[1]));
        }
    return least;
}

/// A place where two triangles in one plane lie on each other, both within the tolerance [m].
std::optional<Vec3> find_overlap(const Surface& surface, const Triangle& a, const Triangle& b, double tolerance) {
    if (farthest_from_plane(surface, a, b) > tolerance || farthest_from_plane(surface, b, a) > tolerance) return {};
    if (!(overlap_in_plane(surface, a, b) > tolerance)) return {};
    return 0.5 * (centroid(surface, a) + centroid(surface, b));
}

/// The search for pairs in a tree of boxes.
class Crossings {
public:
    explicit Crossings(const Surface& surface)
        : surface_(surface),
          tree_(surface),
          nodes_(tree_.nodes()),
          order_(tree_.order()),
          tolerance_(same_place_tolerance(surface)) {}

    std::vector<TrianglePair> find(std::size_t limit) {
        limit_ = limit;
        if (!nodes_.empty()) search_within(0);
        std::sort(found_.begin(), found_.end(),
                  [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
        return std::move(found_);
    }

private:
    using Node = TriangleTree::Node;

    void search_within(std::size_t index) {
        const Node& node = nodes_[index];
        if (node.is_leaf()) {
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
        if (a.is_leaf() && b.is_leaf()) {
            for (std::size_t i = a.begin; i < a.end; ++i)
                for (std::size_t j = b.begin; j < b.end; ++j) compare(order_[i], order_[j]);
        } else if (b.is_leaf() || (!a.is_leaf() && a.end - a.begin >= b.end - b.begin)) {
            search_between(a.left, two);
            search_between(a.right, two);
        } else {
            search_between(one, b.left);
            search_between(one, b.right);
        }
    }

    void compare(std::uint32_t i, std::uint32_t j) {
        if (found_.size() >= limit_ || !overlap(tree_.box(i), tree_.box(j))) return;
        const Triangle &a = surface_.triangles[i], &b = surface_.triangles[j];
        const int shared = has(b, a[0]) + has(b, a[1]) + has(b, a[2]);
        std::optional<Vec3> place;
        if (shared <= 1) place = find_side_through(surface_, a, b);   // neighbours across an edge touch there
        if (shared <= 1 && !place) place = find_side_through(surface_, b, a);
        if (shared <= 2 && !place) place = find_overlap(surface_, a, b, tolerance_);
        if (place) found_.push_back({std::min(i, j), std::max(i, j), *place});
    }

    const Surface& surface_;
    const TriangleTree tree_;
    const std::vector<Node>& nodes_;
    const std::vector<std::uint32_t>& order_;
    const double tolerance_;   // m: files round places in one plane by less
    std::vector<TrianglePair> found_;
    std::size_t limit_ = 0;
};

}   // namespace

std::vector<TrianglePair> find_crossing_triangles(const Surface& surface, std::size_t limit) {
    return Crossings(surface).find(limit);
}

}   // namespace patency
