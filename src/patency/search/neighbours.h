// SPDX-License-Identifier: Apache-2.0
// Rows of neighbours, laid out for packs (SELL): the particles of a group of `lanes` have their k-th neighbours side by
// side, short rows are padded with terms that vanish. Every row is in rising order, whatever the lanes.
#pragma once

#include <cstdint>
#include <vector>

#include "patency/base/aligned.h"
#include "patency/search/cells.h"

namespace patency {

/// Rows of the particles of one body over those of the same or another body.
class Neighbours {
public:
    /// Particles that are found and sorted together; a task of the pair loop.
    struct Block {
        std::vector<std::uint32_t> members;       ///< particles that have a row, padded to whole groups with the dummy
        std::vector<std::uint32_t> group_start;   ///< first entry of each group, and the end
        AlignedVector<std::uint32_t> entries;     ///< indices of neighbours, `lanes` side by side
        std::uint32_t first_member = 0;           ///< number of members in earlier blocks
        std::uint32_t member_count = 0;           ///< without padding
        std::uint64_t pairs = 0;
    };

    /// Rows over the own body: every particle has one, itself left out. `reach` [m] is the largest distance.
    void find_own(const Frame& frame, const Cells& cells, double reach, int lanes);
    /// Rows over another body, only of particles that have neighbours there, packed in groups of their own.
    void find_other(const Frame& frame, const Cells& own, const Cells& other, double reach, int lanes);

    int lanes() const { return lanes_; }
    std::size_t block_count() const { return block_count_; }
    const Block& block(std::size_t b) const { return blocks_[b]; }
    std::uint64_t pair_count() const;
    std::size_t member_count() const;

private:
    void find(const Frame& frame, const Cells& own, const Cells& other, double reach, int lanes, bool same);

    std::vector<Block> blocks_;   // kept between calls, with their storage
    std::size_t block_count_ = 0;
    int lanes_ = 1;
};

}   // namespace patency
