// SPDX-License-Identifier: Apache-2.0
// The loop over neighbours that stay neighbours: the numbers of a pair that never change are laid beside its index, in the
// order in which packs read them, instead of being found again in every step. Otherwise as sum_over_neighbours: every particle
// gathers over its own full row, so there are no races, and the bits are the same for any number of threads and lanes.
//
// Particles are to be numbered so that rows of one length stand side by side (find_order): a group of packed rows is a run of
// particles, and what a loop finishes is stored as a pack.
//
//     struct Term {
//         static constexpr std::size_t own_quads = 1, quads = 1, sums = 3;   // records of i and of j, numbers summed
//         template <class P> void operator()(const FixedPair<P>& pair, const std::array<Quads<P>, own_quads>& i,
//                                            const std::array<Quads<P>, quads>& j, std::array<P, sums>& sum) const { ... }
//     };
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "patency/base/aligned.h"
#include "patency/base/pack.h"
#include "patency/base/parallel.h"
#include "patency/base/vec.h"
#include "patency/pairs/sum_over_neighbours.h"

namespace patency {

/// What never changes of a pair: its weight, and its distance by that weight.
template <class P>
struct FixedPair {
    Vec<P> wd;   ///< w (X_i - X_j)
    P w;
};

/// A pair as it is found.
struct FoundPair {
    Vec3 d;   ///< X_i - X_j
    double w;
};

/// How floats keep what they find: distances in whole quanta, roots of weights in whole parts of the largest's (the root, for most weights are small), 16 bits
/// each. The loop waits for memory, of which a pair then takes 12 bytes with its index instead of 20. Distances that are whole numbers of quanta lose nothing,
/// and any weights will do that both of a pair have alike.
struct PairUnits {
    double distance = 1;   ///< a quantum
    double weight = 1;     ///< the largest

    static constexpr double most = 32767, parts = 65535,
                            lowest = -32768;   // of a distance; of a root, kept from the lowest number up

    double root() const { return std::sqrt(weight) / parts; }
};

/// One row per particle, as found; the place of a row is its particle.
using FixedRows = std::vector<std::vector<std::uint32_t>>;

/// The rows of all particles of a body.
inline FixedRows rows_by_particle(const Neighbours& found, std::size_t count) {
    FixedRows rows(count);
    const auto lanes = std::size_t(found.lanes());
    for (std::size_t b = 0; b < found.block_count(); ++b) {
        const Neighbours::Block& block = found.block(b);
        for (std::size_t m = 0; m < block.member_count; ++m) {
            const std::size_t g = m / lanes;
            for (std::size_t k = block.group_start[g] + m % lanes; k < block.group_start[g + 1]; k += lanes)
                if (block.entries[k] != block.members[m])
                    rows[block.members[m]].push_back(block.entries[k]);   // itself: padding
        }
    }
    return rows;
}

/// Runs of particles in which the order goes by the rows' lengths; what is near in memory stays near. A multiple of all lanes.
inline constexpr std::size_t particles_per_run = 512;

/// order[new number] = old number, with rows of about one length side by side; kind_of(particle): those of one kind first.
template <class KindOf>
std::vector<std::uint32_t> find_order(const FixedRows& rows, KindOf kind_of) {
    std::vector<std::uint32_t> order(rows.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t first = 0; first < order.size(); first += particles_per_run)
        std::stable_sort(order.begin() + std::ptrdiff_t(first),
                         order.begin() + std::ptrdiff_t(std::min(order.size(), first + particles_per_run)),
                         [&](std::uint32_t a, std::uint32_t b) {
                             return std::pair(kind_of(a), rows[a].size()) < std::pair(kind_of(b), rows[b].size());
                         });
    return order;
}

/// The rows of particles that were put into this order.
inline FixedRows reordered(const FixedRows& rows, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k]] = k;
    FixedRows result(rows.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        for (const std::uint32_t j : rows[order[k]]) result[k].push_back(place[j]);
    return result;
}

