// SPDX-License-Identifier: Apache-2.0
// For tests of neighbours: points, and rows as plain lists. Not for the program.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "patency/search/cells.h"
#include "patency/search/neighbours.h"

namespace patency::testing_rows {

struct Box {
    Vec3 low, high;
};

inline std::vector<Vec3> random_points(const Box& box, std::size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<Vec3> points(count);
    for (Vec3& x : points) {
        const Vec3 side = box.high - box.low;
        x.x = box.low.x + side.x * share(random);
        x.y = box.low.y + side.y * share(random);
        x.z = box.low.z + side.z * share(random);
    }
    return points;
}

inline std::vector<Vec3> taken(const std::vector<Vec3>& points, std::span<const std::uint32_t> order) {
    std::vector<Vec3> result;
    for (const std::uint32_t i : order) result.push_back(points[i]);
    return result;
}

/// Points in cell order, and their cells.
struct Sorted {
    std::vector<Vec3> points;
    Cells cells;
    Sorted(const Frame& frame, double spacing, const std::vector<Vec3>& from) {
        points = taken(from, cells.find_order(frame, spacing, from));
        cells.index(frame, spacing, points);
    }
};

/// The rows as lists, by particle; those without a row are empty. Checks the layout on the way: `dummy_own` pads the
/// members, a short row is padded with its own particle (padding_other == none) or with padding_other.
inline constexpr std::uint32_t none = UINT32_MAX;
inline std::vector<std::vector<std::uint32_t>> rows_of(const Neighbours& rows, std::size_t count,
                                                       std::uint32_t padding_other) {
    std::vector<std::vector<std::uint32_t>> result(count);
    const std::size_t lanes = std::size_t(rows.lanes());
    std::uint32_t members_before = 0;
    std::uint64_t pairs = 0;
    for (std::size_t b = 0; b < rows.block_count(); ++b) {
        const auto& block = rows.block(b);
        EXPECT_EQ(block.first_member, members_before);
        members_before += block.member_count;
        EXPECT_EQ(block.members.size() % lanes, 0u);
        EXPECT_EQ((block.group_start.size() - 1) * lanes, block.members.size());
        EXPECT_LT(block.members.size() - block.member_count, lanes);
        for (std::size_t m = block.member_count; m < block.members.size(); ++m) EXPECT_EQ(block.members[m], count);
        std::uint64_t block_pairs = 0;
        for (std::size_t m = 0; m < block.member_count; ++m) {
            const std::uint32_t i = block.members[m];
            if (i >= count || !result[i].empty()) {
                ADD_FAILURE() << "member " << i << " twice or out of range";
                continue;
            }
            EXPECT_TRUE(m == 0 || i > block.members[m - 1]);
            const std::uint32_t padding = padding_other == none ? i : padding_other;
            bool ended = false;
            for (std::size_t k = block.group_start[m / lanes] + m % lanes; k < block.group_start[m / lanes + 1];
                 k += lanes) {
                const std::uint32_t j = block.entries[k];
                if (j == padding)
                    ended = true;
                else if (ended)
                    ADD_FAILURE() << "neighbour behind the padding of " << i;
                else
                    result[i].push_back(j);
            }
            block_pairs += result[i].size();
        }
        EXPECT_EQ(block.pairs, block_pairs);
        pairs += block_pairs;
    }
    EXPECT_EQ(rows.pair_count(), pairs);
    EXPECT_EQ(rows.member_count(), members_before);
    return result;
}

}   // namespace patency::testing_rows
