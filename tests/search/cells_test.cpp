// SPDX-License-Identifier: Apache-2.0
// The frame's integers measure exactly and never wrap unseen; the cell order is a stable permutation.
#include "patency/search/cells.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "patency/base/errors.h"
#include "tests/search/rows.h"

using namespace patency;
using namespace patency::testing_rows;

namespace {

std::vector<std::uint32_t> order_of(const Frame& frame, double spacing, const std::vector<Vec3>& points) {
    Cells cells;
    const auto order = cells.find_order(frame, spacing, points);
    return {order.begin(), order.end()};
}

TEST(Frame, CoordinatesAreWithinAQuantum) {
    const Box box{{-1, 2, -30}, {5, 3, 4}};
    const Frame frame(box.low, box.high, 0.26);
    const Vec3 centre = 0.5 * (box.low + box.high);
    for (const Vec3& x : random_points(box, 1000, 1)) {
        const auto f = frame.fixed(x);
        EXPECT_LE(std::abs(f[0] * frame.quantum() - (x.x - centre.x)), frame.quantum());
        EXPECT_LE(std::abs(f[1] * frame.quantum() - (x.y - centre.y)), frame.quantum());
        EXPECT_LE(std::abs(f[2] * frame.quantum() - (x.z - centre.z)), frame.quantum());
    }
    EXPECT_EQ(frame.axes()[0], 2);   // the longest
    EXPECT_EQ(frame.axes()[1], 0);
    // An exact float needs 24 bits for every pair within reach.
    EXPECT_LE(frame.support() / frame.quantum(), std::exp2(24));
}

TEST(Frame, DifferencesOfTranslatedPairsAreTheSame) {
    // Whole quanta: the same pair anywhere in the box has the same difference.
    const Frame frame({0, 0, 0}, {8, 8, 8}, 1);
    const double q = frame.quantum();
    for (const double shift : {1000 * q, 123457 * q, 3000001 * q}) {
        const auto a = frame.fixed({4, 4, 4}), b = frame.fixed({4 + 500 * q, 4, 4});
        const auto c = frame.fixed({4 + shift, 4, 4}), d = frame.fixed({4 + shift + 500 * q, 4, 4});
        EXPECT_NEAR(b[0] - a[0], 500, 1);
        EXPECT_NEAR((b[0] - a[0]), (d[0] - c[0]), 1);
    }
}

TEST(Frame, ContainsItsBoxAndNothingElse) {
    const Frame frame({0, 0, 0}, {1, 2, 3}, 0.1);
    EXPECT_TRUE(frame.contains({0, 0, 0}));
    EXPECT_TRUE(frame.contains({1, 2, 3}));
    EXPECT_FALSE(frame.contains({1.0001, 1, 1}));
    EXPECT_FALSE(frame.contains({0.5, -1e-9, 1}));
    EXPECT_FALSE(frame.contains({NAN, 1, 1}));
}

TEST(Frame, PeriodicPlacesComeBackIntoTheBox) {
    const Frame frame({-1, 0, 0}, {1, 2, 0.5}, 0.1, {true, true, false});
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-30, 30);
    for (int k = 0; k < 1000; ++k) {
        const Vec3 x{place(random), place(random), place(random)}, w = frame.wrapped(x);
        EXPECT_TRUE(w.x >= -1 && w.x < 1 && w.y >= 0 && w.y < 2);
        EXPECT_NEAR(std::remainder(w.x - x.x, 2), 0, 1e-13);
        EXPECT_NEAR(std::remainder(w.y - x.y, 2), 0, 1e-13);
        EXPECT_EQ(w.z, x.z);
    }
    EXPECT_EQ(frame.wrapped({0, -1e-20, 0}).y, 0);   // -1e-20 + 2 is 2, the upper face
    // Across a periodic face the integers differ by little.
    const auto low = frame.fixed({-1, 1, 0}), high = frame.fixed({1 - 1e-6, 1, 0});
    EXPECT_NEAR(std::int32_t(std::uint32_t(low[0]) - std::uint32_t(high[0])) * frame.quantum(), 1e-6,
                2 * frame.quantum());
}