/// The pairs that material joins: those nearer than `near`, and those with a third particle that near to both. Struts that pass
/// each other closer than the support are no neighbours. Symmetric, as the rows are.
template <class Position>
FixedRows joined(const FixedRows& rows, const Position& x, double near) {
    const auto are_near = [&](std::uint32_t a, std::uint32_t b) { return norm(x[a] - x[b]) <= near; };
    FixedRows result(rows.size());
    const auto count = std::uint32_t(rows.size());
#pragma omp parallel for schedule(dynamic, 512)
    for (std::uint32_t i = 0; i < count; ++i) {
        std::vector<std::uint32_t> between;
        for (const std::uint32_t k : rows[i])
            if (are_near(i, k)) between.push_back(k);
        for (const std::uint32_t j : rows[i])
            if (are_near(i, j) ||
                std::any_of(between.begin(), between.end(), [&](std::uint32_t k) { return are_near(j, k); }))
                result[i].push_back(j);
    }
    return result;
}

template <class T>
class FixedPairs {
public:
    static constexpr std::size_t lanes = std::size_t(native_lanes<T>);

    /// pair_of(i, j) -> FoundPair; one of weight zero is left out. Doubles are kept as they are found.
    template <class PairOf>
    void make(const FixedRows& rows, const PairUnits& units, PairOf pair_of) {
        distance_unit_ = T(units.distance), root_unit_ = T(units.root()), no_root_ = T(-PairUnits::lowest) * root_unit_;
        count_ = rows.size();
        start_.assign(1, 0);
        pairs_ = 0;
        index_.reset(0), numbers_.reset(0);
        std::array<std::vector<std::pair<std::uint32_t, std::array<Stored, 4>>>, lanes> group;
        for (std::size_t first = 0; first < count_; first += lanes) {
            std::size_t longest = 0;
            for (std::size_t l = 0; l < lanes; ++l) {
                group[l].clear();
                if (first + l >= count_) continue;
                for (const std::uint32_t j : rows[first + l])
                    if (const std::array<Stored, 4> pair = stored(pair_of(std::uint32_t(first + l), j), units);
                        pair[3] != no_weight)
                        group[l].push_back({j, pair});
                pairs_ += group[l].size();
                longest = std::max(longest, group[l].size());
            }
            const std::size_t filled = start_.back();
            index_.extend(filled + longest * lanes), numbers_.extend(4 * (filled + longest * lanes));
            for (std::size_t k = 0; k < longest; ++k)
                for (std::size_t l = 0; l < lanes; ++l) {
                    const bool is_padding = k >= group[l].size();   // the particle itself, whose differences vanish
                    index_[filled + k * lanes + l] = is_padding ? std::uint32_t(first + l) : group[l][k].first;
                    for (std::size_t n = 0; n < 4; ++n)
                        numbers_[4 * (filled + k * lanes) + n * lanes + l] = !is_padding ? group[l][k].second[n]
                                                                             : n < 3     ? Stored(0)
                                                                                         : no_weight;
                }
            start_.push_back(filled + longest * lanes);
        }
    }

    std::size_t size() const { return count_; }
    /// Of records and columns: whole packs may be read and stored at every particle.
    std::size_t padded_size() const { return (start_.size() - 1) * lanes; }
    std::uint64_t pair_count() const { return pairs_; }

    /// visit(i, j, pair) for all; of different i on different threads, of one i in the order of its row.
    template <class Visit>
    void for_each_pair(Visit visit) const {
#pragma omp parallel for schedule(dynamic, 8)
        for (std::size_t g = 0; g < start_.size() - 1; ++g)
            for (std::size_t l = 0; l < lanes; ++l)
                for (std::size_t k = start_[g] + l; k < start_[g + 1]; k += lanes) {
                    if (const FixedPair<T> pair = pair_at<T>(&numbers_[4 * (k - l) + l]); pair.w != T(0))
                        visit(std::uint32_t(g * lanes + l), index_[k], pair);
                }
    }

