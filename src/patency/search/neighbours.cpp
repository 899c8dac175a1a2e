// SPDX-License-Identifier: Apache-2.0
#include "patency/search/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace patency {

namespace {

constexpr std::size_t particles_per_block = 512;   // a multiple of every lane count
constexpr std::size_t chunk = 16;                  // consecutive particles that share their candidates
// Candidates are tested in float; pairs this much beyond reach are kept, where the kernel is zero anyway.
constexpr float reach_margin = 1.0001f;

/// Candidates of one chunk: indices, and positions relative to the chunk's first particle, in quanta.
struct Candidates {
    std::vector<std::uint32_t> index;
    std::vector<float> x, y, z;
    std::size_t count = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> runs;   // of particles in memory, where the candidates are looked for

    void reserve(std::size_t n) {
        if (index.size() >= n + 32) return;
        const std::size_t size = 2 * n + 1024;
        index.resize(size), x.resize(size), y.resize(size), z.resize(size);
    }
};

struct Box {
    std::array<float, 3> low, high;   // of a chunk, relative to its first particle
};

float relative(std::int32_t a, std::int32_t reference) {   // wraps, for periodic frames
    return float(std::int32_t(std::uint32_t(a) - std::uint32_t(reference)));
}

#if defined(__AVX512F__)

__m512 relative(const std::int32_t* a, std::int32_t reference) {
    return _mm512_cvtepi32_ps(_mm512_sub_epi32(_mm512_loadu_si512(a), _mm512_set1_epi32(reference)));
}

/// Appends those particles of [begin, end) that lie within reach of the box.
void collect(const Cells& cells, std::uint32_t begin, std::uint32_t end, const std::array<std::int32_t, 3>& reference,
             const Box& box, float reach2, Candidates& out) {
    out.reserve(out.count + (end - begin));
    const __m512 zero = _mm512_setzero_ps();
    const __m512i ramp = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (std::uint32_t j = begin; j < end; j += 16) {
        __m512 d[3], r2 = zero;
        for (std::size_t k = 0; k < 3; ++k) {
            d[k] = relative(&cells.coordinate(int(k))[j], reference[k]);
            const __m512 gap = _mm512_max_ps(_mm512_max_ps(_mm512_sub_ps(_mm512_set1_ps(box.low[k]), d[k]),
                                                           _mm512_sub_ps(d[k], _mm512_set1_ps(box.high[k]))), zero);
            r2 = _mm512_fmadd_ps(gap, gap, r2);
        }
        const __mmask16 live = end - j >= 16 ? __mmask16(0xffff) : __mmask16((1u << (end - j)) - 1);
        const __mmask16 near = _mm512_mask_cmp_ps_mask(live, r2, _mm512_set1_ps(reach2), _CMP_LT_OQ);
        _mm512_storeu_si512(&out.index[out.count], _mm512_maskz_compress_epi32(near, _mm512_add_epi32(ramp, _mm512_set1_epi32(int(j)))));
        _mm512_storeu_ps(&out.x[out.count], _mm512_maskz_compress_ps(near, d[0]));
        _mm512_storeu_ps(&out.y[out.count], _mm512_maskz_compress_ps(near, d[1]));
        _mm512_storeu_ps(&out.z[out.count], _mm512_maskz_compress_ps(near, d[2]));
        out.count += std::size_t(__builtin_popcount(near));
    }
}

/// Writes the candidates within reach of the particle to row, itself left out; returns how many.
std::size_t select(const Candidates& from, float x, float y, float z, std::uint32_t self, float reach2, std::uint32_t* row) {
    std::size_t count = 0;
    const __m512 px = _mm512_set1_ps(x), py = _mm512_set1_ps(y), pz = _mm512_set1_ps(z), limit = _mm512_set1_ps(reach2);
    const __m512i own = _mm512_set1_epi32(int(self));
    for (std::size_t k = 0; k < from.count; k += 16) {
        const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(&from.x[k]), px), dy = _mm512_sub_ps(_mm512_loadu_ps(&from.y[k]), py),
                     dz = _mm512_sub_ps(_mm512_loadu_ps(&from.z[k]), pz);
        const __m512 r2 = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
        const __m512i j = _mm512_loadu_si512(&from.index[k]);
        const __mmask16 live = from.count - k >= 16 ? __mmask16(0xffff) : __mmask16((1u << (from.count - k)) - 1);
        const __mmask16 near = _mm512_mask_cmpneq_epi32_mask(_mm512_mask_cmp_ps_mask(live, r2, limit, _CMP_LT_OQ), j, own);
        _mm512_storeu_si512(row + count, _mm512_maskz_compress_epi32(near, j));
        count += std::size_t(__builtin_popcount(near));
    }
    return count;
}

#else

void collect(const Cells& cells, std::uint32_t begin, std::uint32_t end, const std::array<std::int32_t, 3>& reference,
             const Box& box, float reach2, Candidates& out) {
    out.reserve(out.count + (end - begin));
    for (std::uint32_t j = begin; j < end; ++j) {
        std::array<float, 3> d;
        float r2 = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            d[k] = relative(cells.coordinate(int(k))[j], reference[k]);
            const float gap = std::max(std::max(box.low[k] - d[k], d[k] - box.high[k]), 0.0f);
            r2 = std::fma(gap, gap, r2);
        }
        out.index[out.count] = j;
        out.x[out.count] = d[0], out.y[out.count] = d[1], out.z[out.count] = d[2];
        out.count += r2 < reach2;   // without a branch: overwritten unless near
    }
}

