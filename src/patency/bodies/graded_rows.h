// SPDX-License-Identifier: Apache-2.0
// Neighbours of points that each have a spacing of their own. Private to graded_points.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patency/base/vec.h"

namespace patency {

/// Rows of all neighbours within `reach` mean spacings of a pair. Points that follow each other should lie close together.
class GradedRows {
public:
    static constexpr std::size_t group_size = 16, lanes = 8;

    /// The same for any number of threads. Rows are padded to whole lanes with the number of points.
    void find(std::span<const Vec3> points, std::span<const double> spacing, double reach);

    std::span<const std::uint32_t> row(std::size_t i) const {
        const Group& group = groups_[i / group_size];
        const std::uint32_t* start = &group.start[i % group_size];
        return {group.neighbours.data() + start[0], start[1] - start[0]};
    }

private:
    struct Node {   // of consecutive points
        Vec3 low, high;
        double largest;   // spacing
    };
    struct Group {
        std::uint32_t start[group_size + 1];
        std::vector<std::uint32_t> neighbours;
    };
    static constexpr std::size_t fan = 4;   // nodes under one

    std::vector<std::vector<Node>> levels_;   // groups first
    std::vector<Group> groups_;
};

}   // namespace patency
