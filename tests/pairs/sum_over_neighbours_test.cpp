// SPDX-License-Identifier: Apache-2.0
// The loop over neighbours: the fast loop is the slow one, bit by bit, for any number of lanes and threads; differences
// of a constant field vanish; two bodies give what one body of both would.
#include "patency/pairs/sum_over_neighbours.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/search/rows.h"

using namespace patency;
using namespace patency::testing_rows;

namespace {

constexpr double spacing = 1e-3, support = 2.6e-3;

/// A gradient, with the square of the distance and a quotient, and a further quad on both sides.
struct Everything {
    static constexpr int own_extras = 2, extras = 1, sums = 6;
    template <class P>
    void operator()(const Pair<P>& pair, const Sample<P, 2>& i, const Sample<P, 1>& j, std::array<P, 6>& sum) const {
        const P w = pair.t * pair.t * pair.t * (i.value - j.value);
        sum[0] = fma(w, pair.d.x, sum[0]);
        sum[1] = fma(w, pair.d.y, sum[1]);
        sum[2] = fma(w, pair.d.z, sum[2]);
        sum[3] += pair.t * max(i.extra[0].a - j.extra[0].b, P(0));
        sum[4] -= pair.r * pair.t * i.extra[1].d;
        sum[5] = fma(i.extra[0].c - j.extra[0].c, pair.t / max(pair.r, P(1e-20f)), sum[5]);
    }
};

struct Difference {
    static constexpr int own_extras = 0, extras = 0, sums = 1;
    template <class P>
    void operator()(const Pair<P>& pair, const Sample<P, 0>& i, const Sample<P, 0>& j, std::array<P, 1>& sum) const {
        sum[0] = fma(pair.t, i.value - j.value, sum[0]);
    }
};

/// sum t, sum t d: what is there, counted. Rows over the own body are padded with the particle itself: there only the
/// sums with d count.
struct Count {
    static constexpr int own_extras = 0, extras = 0, sums = 4;
    template <class P>
    void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>&, std::array<P, 4>& sum) const {
        sum[0] += pair.t;
        sum[1] = fma(pair.t, pair.d.x, sum[1]), sum[2] = fma(pair.t, pair.d.y, sum[2]),
        sum[3] = fma(pair.t, pair.d.z, sum[3]);
    }
};

template <class T>
struct Body : Sorted {
    AlignedVector<Quad<T>> geometry, first, second;

    Body(const Frame& frame, const std::vector<Vec3>& from, unsigned seed) : Sorted(frame, spacing, from) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> any(-1, 1);
        const std::size_t n = points.size();
        geometry.reset(n + 1), first.reset(n + 1), second.reset(n + 1);
        const auto quad = [&] { return Quad<T>{T(any(random)), T(any(random)), T(any(random)), T(any(random))}; };
        for (std::size_t i = 0; i < n; ++i) {
            geometry[i] = place(frame, points[i], T(any(random)));
            first[i] = quad(), second[i] = quad();
        }
        // The dummy: far from all, and nothing.
        if constexpr (sizeof(T) == 4)
            geometry[n] = {std::bit_cast<float>(INT32_MIN), std::bit_cast<float>(INT32_MIN),
                           std::bit_cast<float>(INT32_MIN), 0};
        else
            geometry[n] = {1e9, 1e9, 1e9, 0};
        first[n] = second[n] = {0, 0, 0, 0};
    }
    static Quad<T> place(const Frame& frame, const Vec3& x, T value) {
        if constexpr (sizeof(T) == 4) {
            const auto f = frame.fixed(x);
            return {std::bit_cast<float>(f[0]), std::bit_cast<float>(f[1]), std::bit_cast<float>(f[2]), value};
        } else {
            return {x.x, x.y, x.z, value};
        }
    }
};

template <class T, class Term>
using Sums = std::vector<std::array<T, std::size_t(Term::sums)>>;

template <class T>
Sums<T, Everything> sum_everything(const Neighbours& rows, const PairScale& scale, const Body<T>& own,
                                   const Body<T>& other, LoopKind kind) {
    Sums<T, Everything> result(own.points.size(), {T(-7)});   // where there is no row
    sum_over_neighbours<T>(
        rows, scale, Records<T, 2>{own.geometry.data(), own.first.data(), own.second.data()},
        Records<T, 1>{other.geometry.data(), other.first.data()}, Everything{},
        [&](std::uint32_t i, const std::array<T, 6>& sum) { result[i] = sum; }, kind);
    return result;
}

const Box box{{-0.01, 0, 0}, {0.01, 0.012, 0.015}};

template <class T>
struct PairLoop : testing::Test {
    Frame frame{box.low, box.high, support};
    Body<T> own{frame, random_points(box, 2500, 1), 2}, other{frame, random_points(box, 600, 3), 4};
    PairScale scale = pair_scale<T>(frame, support);
    Neighbours own_rows, other_rows;
    PairLoop() { find(native_lanes<T>); }
    ~PairLoop() override { omp_set_num_threads(before_); }
    void find(int lanes) {
        own_rows.find_own(frame, own.cells, support, lanes);
        other_rows.find_other(frame, own.cells, other.cells, support, lanes);
    }
    int before_ = omp_get_max_threads();
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairLoop, Scalars);

