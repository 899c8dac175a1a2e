// SPDX-License-Identifier: Apache-2.0
// THE loop over neighbours: every particle gathers a sum over its own full row, a pack of particles side by side. No
// races, and the same bits for any number of threads and lanes, because each lane adds in the order of its row.
//
// A term is a small functor of numbers; it sees one pair (or a pack of pairs) and adds to a few sums:
//
//     struct Gradient {
//         static constexpr int own_extras = 0, extras = 0, sums = 3;   // further quads of i and of j, numbers summed
//         template <class P> void operator()(const Pair<P>& pair, const Sample<P, 0>& i, const Sample<P, 0>& j,
//                                            std::array<P, 3>& sum) const { ... }
//     };
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "patency/base/aligned.h"
#include "patency/base/pack.h"
#include "patency/base/parallel.h"
#include "patency/base/vec.h"
#include "patency/search/neighbours.h"

namespace patency {

/// The geometry of a pair seen from i, in the loop's own unit of length (see PairLoop::unit).
template <class P>
struct Pair {
    Vec<P> d;   ///< x_i - x_j
    P r;        ///< |d|
    P t;        ///< max(0, 1 - r/(2h)): W = sigma t^4 (5 - 4t), dW/dr = -slope r t^3     THEORY.md (1.1)
};

/// What a term sees of one particle: the fourth number of its geometry quad, and `extras` further quads.
template <class P, int extras>
struct Sample {
    P value;
    std::array<Quads<P>, std::size_t(extras)> extra;
};

/// The records of one body: quads (x, y, z, value) and further quads, all with a dummy at the end.
template <class T, int extras>
using Records = std::array<const Quad<T>*, std::size_t(extras) + 1>;

/// How a loop measures: the support 2h in its own unit of length, which is `unit` metres.
struct PairScale {
    double unit;      ///< [m]: the frame's quantum for fixed-point records, 1 m for double ones
    double support;   ///< [m]
};
template <class T>
PairScale pair_scale(const Frame& frame, double support) {
    return {sizeof(T) == 4 ? frame.quantum() : 1.0, support};
}

enum class LoopKind { packed, reference };   ///< the fast loop, and the slow one it is tested against

namespace detail {

// Rows stream through once a pass, and the processor's own looking ahead ends with every page of memory, which holds
// little more than one group of rows. 2 KiB ahead, one thread and two are up to 4 % quicker (medians of 20 steps by turns).
constexpr std::size_t entries_ahead = 512;

template <class P, class T>
PATENCY_INLINE Pair<P> make_pair(const Quads<P>& i, const Quads<P>& j, T inverse_support) {
    Pair<P> pair;
    pair.d = {coordinate_difference(i.a, j.a), coordinate_difference(i.b, j.b), coordinate_difference(i.c, j.c)};
    pair.r = sqrt(fma(pair.d.x, pair.d.x, fma(pair.d.y, pair.d.y, pair.d.z * pair.d.z)));
    pair.t = max(P(T(0)), fma(pair.r, P(-inverse_support), P(T(1))));
    return pair;
}

template <class T, int W, int extras>
PATENCY_INLINE Sample<Pack<T, W>, extras> load_sample(const Records<T, extras>& records, const std::uint32_t* index,
                                                      Quads<Pack<T, W>>& geometry) {
    geometry = load_quads<T, W>(records[0], index);
    Sample<Pack<T, W>, extras> sample;
    sample.value = geometry.d;
    for (std::size_t e = 0; e < std::size_t(extras); ++e) sample.extra[e] = load_quads<T, W>(records[e + 1], index);
    return sample;
}

template <class T, int W, class Term, class Finish>
void sum_packed(const Neighbours& rows, T inverse_support, const Records<T, Term::own_extras>& own,
                const Records<T, Term::extras>& other, const Term& term, const Finish& finish) {
    using P = Pack<T, W>;
    constexpr std::size_t sums = std::size_t(Term::sums);
    Shares shares(rows.block_count());
#pragma omp parallel
    {
        AlignedVector<T> results;   // of a block, by groups, sums and lanes
        for (const std::size_t b : shares.of_this_thread()) {
            const Neighbours::Block& block = rows.block(b);
            const std::size_t groups = block.group_start.size() - 1;
            results.reset(groups * sums * W);
            for (std::size_t g = 0; g < groups; ++g) {
                Quads<P> xi, xj;
                const auto i = load_sample<T, W, Term::own_extras>(own, &block.members[g * W], xi);
                std::array<P, sums> sum;
                for (auto& s : sum) s = P(T(0));
                const std::uint32_t* end = block.entries.data() + block.group_start[g + 1];
                for (const std::uint32_t* entry = block.entries.data() + block.group_start[g]; entry < end;
                     entry += W) {
                    __builtin_prefetch(entry + entries_ahead);
                    const auto j = load_sample<T, W, Term::extras>(other, entry, xj);
                    term(make_pair<P, T>(xi, xj, inverse_support), i, j, sum);
                }
                for (std::size_t s = 0; s < sums; ++s) sum[s].store(&results[(g * sums + s) * W]);
            }
            // What is made of the sums streams through many arrays: in one go, it does not wait for them in every group.
            for (std::size_t m = 0; m < block.member_count; ++m) {
                const T* value = &results[m / W * sums * W + m % W];
                std::array<T, sums> total;
                for (std::size_t s = 0; s < sums; ++s) total[s] = value[s * W];
                finish(block.members[m], total);
            }
        }
    }
}

}   // namespace detail

/// finish(i, sums of term over the row of i), for every particle that has a row. Finish may write what belongs to i.
template <class T, class Term, class Finish>
void sum_over_neighbours(const Neighbours& rows, const PairScale& scale, const Records<T, Term::own_extras>& own,
                         const Records<T, Term::extras>& other, const Term& term, const Finish& finish,
                         LoopKind kind = LoopKind::packed);

/// The same, one pair at a time: what the fast loop is tested and measured against. It walks the same rows and adds in
/// the same order, hence gives the same bits.
template <class T, class Term, class Finish>
void sum_one_by_one(const Neighbours& rows, const PairScale& scale, const Records<T, Term::own_extras>& own,
                    const Records<T, Term::extras>& other, const Term& term, const Finish& finish) {
    const T inverse_support = T(scale.unit / scale.support);
    using P = T;
    const std::size_t lanes = std::size_t(rows.lanes());
    const auto quads_of = [](const Quad<T>& q) { return Quads<P>{q.a, q.b, q.c, q.d}; };
    const auto sample_of = [&]<std::size_t n>(const std::array<const Quad<T>*, n>& records, std::uint32_t index,
                                              Quads<P>& geometry) {
        geometry = quads_of(records[0][index]);
        Sample<P, int(n) - 1> sample;
        sample.value = geometry.d;
        for (std::size_t e = 1; e < n; ++e) sample.extra[e - 1] = quads_of(records[e][index]);
        return sample;
    };
    Shares shares(rows.block_count());
#pragma omp parallel
    for (const std::size_t b : shares.of_this_thread()) {
        const Neighbours::Block& block = rows.block(b);
        for (std::size_t m = 0; m < block.member_count; ++m) {
            const std::size_t g = m / lanes;
            Quads<P> xi, xj;
            const auto i = sample_of(own, block.members[m], xi);
            std::array<P, std::size_t(Term::sums)> sum{};
            for (std::size_t k = block.group_start[g] + m % lanes; k < block.group_start[g + 1]; k += lanes) {
                const auto j = sample_of(other, block.entries[k], xj);
                term(detail::make_pair<P, T>(xi, xj, inverse_support), i, j, sum);
            }
            finish(block.members[m], sum);
        }
    }
}

template <class T, class Term, class Finish>
void sum_over_neighbours(const Neighbours& rows, const PairScale& scale, const Records<T, Term::own_extras>& own,
                         const Records<T, Term::extras>& other, const Term& term, const Finish& finish, LoopKind kind) {
    if (kind == LoopKind::reference)
        sum_one_by_one<T>(rows, scale, own, other, term, finish);
    else
        detail::sum_packed<T, native_lanes<T>>(rows, T(scale.unit / scale.support), own, other, term, finish);
}

}   // namespace patency
