// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "patency/analysis/stent_metrics.h"

namespace patency {
namespace {

constexpr double row = 0.01, way = 1;

/// A program from 0 to 1 in rows, each of which is heeded with what `ratio` says of its time and its rate.
template <class Ratio, class AtRow>
DeployPace paced(double slowing, const Ratio& ratio, const AtRow& at_row) {
    DeployPace pace(row, slowing);
    for (int k = 1; k * row <= way * (1 + 1e-9); ++k) {
        const double time = pace.time_of(k * row);
        at_row(pace, time, k * row);
        pace.heed(time, ratio(k * row, pace.rate(time)));
    }
    return pace;
}

const auto nothing = [](const DeployPace&, double, double) {};

TEST(DeployPace, WhatIsSlowEnoughGoesByTheSolidsOwnTimeToTheLastBit) {
    const DeployPace pace = paced(
        4, [](double, double rate) { return 0.04 * rate * rate; },
        [](const DeployPace& p, double time, double program) {
            EXPECT_EQ(time, program);
            EXPECT_EQ(p.program(time), time);
        });
    EXPECT_EQ(pace.program(0.123456789), 0.123456789);
    EXPECT_EQ(pace.least_rate(), 1);
}

/// The kinetic energy goes with the square of the speed: of what had 20 % at full speed little more than 4.5 % is left, without delay.
TEST(DeployPace, KeepsTheRatioBelowItsBarForWhatGrows) {
    double most = 0, end = 0;
    const DeployPace pace = paced(
        4,
        [&](double program, double rate) {
            const double ratio = (0.04 + 0.16 * program) * rate * rate;
            most = std::max(most, ratio);
            return ratio;
        },
        [&](const DeployPace&, double time, double) { end = time; });
    EXPECT_LT(most, most_kinetic_to_internal);
    EXPECT_NEAR(pace.least_rate(), std::sqrt(0.045 / 0.2), 0.01);
    // The time that it takes: the integral of one over the rate that leaves 4.5 %.
    double wanted = 0;
    constexpr int n = 10000;
    for (int k = 0; k < n; ++k) wanted += std::max(1.0, std::sqrt((0.04 + 0.16 * (k + 0.5) / n) / 0.045)) / n;
    EXPECT_NEAR(end, wanted, 0.02 * wanted);
}

TEST(DeployPace, ChangesByTheRootOfWhatIsTooMuch) {
    DeployPace pace(row, 4);
    pace.heed(row, 1.1 * 0.045);
    EXPECT_NEAR(pace.rate(2 * row), 1 / std::sqrt(1.1), 1e-12);
    EXPECT_NEAR(pace.rate(1.5 * row), 0.5 + 0.5 / std::sqrt(1.1), 1e-12);
}

TEST(DeployPace, IsNeverSlowerThanItMayBeAndRecovers) {
    const auto far_too_fast = [](double program, double rate) { return (program < 0.5 ? 9.0 : 1e-4) * rate * rate; };
    std::vector<double> rates;
    const DeployPace pace =
        paced(2.5, far_too_fast, [&](const DeployPace& p, double time, double) { rates.push_back(p.rate(time)); });
    EXPECT_DOUBLE_EQ(*std::min_element(rates.begin(), rates.end()), 1 / 2.5);
    EXPECT_DOUBLE_EQ(pace.least_rate(), 1 / 2.5);
    EXPECT_EQ(rates.back(), 1);
    EXPECT_EQ(paced(1, far_too_fast, nothing).least_rate(), 1);
}

/// Tools take their speed from it: no jump of the time, none of the rate, and no step back.
TEST(DeployPace, TimeAndRateAreContinuous) {
    const auto restless = [](double program, double) { return 0.05 + 0.04 * std::sin(40 * program); };
    DeployPace pace(row, 4);
    double program = 0, rate = 1;
    int heeded = 0;
    constexpr double tick = row / 50;
    for (double time = tick; time < way; time += tick) {
        if (pace.program(time) > row * (heeded + 1)) pace.heed(time, restless(pace.program(time), 1)), ++heeded;
        const double moved = pace.program(time) - program;
        EXPECT_GE(moved, 0.25 * tick * (1 - 1e-9));
        EXPECT_LE(moved, tick * (1 + 1e-9));
        EXPECT_NEAR(pace.rate(time), rate, 0.11 * tick / row + 1e-12);
        EXPECT_NEAR(moved / tick, 0.5 * (rate + pace.rate(time)), 0.11 * tick / row);
        EXPECT_NEAR(pace.time_of(pace.program(time)), time, 1e-12);
        program = pace.program(time), rate = pace.rate(time);
    }
    EXPECT_GT(heeded, 50);
    EXPECT_LT(pace.least_rate(), 0.9);
}

TEST(DeployPace, GoesOnFromItsNumbers) {
    DeployPace pace = paced(
                   4, [](double program, double) { return 0.02 + 0.2 * program; }, nothing),
               other(row, 4);
    const auto from = pace.numbers(), to = other.numbers();
    ASSERT_EQ(from.size(), to.size());
    for (std::size_t k = 0; k < from.size(); ++k) *to[k] = *from[k];
    for (const double time : {1.0, 1.7, 2.5}) {
        EXPECT_EQ(other.program(time), pace.program(time));
        EXPECT_EQ(other.rate(time), pace.rate(time));
    }
    EXPECT_LT(pace.program(2.0), 2.0);
}

}   // namespace
}   // namespace patency
