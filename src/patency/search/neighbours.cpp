// SPDX-License-Identifier: Apache-2.0
#include "patency/search/neighbours.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "patency/base/pack.h"
#include "patency/base/parallel.h"
#include "patency/base/select.h"

namespace patency {

namespace {

constexpr std::size_t particles_per_block = 512;   // a multiple of every lane count
constexpr std::size_t chunk = 16;                  // consecutive particles that share their candidates
constexpr std::size_t seekers_at_once = 4;
// Candidates are tested in float; pairs this much beyond reach are kept, where the kernel is zero anyway.
constexpr float reach_margin = 1.0001f;
constexpr float infinity = std::numeric_limits<float>::infinity();

using Floats = Pack<float>;
using Indices = Pack<std::uint32_t>;
constexpr std::size_t width = std::size_t(Floats::lanes);

/// Candidates of one chunk: indices in rising order, and positions relative to the chunk's first particle, in quanta.
struct Candidates {
    std::vector<std::uint32_t> index;
    std::vector<float> x, y, z;
    std::size_t count = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        runs;   // of particles in memory, where the candidates are looked for

    void reserve(std::size_t n) {
        if (index.size() >= n + width) return;
        const std::size_t size = 2 * n + 1024;
        index.resize(size), x.resize(size), y.resize(size), z.resize(size);
    }
    /// Fills the last pack with what is nobody and never near.
    void finish() {
        reserve(count);
        for (std::size_t k = count; k < count + width; ++k) index[k] = UINT32_MAX, x[k] = infinity, y[k] = z[k] = 0;
    }
    /// The place of the first one that is not before particle i.
    std::size_t find(std::uint32_t i) const {
        return std::size_t(std::lower_bound(index.begin(), index.begin() + std::ptrdiff_t(count), i) - index.begin());
    }
};

struct Box {
    std::array<float, 3> low, high;   // of a chunk, relative to its first particle
};

float relative(std::int32_t a, std::int32_t reference) {   // wraps, for periodic frames
    return float(std::int32_t(std::uint32_t(a) - std::uint32_t(reference)));
}

/// Appends those particles of [begin, end) that lie within reach of the box.
void collect(const Cells& cells, std::uint32_t begin, std::uint32_t end, const std::array<std::int32_t, 3>& reference,
             const Box& box, float reach2, Candidates& out) {
    out.reserve(out.count + (end - begin));
    const auto gap = [&](std::size_t k, Floats d) {
        return max(max(Floats(box.low[k]) - d, d - Floats(box.high[k])), Floats(0));
    };
    const std::int32_t *x = cells.coordinate(0).data(), *y = cells.coordinate(1).data(),
                       *z = cells.coordinate(2).data();
    std::size_t count = out.count;
    for (std::uint32_t j = begin; j < end; j += std::uint32_t(width)) {
        const Floats dx = load_difference<Floats::lanes>(x + j, reference[0]);
        const Floats dy = load_difference<Floats::lanes>(y + j, reference[1]);
        const Floats dz = load_difference<Floats::lanes>(z + j, reference[2]);
        const Floats gx = gap(0, dx), gy = gap(1, dy), gz = gap(2, dz);
        const Floats r2 = fma(gz, gz, fma(gy, gy, gx * gx));
        const std::uint32_t near = lanes_below(r2, Floats(reach2)) & first_lanes(end - j);
        store_chosen(dx, near, &out.x[count]);
        store_chosen(dy, near, &out.y[count]);
        store_chosen(dz, near, &out.z[count]);
        count += store_chosen(count_from<Floats::lanes>(j), near, &out.index[count]);
    }
    out.count = count;
}

/// A particle that looks for its row.
struct Seeker {
    std::array<float, 3> at{};   // relative to the chunk's reference
    std::size_t self = 0;        // its place among the candidates, itself left out; their number if it is none of them
    std::vector<std::uint32_t> row;   // with room for all candidates and a pack more
    std::size_t length = 0;           // of the row
};

/// Writes the candidates within reach of each seeker to its row. Several at once, for the candidates are loaded but once.
void select(const Candidates& from, float reach2, std::array<Seeker, seekers_at_once>& seekers) {
    std::array<std::size_t, seekers_at_once> count{};
    std::array<std::uint32_t*, seekers_at_once> row;
    for (std::size_t s = 0; s < seekers_at_once; ++s) row[s] = seekers[s].row.data();
    for (std::size_t k = 0; k < from.count; k += width) {
        const Floats x = Floats::load(&from.x[k]), y = Floats::load(&from.y[k]), z = Floats::load(&from.z[k]);
        const Indices index = Indices::load(&from.index[k]);
        for (std::size_t s = 0; s < seekers_at_once; ++s) {
            const Floats dx = x - seekers[s].at[0], dy = y - seekers[s].at[1], dz = z - seekers[s].at[2];
            const Floats r2 = fma(dz, dz, fma(dy, dy, dx * dx));
            const std::uint32_t itself =
                std::uint32_t(std::uint64_t(1) << std::min<std::size_t>(seekers[s].self - k, 63));
            count[s] += store_chosen(index, lanes_below(r2, Floats(reach2)) & ~itself, row[s] + count[s]);
        }
    }
    for (std::size_t s = 0; s < seekers_at_once; ++s) seekers[s].length = count[s];
}

/// The group that is being filled: rows each by itself, one per lane.
struct OpenGroup {
    std::vector<std::vector<std::uint32_t>> rows;
    std::vector<std::size_t> lengths;
    std::vector<std::uint32_t> members;
};

/// Of the particles [begin, end), around the first of them, the reference.
Box box_around(const Cells& own, std::size_t begin, std::size_t end, const std::array<std::int32_t, 3>& reference) {
    Box box{{0, 0, 0}, {0, 0, 0}};
    for (std::size_t i = begin; i < end; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const float d = relative(own.coordinate(int(k))[i], reference[k]);
            box.low[k] = std::min(box.low[k], d);
            box.high[k] = std::max(box.high[k], d);
        }
    return box;
}

/// Whether differences to the box around a chunk may wrap in a periodic frame, along whatever axis: a chunk spread over
/// half a period would see particles behind it before it.
bool wraps(const Frame& frame, const Box& box, float reach) {
    constexpr float half = 2147483648.0f, margin = 1.001f;   // of rounding in float
    const auto wide = [&](std::size_t k) { return margin * (std::max(-box.low[k], box.high[k]) + reach) >= half; };
    return frame.any_periodic() && (wide(0) || wide(1) || wide(2));
}

void collect_chunk(const Frame& frame, const Box& box, const Cells& other, std::int64_t reach, float reach2,
                   const std::array<std::int32_t, 3>& reference, Candidates& out) {
    std::array<std::int64_t, 3> low, high;
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::int64_t(reference[k]) + std::int64_t(box.low[k]) - 1;
        high[k] = std::int64_t(reference[k]) + std::int64_t(box.high[k]) + 1;
    }
    out.count = 0;
    out.runs.clear();
    const auto visit = [&](std::uint32_t b, std::uint32_t e) { out.runs.emplace_back(b, e); };
    // The images of the chunk that may see particles on the far side of a periodic box.
    std::array<std::int64_t, 3> from{}, to{};
    constexpr std::int64_t turn = std::int64_t(1) << 32, half = turn / 2;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!frame.periodic()[std::size_t(frame.axes()[k])]) continue;
        if (low[k] - reach < -half) to[k] = 1;
        if (high[k] + reach >= half) from[k] = -1;
    }
    for (std::int64_t c = from[2]; c <= to[2]; ++c)
        for (std::int64_t b = from[1]; b <= to[1]; ++b)
            for (std::int64_t a = from[0]; a <= to[0]; ++a)
                other.for_each_run({low[0] + a * turn, low[1] + b * turn, low[2] + c * turn},
                                   {high[0] + a * turn, high[1] + b * turn, high[2] + c * turn}, reach, visit);
    std::uint32_t done = 0;   // runs of different images may overlap, where the box is a few columns wide
    if (from != to) std::sort(out.runs.begin(), out.runs.end());
    for (const auto& [first, last] : out.runs) {
        if (last <= done) continue;
        collect(other, std::max(first, done), last, reference, box, reach2, out);
        done = last;
    }
    out.finish();
}