    /// finish(i, sums of term over the row of i), with packs for the particles i, i + 1 ... or, in the reference loop, with
    /// numbers for i. Records are padded.
    template <class Term, class Finish>
    void sum(const std::array<const Quad<T>*, Term::own_quads>& own,
             const std::array<const Quad<T>*, Term::quads>& other, const Term& term, const Finish& finish,
             LoopKind kind) const {
        if (kind == LoopKind::packed)
            sum_as<Pack<T>>(own, other, term, finish);
        else
            sum_as<T>(own, other, term, finish);
    }

private:
    /// P: a pack for a group at once, or a number for one particle after the other.
    template <class P, class Term, class Finish>
    void sum_as(const std::array<const Quad<T>*, Term::own_quads>& own,
                const std::array<const Quad<T>*, Term::quads>& other, const Term& term, const Finish& finish) const {
        constexpr bool is_packed = !std::is_same_v<P, T>;
        constexpr std::size_t at_once = is_packed ? lanes : 1, groups_per_task = particles_per_run / lanes;
        const std::size_t groups = start_.size() - 1, tasks = (groups + groups_per_task - 1) / groups_per_task;
        Shares shares(tasks);
#pragma omp parallel
        for (const std::size_t task : shares.of_this_thread()) {
            for (std::size_t g = task * groups_per_task; g < std::min(groups, (task + 1) * groups_per_task); ++g) {
                for (std::size_t lane = 0; lane < lanes && g * lanes + lane < count_; lane += at_once) {
                    alignas(64) std::uint32_t members[lanes];
                    for (std::size_t l = 0; l < lanes; ++l) members[l] = std::uint32_t(g * lanes + l);
                    const auto i = load<P>(own, members + lane);
                    std::array<P, Term::sums> sum;
                    for (P& s : sum) s = P(T(0));
                    const Stored* numbers = numbers_.data() + 4 * start_[g] + lane;
                    const std::uint32_t *entry = index_.data() + start_[g] + lane, *end = index_.data() + start_[g + 1];
                    for (; entry < end; entry += lanes, numbers += 4 * lanes) {
                        term(pair_at<P>(numbers), i, load<P>(other, entry), sum);
                    }
                    finish(g * lanes + lane, sum);
                }
            }
        }
    }
    using Stored = std::conditional_t<sizeof(T) == 4, std::int16_t, double>;
    static constexpr Stored no_weight = sizeof(T) == 4 ? Stored(PairUnits::lowest) : Stored(0);

    static std::array<Stored, 4> stored(const FoundPair& pair, const PairUnits& units) {
        if constexpr (sizeof(T) == 4) {
            const auto whole = [](double x) { return Stored(std::lrint(x)); };
            const Vec3 d = (1 / units.distance) * pair.d;
            return {whole(d.x), whole(d.y), whole(d.z), whole(PairUnits::lowest + std::sqrt(pair.w) / units.root())};
        } else {
            const Vec3 wd = pair.w * pair.d;
            return {wd.x, wd.y, wd.z, pair.w};
        }
    }
    /// A pack of pairs, or a number's single one, from where its wd.x lies.
    template <class P>
    PATENCY_INLINE FixedPair<P> pair_at(const Stored* from) const {
        std::array<P, 4> n;
        for (std::size_t k = 0; k < 4; ++k) {
            if constexpr (sizeof(T) == 4)
                load_whole(from + k * lanes, n[k]);
            else if constexpr (std::is_same_v<P, T>)
                n[k] = from[k * lanes];
            else
                n[k] = P::load(from + k * lanes);
        }
        if constexpr (sizeof(T) == 4) {
            const P root = fma(n[3], P(root_unit_), P(no_root_)), w = root * root, scale = w * P(distance_unit_);
            return {{scale * n[0], scale * n[1], scale * n[2]}, w};
        } else {
            return {{n[0], n[1], n[2]}, n[3]};
        }
    }
    template <class P, std::size_t n>
    PATENCY_INLINE static std::array<Quads<P>, n> load(const std::array<const Quad<T>*, n>& records,
                                                       const std::uint32_t* index) {
        std::array<Quads<P>, n> quads;
        for (std::size_t k = 0; k < n; ++k) {
            if constexpr (std::is_same_v<P, T>) {
                const Quad<T>& q = records[k][*index];
                quads[k] = {q.a, q.b, q.c, q.d};
            } else {
                quads[k] = load_quads<T, P::lanes>(records[k], index);
            }
        }
        return quads;
    }

    std::size_t count_ = 0;
    std::uint64_t pairs_ = 0;
    std::vector<std::size_t> start_{0};    // of every group, in entries, and the end
    AlignedVector<std::uint32_t> index_;   // of neighbours, side by side
    AlignedVector<Stored>
        numbers_;   // of pairs: by pack of entries wd.x, wd.y, wd.z, w; of floats d.x, d.y, d.z, root of w in units
    T distance_unit_ = 1, root_unit_ = 1, no_root_ = 0;
};

/// A pack or a number to column[i], column[i + 1] ...
template <class T, int W>
PATENCY_INLINE void store(const Pack<T, W>& value, T* column) {
    value.store(column);
}
PATENCY_INLINE void store(float value, float* column) { *column = value; }
PATENCY_INLINE void store(double value, double* column) { *column = value; }

}   // namespace patency
