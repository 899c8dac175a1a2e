// SPDX-License-Identifier: Apache-2.0
// A tree of boxes around the triangles of a surface, and the distance to the nearest one by it. Crossing triangles are
// triangle_pairs.h's.
#pragma once

#include <cstdint>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

/// Each node halves its triangles along the longest axis of their centres; node 0 is the root. The surface must stay.
class TriangleTree {
public:
    struct Node {
        Bounds box;
        std::uint32_t begin, end;    ///< of the order
        std::uint32_t left, right;   ///< nodes; equal in a leaf

        bool is_leaf() const { return left == right; }
    };

    static constexpr std::uint32_t leaf_size =
        4;   ///< triangles at most: fewer make the tree deep, more are compared in vain

    explicit TriangleTree(const Surface& surface);

    const std::vector<Node>& nodes() const { return nodes_; }            ///< none if there is no triangle
    const std::vector<std::uint32_t>& order() const { return order_; }   ///< triangles, those of a leaf side by side
    const Bounds& box(std::uint32_t triangle) const { return boxes_[triangle]; }

    struct Nearest {
        double square;   ///< of the distance [m^2]
        Vec3 place;      ///< on the surface
    };
    /// The place nearest to x, if the square of its distance is less than `bound` [m^2]; otherwise that bound and some place.
    /// The nearer the bound to the answer, the sooner it is found. There must be a triangle.
    Nearest nearest(const Vec3& x, double bound) const;
    double square_distance(const Vec3& x, double bound) const { return nearest(x, bound).square; }

    /// Appends to `found` the triangles that may be nearer than `place` is to some point within `radius` [m] of x.
    void find_rivals(const Vec3& place, const Vec3& x, double radius, std::vector<std::uint32_t>& found) const;

private:
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);

    const Surface& surface_;
    std::vector<Bounds> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

/// The place of the triangle abc nearest to x.
Vec3 nearest_place(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

}   // namespace patency
