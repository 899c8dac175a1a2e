// SPDX-License-Identifier: Apache-2.0
// Points of any spacing in an order that keeps neighbours near in memory, and the search for all points around a place.
// Knows positions only; particles of one spacing that move have search/cells.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patency/shape/signed_distance.h"

namespace patency {

/// The permutation that halves the points again and again across the longest side of their box: any run of them is compact.
/// Ties go by index: one order for any number of threads.
std::vector<std::uint32_t> find_compact_order(std::span<const Vec3> points);

/// Boxes around halves of halves of points that stand in compact order. The points must stay.
class PointTree {
public:
    explicit PointTree(std::span<const Vec3> points);

    /// Appends the points with |x_j - x| < radius to `found`, in rising order.
    void find(const Vec3& x, double radius, std::vector<std::uint32_t>& found) const;

private:
    static constexpr std::size_t leaf = 8;
    void build(std::size_t node, std::size_t begin, std::size_t end);

    std::span<const Vec3> points_;
    std::vector<Bounds> boxes_;   // node n has the halves 2n + 1 and 2n + 2
};

}   // namespace patency
