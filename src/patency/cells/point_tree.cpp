// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/point_tree.h"

#include <algorithm>
#include <numeric>

namespace patency {

namespace {

/// Where a run of points is halved: at a whole number of leaves, so that both find and build go the same way.
std::size_t middle_of(std::size_t begin, std::size_t end) { return begin + (end - begin + 1) / 2; }

Bounds box_around(std::span<const Vec3> points) {
    Bounds box{points[0], points[0]};
    for (const Vec3& x : points) box = joined(box, {x, x});
    return box;
}

double square_to(const Bounds& box, const Vec3& x) {
    const auto beyond = [](double low, double high, double at) { return std::max({low - at, at - high, 0.0}); };
    const Vec3 d{beyond(box.low.x, box.high.x, x.x), beyond(box.low.y, box.high.y, x.y),
                 beyond(box.low.z, box.high.z, x.z)};
    return dot(d, d);
}

void halve(std::span<const Vec3> points, std::span<std::uint32_t> order) {
    if (order.size() <= 2) return;
    Bounds box{points[order[0]], points[order[0]]};
    for (const std::uint32_t i : order) box = joined(box, {points[i], points[i]});
    const Vec3 size = box.high - box.low;
    const auto along = [&](std::uint32_t i) {
        const Vec3& x = points[i];
        return size.x >= size.y && size.x >= size.z ? x.x : size.y >= size.z ? x.y : x.z;
    };
    const std::size_t middle = middle_of(0, order.size());
    std::nth_element(order.begin(), order.begin() + std::ptrdiff_t(middle), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double u = along(a), v = along(b);
                         return u != v ? u < v : a < b;
                     });
    halve(points, order.first(middle));
    halve(points, order.subspan(middle));
}

}   // namespace

std::vector<std::uint32_t> find_compact_order(std::span<const Vec3> points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    halve(points, order);
    return order;
}

PointTree::PointTree(std::span<const Vec3> points) : points_(points) {
    if (!points.empty()) build(0, 0, points.size());
}

void PointTree::build(std::size_t node, std::size_t begin, std::size_t end) {
    if (boxes_.size() <= node) boxes_.resize(node + 1);
    boxes_[node] = box_around(points_.subspan(begin, end - begin));
    if (end - begin <= leaf) return;
    const std::size_t middle = middle_of(begin, end);
    build(2 * node + 1, begin, middle);
    build(2 * node + 2, middle, end);
}

void PointTree::find(const Vec3& x, double radius, std::vector<std::uint32_t>& found) const {
    if (points_.empty()) return;
    struct Waiting {
        std::size_t node, begin, end;
    };
    Waiting waiting[64];   // at most one more than the tree is deep
    std::size_t count = 0;
    const double square = radius * radius;
    waiting[count++] = {0, 0, points_.size()};
    while (count > 0) {
        const auto [node, begin, end] = waiting[--count];
        if (square_to(boxes_[node], x) >= square) continue;
        if (end - begin > leaf) {
            const std::size_t middle = middle_of(begin, end);
            waiting[count++] = {2 * node + 2, middle, end};
            waiting[count++] = {2 * node + 1, begin, middle};
            continue;
        }
        for (std::size_t j = begin; j < end; ++j)
            if (const Vec3 e = points_[j] - x; dot(e, e) < square) found.push_back(std::uint32_t(j));
    }
}

}   // namespace patency