std::size_t select(const Candidates& from, float x, float y, float z, std::uint32_t self, float reach2, std::uint32_t* row) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < from.count; ++k) {
        const float dx = from.x[k] - x, dy = from.y[k] - y, dz = from.z[k] - z;
        const float r2 = std::fma(dz, dz, std::fma(dy, dy, dx * dx));
        row[count] = from.index[k];
        count += r2 < reach2 && from.index[k] != self;
    }
    return count;
}

#endif

/// What one thread needs while it fills a block.
struct Workspace {
    Candidates candidates;
    std::vector<std::uint32_t> row_entries;                    // rows one after another
    std::array<std::uint32_t, particles_per_block + 1> row_start;
    std::vector<std::uint32_t> rows;                           // of members, as indices into row_start
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
}

/// Puts the rows of the block's members side by side, `lanes` at a time.
/// A short row over the own body is padded with the particle itself, whose differences all vanish; one over another body
/// with that body's dummy, far away.
void interleave(const Workspace& work, std::size_t first, std::uint32_t dummy_own, std::uint32_t dummy_other, bool same,
                std::size_t lanes, Neighbours::Block& block) {
    const std::size_t members = work.rows.size(), groups = (members + lanes - 1) / lanes;
    const auto length = [&](std::size_t m) {
        return m < members ? work.row_start[work.rows[m] + 1] - work.row_start[work.rows[m]] : 0u;
    };
    block.members.resize(groups * lanes);
    block.group_start.resize(groups + 1);
    std::size_t total = 0;
    for (std::size_t g = 0; g < groups; ++g) {
        std::uint32_t longest = 0;
        for (std::size_t l = 0; l < lanes; ++l) longest = std::max(longest, length(g * lanes + l));
        block.group_start[g] = std::uint32_t(total);
        total += longest * lanes;
    }
    block.group_start[groups] = std::uint32_t(total);
    block.entries.reset(total);
    block.pairs = 0;
    for (std::size_t g = 0; g < groups; ++g) {
        std::uint32_t* out = block.entries.data() + block.group_start[g];
        const std::size_t longest = (block.group_start[g + 1] - block.group_start[g]) / lanes;
        for (std::size_t l = 0; l < lanes; ++l) {
            const std::size_t m = g * lanes + l;
            block.members[m] = m < members ? std::uint32_t(first + work.rows[m]) : dummy_own;
            const std::size_t n = length(m);
            const std::uint32_t* row = m < members ? &work.row_entries[work.row_start[work.rows[m]]] : nullptr;
            for (std::size_t k = 0; k < n; ++k) out[k * lanes + l] = row[k];
            const std::uint32_t padding = same ? block.members[m] : dummy_other;
            for (std::size_t k = n; k < longest; ++k) out[k * lanes + l] = padding;
            block.pairs += n;
        }
    }
    block.member_count = std::uint32_t(members);
}

}  // namespace

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
#pragma omp parallel
    {
        Workspace work;
#pragma omp for schedule(dynamic, 1)
        for (std::size_t b = 0; b < block_count_; ++b) {
            const std::size_t first = b * particles_per_block, last = std::min(count, first + particles_per_block);
            work.rows.clear();
            std::size_t filled = 0;
            for (std::size_t begin = first, end = first; begin < last; begin = end) {
                end = std::min(last, begin + chunk);
                const std::array<std::int32_t, 3> reference{own.coordinate(0)[begin], own.coordinate(1)[begin],
                                                            own.coordinate(2)[begin]};
                Box box = box_around(own, begin, end, reference);
                while (end > begin + 1 && wraps(frame, box, reach_quanta)) {
                    end = begin + (end - begin) / 2;
                    box = box_around(own, begin, end, reference);
                }
                collect_chunk(frame, box, other, reach_integer, reach2, reference, work.candidates);
                for (std::size_t i = begin; i < end; ++i) {
                    if (work.row_entries.size() < filled + work.candidates.count + 32)
                        work.row_entries.resize(2 * (filled + work.candidates.count) + 65536);
                    const std::size_t n = select(work.candidates, relative(own.coordinate(0)[i], reference[0]),
                                                 relative(own.coordinate(1)[i], reference[1]),
                                                 relative(own.coordinate(2)[i], reference[2]),
                                                 same ? std::uint32_t(i) : UINT32_MAX, reach2, &work.row_entries[filled]);
                    work.row_start[i - first] = std::uint32_t(filled);
                    filled += n;
                    if (same || n > 0) work.rows.push_back(std::uint32_t(i - first));
                }
            }
            work.row_start[last - first] = std::uint32_t(filled);
            interleave(work, first, std::uint32_t(count), std::uint32_t(other.size()), same, std::size_t(lanes), blocks_[b]);
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

}  // namespace patency