TYPED_TEST(PairLoop, FastAndSlowGiveTheSameBits) {
    EXPECT_EQ(sum_everything(this->own_rows, this->scale, this->own, this->own, LoopKind::packed),
              sum_everything(this->own_rows, this->scale, this->own, this->own, LoopKind::reference));
    EXPECT_EQ(sum_everything(this->other_rows, this->scale, this->own, this->other, LoopKind::packed),
              sum_everything(this->other_rows, this->scale, this->own, this->other, LoopKind::reference));
}

TYPED_TEST(PairLoop, AnyNumberOfThreadsGivesTheSameBits) {
    omp_set_num_threads(1);
    const auto one = sum_everything(this->own_rows, this->scale, this->own, this->own, LoopKind::packed);
    for (int threads = 2; threads <= 4; ++threads) {
        omp_set_num_threads(threads);
        EXPECT_EQ(sum_everything(this->own_rows, this->scale, this->own, this->own, LoopKind::packed), one) << threads;
    }
}

TYPED_TEST(PairLoop, AnyNumberOfLanesGivesTheSameBits) {
    using T = TypeParam;
    const auto native = sum_everything(this->other_rows, this->scale, this->own, this->other, LoopKind::packed);
    constexpr int lanes = 16 / int(sizeof(T));   // of the narrowest register
    this->find(lanes);
    Sums<T, Everything> narrow(this->own.points.size(), {T(-7)});
    const auto& a = this->own;
    const auto& b = this->other;
    detail::sum_packed<T, lanes>(this->other_rows, T(this->scale.unit / this->scale.support),
                                 Records<T, 2>{a.geometry.data(), a.first.data(), a.second.data()},
                                 Records<T, 1>{b.geometry.data(), b.first.data()}, Everything{},
                                 [&](std::uint32_t i, const std::array<T, 6>& sum) { narrow[i] = sum; });
    EXPECT_EQ(narrow, native);
}

TYPED_TEST(PairLoop, DifferencesOfAConstantVanish) {
    using T = TypeParam;
    for (std::size_t i = 0; i <= this->own.points.size(); ++i) this->own.geometry[i].d = T(101325.125);
    std::size_t rows = 0;
    sum_over_neighbours<T>(this->own_rows, this->scale, Records<T, 0>{this->own.geometry.data()},
                           Records<T, 0>{this->own.geometry.data()}, Difference{},
                           [&](std::uint32_t, const std::array<T, 1>& sum) {
#pragma omp atomic
                               ++rows;
                               EXPECT_EQ(sum[0], T(0));
                           });
    EXPECT_EQ(rows, this->own.points.size());   // finish is called once per particle, and not for the padding
}

TYPED_TEST(PairLoop, SumsAreThoseOfAllPairs) {
    using T = TypeParam;
    const auto& a = this->own.points;
    const auto& b = this->other.points;
    const double unit = this->scale.unit;
    Sums<T, Count> counted(a.size(), {T(0)});
    sum_over_neighbours<T>(this->other_rows, this->scale, Records<T, 0>{this->own.geometry.data()},
                           Records<T, 0>{this->other.geometry.data()}, Count{},
                           [&](std::uint32_t i, const std::array<T, 4>& sum) { counted[i] = sum; });
    // Fixed-point places are cut to a quantum, 2^-21 of the support, in each component: t is off by less than 2 sqrt(3)
    // 2^-21 per pair, and rounding in float adds 2^-24 per sum; doubles have their own 2^-52.
    const double per_pair = sizeof(T) == 4 ? 4 * std::exp2(-21) : 1e-14;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double sum = 0, x = 0, pairs = 1;
        for (const Vec3& q : b) {
            const Vec3 d = a[i] - q;
            const double t = std::max(0.0, 1 - norm(d) / support);
            sum += t, x += t * d.x, pairs += t > 0;
        }
        EXPECT_NEAR(counted[i][0], sum, pairs * per_pair) << i;
        EXPECT_NEAR(counted[i][1] * unit, x, 2 * pairs * per_pair * support) << i;
    }
}

TYPED_TEST(PairLoop, TwoBodiesGiveWhatOneBodyOfBothGives) {
    using T = TypeParam;
    std::vector<Vec3> all = this->own.points;
    all.insert(all.end(), this->other.points.begin(), this->other.points.end());
    const Body<T> both(this->frame, all, 5);
    Neighbours rows;
    rows.find_own(this->frame, both.cells, support, native_lanes<T>);
    const auto count = [&](const Neighbours& n, const Body<T>& a, const Body<T>& b) {
        std::vector<double> sums(a.points.size(), 0.0);
        sum_over_neighbours<T>(
            n, this->scale, Records<T, 0>{a.geometry.data()}, Records<T, 0>{b.geometry.data()}, Count{},
            [&](std::uint32_t i, const std::array<T, 4>& sum) { sums[i] = sum[1] * this->scale.unit / support; });
        return sums;
    };
    auto parts = count(this->own_rows, this->own, this->own);
    const auto foreign = count(this->other_rows, this->own, this->other);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] += foreign[i];
    const auto whole = count(rows, both, both);
    for (std::size_t i = 0; i < both.points.size(); ++i) {
        const auto at = std::find(this->own.points.begin(), this->own.points.end(), both.points[i]);
        if (at == this->own.points.end()) continue;
        // The same 100 terms or fewer, t d below a quarter of the support, in another order: half an ulp of the sum each.
        const double rounding = 100 * (100 * 0.25) * 0.5 * double(std::numeric_limits<T>::epsilon());
        EXPECT_NEAR(parts[std::size_t(at - this->own.points.begin())], whole[i], rounding);
    }
}

}   // namespace