TEST(Frame, RefusesWhatItsIntegersCannotHold) {
    EXPECT_NO_THROW(Frame({0, 0, 0}, {999, 1, 1}, 1));
    EXPECT_THROW(Frame({0, 0, 0}, {1001, 1, 1}, 1), GeometryError);
    EXPECT_THROW(Frame({0, 0, 0}, {1, 1, 1e9}, 1), GeometryError);
    EXPECT_THROW(Frame({0, 0, 0}, {1, NAN, 1}, 1), GeometryError);
    EXPECT_THROW(Frame({0, 0, 0}, {2.9, 9, 9}, 1, {true, false, false}), GeometryError);   // sees itself around the box
    EXPECT_THROW(Frame({0, 0, 0}, {9, 8, 1}, 1, {true, true, false}), GeometryError);      // unequal
    EXPECT_NO_THROW(Frame({0, 0, 0}, {9, 9, 1}, 1, {true, true, false}));
}

TEST(Frame, RefusesAnAxisThatThePeriodicOneIsTooShortFor) {
    // The periodic side spans all integers: along another axis a longer distance would wrap onto a short one.
    EXPECT_NO_THROW(Frame({0, 0, 0}, {8, 7, 0}, 1, {true, false, false}));
    EXPECT_THROW(Frame({0, 0, 0}, {8, 7.5, 0}, 1, {true, false, false}), GeometryError);
    EXPECT_THROW(Frame({0, 0, 0}, {20, 8, 8}, 1, {false, true, true}), GeometryError);
}

TEST(CellOrder, IsAPermutation) {
    const Box box{{0, 0, 0}, {3, 1, 2}};
    const Frame frame(box.low, box.high, 0.26);
    for (const std::size_t count : {0, 1, 2, 1000}) {
        auto order = order_of(frame, 0.1, random_points(box, count, 3));
        ASSERT_EQ(order.size(), count);
        std::sort(order.begin(), order.end());
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(order[i], i);
    }
}

TEST(CellOrder, IsStable) {
    const Box box{{0, 0, 0}, {3, 1, 2}};
    const Frame frame(box.low, box.high, 0.26);
    // Coincident particles stay in the order they had, and what is sorted stays as it is.
    auto points = random_points(box, 300, 4);
    for (std::size_t i = 0; i < 300; ++i) points.push_back(points[i]);
    const auto order = order_of(frame, 0.1, points);
    std::vector<std::size_t> place(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = k;
    for (std::size_t i = 0; i < 300; ++i) EXPECT_LT(place[i], place[i + 300]);
    const auto again = order_of(frame, 0.1, taken(points, order));
    for (std::uint32_t k = 0; k < again.size(); ++k) ASSERT_EQ(again[k], k);
}

TEST(CellOrder, IsTheSameForAnyNumberOfThreads) {
    const Box box{{0, 0, 0}, {3, 1, 2}};
    const Frame frame(box.low, box.high, 0.13);
    const auto points = random_points(box, 40000, 5);   // sorting in parallel starts at 4096 a thread
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const auto one = order_of(frame, 0.05, points);
    for (int threads = 2; threads <= 4; ++threads) {
        omp_set_num_threads(threads);
        EXPECT_EQ(order_of(frame, 0.05, points), one) << threads << " threads";
    }
    omp_set_num_threads(before);
}

TEST(CellOrder, KeepsNeighboursNear) {
    // Sixteen consecutive particles of a lattice share their candidates: the box around them must stay a few spacings wide.
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 20; ++j)
            for (int k = 0; k < 20; ++k) points.push_back({i + 0.5, j + 0.5, k + 0.5});
    std::shuffle(points.begin(), points.end(), std::mt19937(6));
    const Frame frame({0, 0, 0}, {40, 20, 20}, 2.6);
    const auto sorted = taken(points, order_of(frame, 1, points));
    double mean = 0;
    int chunks = 0;
    for (std::size_t begin = 0; begin + 16 <= sorted.size(); begin += 16, ++chunks) {
        Vec3 low = sorted[begin], high = low;
        for (std::size_t i = begin; i < begin + 16; ++i) {
            const Vec3& x = sorted[i];
            low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
            high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
        }
        mean += high.x - low.x + high.y - low.y + high.z - low.z;
    }
    // A column is at most 3 lattice places wide: extents 2 + 2, and 16 particles fill 16/4 layers of it or fewer; the
    // few chunks that span two columns may be as long as the box.
    EXPECT_LT(mean / chunks, 2 + 2 + 4 + 40 * 0.1);
}

}   // namespace
