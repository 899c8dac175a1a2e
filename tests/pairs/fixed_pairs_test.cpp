// SPDX-License-Identifier: Apache-2.0
// Pairs for ever: every particle meets its neighbours and nobody else, once; the fast loop is the slow one, bit by bit, for any
// number of threads; the order keeps particles near to where they were, with rows of one length side by side.
#include "patency/pairs/fixed_pairs.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <map>
#include <set>

#include "tests/search/rows.h"

using namespace patency;
using namespace patency::testing_rows;

namespace {

constexpr double support = 1.9e-3;
const Box box{{-0.01, 0, 0}, {0.01, 0.009, 0.012}};

double weight(const Vec3& a, const Vec3& b) { return std::max(0.0, 1 - norm(a - b) / support); }

/// Floats keep distances in quanta, roots of weights in parts of the largest's.
constexpr double quantum = support / 32000;
template <class T>
double kept(double w) {
    return sizeof(T) == 4 ? std::pow(std::round(PairUnits::parts * std::sqrt(w)) / PairUnits::parts, 2) : w;
}

/// sum w d, sum w (q_i + q_j), with a further number of both.
struct Everything {
    static constexpr std::size_t own_quads = 1, quads = 1, sums = 4;
    template <class P>
    void operator()(const FixedPair<P>& pair, const std::array<Quads<P>, 1>& i, const std::array<Quads<P>, 1>& j,
                    std::array<P, 4>& sum) const {
        sum[0] += pair.wd.x, sum[1] += pair.wd.y, sum[2] += pair.wd.z;
        sum[3] = fma(pair.w, i[0].b + j[0].c, sum[3]);
    }
};

template <class T>
struct FixedPairsOf : testing::Test {
    std::vector<Vec3> points;
    FixedRows rows;
    FixedPairs<T> pairs;
    AlignedVector<Quad<T>> records;

    FixedPairsOf() {
        const Frame frame(box.low, box.high, support);
        std::vector<Vec3> places = random_points(box, 1501, 5);   // the last group is not full
        for (Vec3& x : places)
            x = {quantum * std::round(x.x / quantum), quantum * std::round(x.y / quantum),
                 quantum * std::round(x.z / quantum)};
        Sorted sorted(frame, 1e-3, places);
        Neighbours found;
        found.find_own(frame, sorted.cells, support, native_lanes<T>);
        const FixedRows as_found = rows_by_particle(found, sorted.points.size());
        const auto order = find_order(as_found, [](std::uint32_t) { return 0; });
        points = taken(sorted.points, order);
        rows = reordered(as_found, order);
        pairs.make(rows, {quantum, 1}, [&](std::uint32_t i, std::uint32_t j) {
            return FoundPair{points[i] - points[j], weight(points[i], points[j])};
        });
        records.reset(pairs.padded_size(), {T(0), T(0), T(0), T(0)});
        for (std::size_t i = 0; i < points.size(); ++i) records[i] = {T(0), T(0.5) * T(i % 7), T(i % 11), T(0)};
    }
    ~FixedPairsOf() override { omp_set_num_threads(before_); }

