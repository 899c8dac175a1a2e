// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "patency/analysis/stent_metrics.h"
#include "patency/base/smooth_rise.h"

namespace patency {
namespace {

constexpr double row = 0.005, way = 1;

/// A program from 0 to 1 in rows, each of which is heeded with what `ratio` says of its time and its rate.
template <class Ratio, class AtRow>
DeployPace paced(double slowing, const Ratio& ratio, const AtRow& at_row) {
    DeployPace pace(row, slowing);
    pace.set_out(0);
    for (int k = 1; k * row <= way * (1 + 1e-9); ++k) {
        const double time = pace.time_of(k * row);
        at_row(pace, time, k * row);
        pace.heed(time, ratio(k * row, pace.rate(time)));
    }
    return pace;
}

const auto nothing = [](const DeployPace&, double, double) {};

TEST(DeployPace, IsTheSolidsOwnTimeBeforeItSetsOutAndIfItMayNotSlowDown) {
    DeployPace pace(row, 4);
    EXPECT_EQ(pace.program(0.123456789), 0.123456789);
    EXPECT_EQ(pace.time_of(0.123456789), 0.123456789);
    const DeployPace never = paced(
        1, [](double, double) { return 9.0; },
        [](const DeployPace& p, double time, double program) {
            EXPECT_EQ(time, program);
            EXPECT_EQ(p.program(time), time);
        });
    EXPECT_EQ(never.least_rate(), 1);
}

/// The kinetic energy goes with the square of the speed: of what has 20 % at full rate in the end 4 % is left on the way.
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
    EXPECT_NEAR(pace.least_rate(), std::sqrt(0.04 / 0.2), 0.02);
    // The time that it takes: the integral of one over the rate that leaves 4 %.
    double wanted = 0;
    constexpr int n = 10000;
    for (int k = 0; k < n; ++k) wanted += std::sqrt((0.04 + 0.16 * (k + 0.5) / n) / 0.04) / n;
    EXPECT_NEAR(end, wanted, 0.04 * wanted);
}

/// A mass that resists as metal does, elastic and then plastic, before a tool that only pushes: what it takes up, and what it has of motion.
double worst_ratio_of_driven(double mass, double slowing) {
    constexpr double yield = 1, stiffness = 50, tool_stiffness = 4000, before = 0.05;
    constexpr int steps_per_row = 50;
    const double damping = 0.06 * std::sqrt(stiffness * mass), dt = row / steps_per_row;
    double x = 0, v = 0, plastic = 0, worked = before, worst = 0;
    DeployPace pace(row, slowing);
    pace.set_out(0);
    int heeded = 0;
    for (double time = dt; pace.program(time) < way; time += dt) {
        const double push = tool_stiffness * std::max(0.0, growing_rise(pace.program(time)) - x);
        const double trial = stiffness * (x - plastic), force = std::clamp(trial, -yield, yield);
        plastic += (trial - force) / stiffness;
        worked += std::abs(trial - force) / stiffness * yield;
        v += dt * (push - force - damping * v) / mass;
        x += dt * v;
        if (pace.program(time) < row * (heeded + 1)) continue;
        const double ratio = 0.5 * mass * v * v / (worked + 0.5 * force * force / stiffness);
        if (pace.program(time) > 0.1 * way) worst = std::max(worst, ratio);
        pace.heed(time, ratio), ++heeded;
    }
    return worst;
}

TEST(DeployPace, DoesNotDriveTheSwingsOfWhatIsDriven) {
    EXPECT_LT(worst_ratio_of_driven(0.03, 4), most_kinetic_to_internal);
    EXPECT_LT(worst_ratio_of_driven(0.06, 4), most_kinetic_to_internal);
    EXPECT_GT(worst_ratio_of_driven(0.03, 1), 1.1 * most_kinetic_to_internal);
    EXPECT_GT(worst_ratio_of_driven(0.06, 1), 2 * most_kinetic_to_internal);
}

TEST(DeployPace, ChangesByTheRootOfTheAverageAndLittleAtATime) {
    DeployPace pace(row, 4);
    pace.set_out(0);
    const double first = std::sqrt(0.04 / 0.1);   // twice the bar is feared
    EXPECT_NEAR(pace.rate(0.5 * row), first, 1e-12);
    pace.heed(row, 0.05 * first * first);   // at full rate 0.05
    const double second = std::sqrt(0.04 / (0.1 - 0.05 / 20));
    EXPECT_NEAR(pace.rate(2 * row), second, 1e-12);
    EXPECT_NEAR(pace.rate(1.5 * row), 0.5 * (first + second), 1e-12);
    pace.heed(2 * row, 100);
    EXPECT_NEAR(pace.rate(3 * row), second / 1.03, 1e-12);
}

TEST(DeployPace, IsNeverSlowerThanItMayBeAndRecovers) {
    const auto far_too_fast = [](double program, double rate) { return (program < 0.3 ? 0.9 : 1e-4) * rate * rate; };
    std::vector<double> rates;
    DeployPace pace =
        paced(2.5, far_too_fast, [&](const DeployPace& p, double time, double) { rates.push_back(p.rate(time)); });
    EXPECT_DOUBLE_EQ(*std::min_element(rates.begin(), rates.end()), 1 / 2.5);
    EXPECT_DOUBLE_EQ(pace.least_rate(), 1 / 2.5);
    EXPECT_EQ(rates.back(), 1);
    DeployPace slow = paced(
        2.5, [](double, double) { return 0.9; }, nothing);
    EXPECT_LT(slow.rate(3), 1);
    slow.rest(3);
    EXPECT_EQ(slow.rate(3), 1);
    EXPECT_NEAR(slow.program(4), slow.program(3) + 1, 1e-12);
}

/// Tools take their speed from it: no jump of the time, none of the rate, and no step back.
TEST(DeployPace, TimeAndRateAreContinuous) {
    DeployPace pace(row, 4);
    pace.set_out(0);
    double program = 0, rate = pace.rate(0);
    int heeded = 0;
    constexpr double tick = row / 50;
    for (double time = tick; time < way; time += tick) {
        if (pace.program(time) > row * (heeded + 1))
            pace.heed(time, 0.05 + 0.04 * std::sin(40 * pace.program(time))), ++heeded;
        const double moved = pace.program(time) - program;
        EXPECT_GE(moved, 0.25 * tick * (1 - 1e-9));
        EXPECT_LE(moved, tick * (1 + 1e-9));
        EXPECT_NEAR(pace.rate(time), rate, 0.031 * tick / row + 1e-12);
        EXPECT_NEAR(moved / tick, 0.5 * (rate + pace.rate(time)), 0.031 * tick / row);
        EXPECT_NEAR(pace.time_of(pace.program(time)), time, 1e-12);
        program = pace.program(time), rate = pace.rate(time);
    }
    EXPECT_GT(heeded, 50);
    EXPECT_LT(pace.least_rate(), 0.9);
}

TEST(DeployPace, SkipsWhereNothingHappens) {
    DeployPace pace(row, 4);
    pace.set_out(0);
    pace.heed(row, 0.2);
    const double rate = pace.rate(3 * row);
    ASSERT_LT(rate, 1);
    pace.skip_to(3 * row, 0.7);
    EXPECT_DOUBLE_EQ(pace.program(3 * row), 0.7);
    EXPECT_DOUBLE_EQ(pace.program(3 * row + 0.1), 0.7 + 0.1 * rate);
    EXPECT_NEAR(pace.time_of(0.7 + 0.1 * rate), 3 * row + 0.1, 1e-12);
    pace.rest(4 * row);
    EXPECT_NEAR(pace.program(4 * row + 0.1), 0.7 + row * rate + 0.1, 1e-12);
}

TEST(DeployPace, GoesOnFromItsNumbers) {
    DeployPace pace = paced(
                   4, [](double program, double) { return 0.02 + 0.2 * program; }, nothing),
               other(row, 4);
    const auto from = pace.numbers(), to = other.numbers();
    ASSERT_EQ(from.size(), to.size());
    for (std::size_t k = 0; k < from.size(); ++k) *to[k] = *from[k];
    for (DeployPace* p : {&pace, &other}) p->heed(2, 0.03);
    for (const double time : {1.0, 2.001, 2.5}) {
        EXPECT_EQ(other.program(time), pace.program(time));
        EXPECT_EQ(other.rate(time), pace.rate(time));
    }
    EXPECT_LT(pace.program(2.0), 2.0);
}

}   // namespace
}   // namespace patency
