// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_mixing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patency {
namespace {

/// What an iteration of twelve unknowns lacks: x = b is sought, and the change it proposes is too small by shares that differ.
struct Slow {
    CellVectors x{CellVector{}, CellVector{}, CellVector{}};

    static float share(std::size_t i, int c) { return 0.2f + 0.2f * float((4 * i + std::size_t(c)) % 4); }
    CellVectors proposed() const {
        CellVectors change(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            for (int c = 0; c < 4; ++c) change[i][c] = share(i, c) * (float(i + 1) * float(c + 1) - x[i][c]);
        return change;
    }
    double lacking() const {
        double sum = 0;
        for (const CellVector& v : proposed())
            for (int c = 0; c < 4; ++c) sum += std::abs(double(v[c]));
        return sum;
    }
    void apply(const CellVectors& change) {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += change[i];
    }
};

// Four different shares: a linear iteration that is mixed over four steps is there after five, but for round-off.
TEST(CellMixing, FindsWhatALinearIterationGoesTo) {
    Slow plain, mixed;
    CellMixing mixing(4);
    const double first = plain.lacking();
    for (int step = 0; step < 6; ++step) {
        plain.apply(plain.proposed());
        CellVectors change = mixed.proposed();
        mixing.mix(change, mixed.lacking());
        mixed.apply(change);
    }
    EXPECT_GT(plain.lacking(), 1e-2 * first);
    EXPECT_LT(mixed.lacking(), 1e-4 * first);
}

TEST(CellMixing, BeginsAnewWhenItForgets) {
    Slow slow;
    CellMixing mixing(4);
    for (int step = 0; step < 2; ++step) {
        CellVectors change = slow.proposed();
        mixing.mix(change, slow.lacking());
        slow.apply(change);
    }
    mixing.forget();
    const CellVectors proposed = slow.proposed();
    CellVectors change = proposed;
    mixing.mix(change, slow.lacking());
    for (std::size_t i = 0; i < change.size(); ++i)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(change[i][c], proposed[i][c]);
}

// A flow that has gone astray: what its steps told of it before leads nowhere.
TEST(CellMixing, ForgetsWhatHasGainedNothingForLong) {
    CellMixing mixing(4);
    int alone = 0;   // the first step after the first that is made as it was proposed
    for (int step = 0; step < 40 && alone == 0; ++step) {
        CellVectors change(3);
        for (std::size_t i = 0; i < 3; ++i)
            for (int c = 0; c < 4; ++c) change[i][c] = std::sin(float(7 * step + 3 * int(i) + c));
        const CellVectors proposed = change;
        mixing.mix(change, 1.0);
        bool same = step > 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (int c = 0; c < 4; ++c) same = same && change[i][c] == proposed[i][c];
        if (same) alone = step;
    }
    EXPECT_EQ(alone, 15);
}

// The answer to a step a hundred times as long as this one is of another flow; to one ten times as long it is not.
TEST(CellMixing, ForgetsStepsThatWereMuchLonger) {
    const auto made_after = [](float longer) {
        CellMixing mixing(4);
        CellVectors first{CellVector{longer, 0, 0, 0}}, second{CellVector{0.6f, 0.8f, 0, 0}};
        mixing.mix(first, 1);
        mixing.mix(second, 0.5);
        return second[0];
    };
    EXPECT_EQ(made_after(100)[0], 0.6f);
    EXPECT_NE(made_after(10)[0], 0.6f);
}

TEST(CellMixing, LeavesAnIterationThatIsThereAlone) {
    CellMixing mixing(3);
    for (int step = 0; step < 4; ++step) {
        CellVectors nothing(2, CellVector{});
        mixing.mix(nothing, 0);
        for (const CellVector& v : nothing)
            for (int c = 0; c < 4; ++c) EXPECT_EQ(v[c], 0);
    }
}

}   // namespace
}   // namespace patency