    std::array<AlignedVector<T>, 4> sums(LoopKind kind) {
        std::array<AlignedVector<T>, 4> result;
        for (auto& column : result) column.reset(pairs.padded_size(), T(-7));
        pairs.template sum<Everything>(
            {records.data()}, {records.data()}, {},
            [&](std::size_t i, const auto& s) {
                for (std::size_t k = 0; k < 4; ++k) store(s[k], &result[k][i]);
            },
            kind);
        return result;
    }
    std::vector<T> flat(LoopKind kind) {
        const auto columns = sums(kind);
        std::vector<T> all;
        for (const auto& column : columns) all.insert(all.end(), column.data(), column.data() + points.size());
        return all;
    }
    int before_ = omp_get_max_threads();
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FixedPairsOf, Scalars);

TYPED_TEST(FixedPairsOf, MeetAllNeighboursAndNobodyElse) {
    const auto sums = this->sums(LoopKind::packed);
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < this->points.size(); ++i) {
        Vec3 wd{};
        double other = 0;
        for (std::size_t j = 0; j < this->points.size(); ++j) {
            const double w = i == j ? 0 : kept<TypeParam>(weight(this->points[i], this->points[j]));
            wd += w * (this->points[i] - this->points[j]);
            other += w * (0.5 * double(i % 7) + double(j % 11));
            count += TypeParam(w) > 0;
        }
        const double exact = sizeof(TypeParam) == 4 ? 1e-5 : 1e-13;
        EXPECT_NEAR(double(sums[0][i]), wd.x, exact * support);
        EXPECT_NEAR(double(sums[1][i]), wd.y, exact * support);
        EXPECT_NEAR(double(sums[2][i]), wd.z, exact * support);
        EXPECT_NEAR(double(sums[3][i]), other, 10 * exact * (1 + other));
    }
    EXPECT_EQ(this->pairs.pair_count(), count);
    std::uint64_t visited = 0;
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    omp_set_num_threads(1);
    this->pairs.for_each_pair([&](std::uint32_t i, std::uint32_t j, const FixedPair<TypeParam>& pair) {
        ++visited, seen.insert({i, j});
        const double w = kept<TypeParam>(weight(this->points[i], this->points[j]));
        EXPECT_NEAR(double(pair.w), w, sizeof(TypeParam) == 4 ? 1e-7 : 0.0);
        EXPECT_NEAR(double(pair.wd.x), w * (this->points[i].x - this->points[j].x),
                    (sizeof(TypeParam) == 4 ? 1e-6 : 1e-15) * support);
    });
    EXPECT_EQ(visited, count);
    EXPECT_EQ(seen.size(), count);
}

TYPED_TEST(FixedPairsOf, FastAndSlowAndAnyThreadsGiveTheSameBits) {
    omp_set_num_threads(1);
    const auto one = this->flat(LoopKind::packed);
    EXPECT_EQ(this->flat(LoopKind::reference), one);
    for (int threads = 2; threads <= 4; ++threads) {
        omp_set_num_threads(threads);
        EXPECT_EQ(this->flat(LoopKind::packed), one) << threads;
    }
}

TEST(FixedRowsOrder, PutsLengthsSideBySideWithinRunsKindsFirst) {
    FixedRows rows(1300);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].resize((i * 37) % 29);
    const auto kind = [](std::uint32_t i) { return int(i % 2); };
    const auto order = find_order(rows, kind);
    EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), rows.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        EXPECT_EQ(order[k] / particles_per_run, k / particles_per_run);
        if (k % particles_per_run == 0) continue;
        const auto rank = [&](std::size_t at) { return std::pair(kind(order[at]), rows[order[at]].size()); };
        EXPECT_LE(rank(k - 1), rank(k));
    }
}

}   // namespace

TEST(FixedRowsJoined, AreThoseThatAThirdParticleIsNearToOrThatAreNearThemselves) {
    // Two layers of a lattice, 1.7 spacings apart, and a post that joins them at one place.
    std::vector<Vec3> x;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 7; ++i)
            for (int j = 0; j < 7; ++j) x.push_back({double(i), double(j), 1.7 * k});
    x.push_back({0, 0, 0.85});
    FixedRows rows(x.size());
    for (std::uint32_t i = 0; i < x.size(); ++i)
        for (std::uint32_t j = 0; j < x.size(); ++j)
            if (i != j && norm(x[i] - x[j]) < 2.05) rows[i].push_back(j);
    const FixedRows kept = joined(rows, x, 1.6);
    std::size_t across = 0;
    for (std::uint32_t i = 0; i < x.size(); ++i) {
        const std::set<std::uint32_t> row(kept[i].begin(), kept[i].end());
        EXPECT_TRUE(std::is_sorted(kept[i].begin(), kept[i].end()));
        for (const std::uint32_t j : rows[i]) {
            EXPECT_EQ(row.count(j) == 1, std::count(kept[j].begin(), kept[j].end(), i) == 1) << "one-sided";
            const bool is_across = x[i].z != x[j].z && i < 98 && j < 98;
            if (!is_across) {
                EXPECT_TRUE(row.count(j)) << "within a layer, or of the post";
            } else if (row.count(j)) {
                ++across;
                EXPECT_LT(std::max(std::hypot(x[i].x, x[i].y), std::hypot(x[j].x, x[j].y)), 1.5)
                    << "away from the post";
            }
        }
    }
    EXPECT_GT(across, 0u) << "the post joins nobody";
}