/// Appends the group to the block, its rows side by side, and empties it. A short row over the own body is padded with
/// the particle itself, whose differences all vanish; one over another body with that body's dummy, far away.
void close(OpenGroup& group, std::uint32_t dummy_own, std::uint32_t dummy_other, bool same, Neighbours::Block& block) {
    const std::size_t lanes = group.rows.size(), live = group.members.size();
    group.members.resize(lanes, dummy_own);
    std::fill(group.lengths.begin() + std::ptrdiff_t(live), group.lengths.end(), 0);
    const std::size_t longest = *std::max_element(group.lengths.begin(), group.lengths.end());
    for (std::size_t l = 0; l < lanes; ++l) {
        auto& row = group.rows[l];
        if (row.size() < longest + 3) row.resize(longest + 3);
        std::fill(row.begin() + std::ptrdiff_t(group.lengths[l]), row.begin() + std::ptrdiff_t(longest),
                  same ? group.members[l] : dummy_other);
        block.pairs += group.lengths[l];
    }
    const std::size_t filled = block.group_start.back();
    block.entries.extend(filled + (longest + 3) * lanes);
    store_side_by_side(group.rows, longest, &block.entries[filled]);
    block.entries.extend(filled + longest * lanes);
    block.group_start.push_back(std::uint32_t(filled + longest * lanes));
    block.members.insert(block.members.end(), group.members.begin(), group.members.end());
    block.member_count += std::uint32_t(live);
    group.members.clear();
}

}   // namespace

void Neighbours::find_own(const Frame& frame, const Cells& cells, double reach, int lanes) {
    find(frame, cells, cells, reach, lanes, true);
}

void Neighbours::find_other(const Frame& frame, const Cells& own, const Cells& other, double reach, int lanes) {
    find(frame, own, other, reach, lanes, false);
}

void Neighbours::find(const Frame& frame, const Cells& own, const Cells& other, double reach, int lanes, bool same) {
    lanes_ = lanes;
    const std::size_t count = own.size();
    block_count_ = (count + particles_per_block - 1) / particles_per_block;
    if (blocks_.size() < block_count_) blocks_.resize(block_count_);
    const float reach_quanta = float(reach / frame.quantum()) * reach_margin, reach2 = reach_quanta * reach_quanta;
    const std::int64_t reach_integer = std::int64_t(reach_quanta) + 1;
    Shares shares(block_count_);
#pragma omp parallel
    {
        Candidates candidates;
        std::array<Seeker, seekers_at_once> seekers;
        OpenGroup group;
        group.rows.resize(std::size_t(lanes));
        group.lengths.resize(std::size_t(lanes));
        for (const std::size_t b : shares.of_this_thread()) {
            Block block =
                std::move(blocks_[b]);   // with its storage; aside, because blocks of other threads are close by
            block.members.clear();
            block.group_start.assign(1, 0);
            block.entries.reset(0);
            block.member_count = 0, block.pairs = 0;
            const auto close_group = [&] {
                close(group, std::uint32_t(count), std::uint32_t(other.size()), same, block);
            };
            const std::size_t first = b * particles_per_block, last = std::min(count, first + particles_per_block);
            for (std::size_t begin = first, end = first; begin < last; begin = end) {
                end = std::min(last, begin + chunk);
                const std::array<std::int32_t, 3> reference{own.coordinate(0)[begin], own.coordinate(1)[begin],
                                                            own.coordinate(2)[begin]};
                Box box = box_around(own, begin, end, reference);
                while (end > begin + 1 && wraps(frame, box, reach_quanta)) {
                    end = begin + (end - begin) / 2;
                    box = box_around(own, begin, end, reference);
                }
                collect_chunk(frame, box, other, reach_integer, reach2, reference, candidates);
                std::size_t self = candidates.find(std::uint32_t(begin));
                for (std::size_t i = begin; i < end; i += seekers_at_once) {
                    for (std::size_t s = 0; s < seekers_at_once; ++s) {
                        const std::size_t who = std::min(i + s, end - 1);   // the last one may be there twice
                        for (std::size_t k = 0; k < 3; ++k)
                            seekers[s].at[k] = relative(own.coordinate(int(k))[who], reference[k]);
                        seekers[s].self = same && candidates.index[self] == who ? self++ : candidates.count;
                        if (seekers[s].row.size() < candidates.count + width)
                            seekers[s].row.resize(candidates.count + width);
                    }
                    select(candidates, reach2, seekers);
                    for (std::size_t s = 0; s < seekers_at_once && i + s < end; ++s) {
                        if (!same && seekers[s].length == 0) continue;
                        const std::size_t place = group.members.size();
                        std::swap(group.rows[place], seekers[s].row);
                        group.lengths[place] = seekers[s].length;
                        group.members.push_back(std::uint32_t(i + s));
                        if (group.members.size() == std::size_t(lanes)) close_group();
                    }
                }
            }
            if (!group.members.empty()) close_group();
            blocks_[b] = std::move(block);
        }
    }
    std::uint32_t members = 0;
    for (std::size_t b = 0; b < block_count_; ++b) {
        blocks_[b].first_member = members;
        members += blocks_[b].member_count;
    }
}

std::uint64_t Neighbours::pair_count() const {
    std::uint64_t pairs = 0;
    for (std::size_t b = 0; b < block_count_; ++b) pairs += blocks_[b].pairs;
    return pairs;
}

std::size_t Neighbours::member_count() const {
    return block_count_ == 0 ? 0 : blocks_[block_count_ - 1].first_member + blocks_[block_count_ - 1].member_count;
}

}   // namespace patency
