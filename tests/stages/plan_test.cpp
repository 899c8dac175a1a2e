// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/units.h"
#include "patency/config/deck.h"
#include "patency/stages/build.h"
#include "tests/stages/decks.h"

namespace patency {
namespace {

const Scene& tube() {
    static const auto scene = build_frame(deck::parse_case(R"(version: 1
geometry: {shape: {type: tube, diameter: "4 mm", length: "40 mm"}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings: {inlet: {type: flow, flow: "2 mL/s"}, outlet: {type: pressure, pressure: "0 Pa"}}
numerics: {spacing: "0.25 mm", duration: "1 s"})"));
    return *scene;
}

TEST(RoundSpacing, IsTheNextOneBelowThatPeopleWrite) {
    for (double dp = 1.7e-6; dp < 2e-2; dp *= 1.0137) {
        const double rounded = round_spacing(dp);
        EXPECT_LE(rounded, dp);
        EXPECT_GT(rounded, dp / 1.0501);
        EXPECT_EQ(round_spacing(rounded), rounded);
        EXPECT_LE(format_quantity(rounded, "mm").size(), 11u) << format_quantity(rounded, "mm");
    }
    EXPECT_EQ(round_spacing(0.1e-3), 0.1e-3);
    EXPECT_EQ(round_spacing(0.1999e-3), 0.195e-3);
}

TEST(Plan, AtAnotherSpacingIsThatOfAFrameOfThatSpacing) {
    const FlowPlan there = plan_flow(tube(), 2, 0.5e-3), own = plan_flow(tube(), 2);
    EXPECT_NEAR(own.fluid_particles / there.fluid_particles, 8, 0.6);   // the buffers are four spacings long
    EXPECT_NEAR(own.across_narrowest, 16, 1e-9);
    EXPECT_GT(own.seconds, 8 * there.seconds);
    EXPECT_EQ(plan_flow(tube(), 2, 0.25e-3).seconds, own.seconds);
    EXPECT_NEAR(plan_flow(tube(), 1).seconds, 2 * own.seconds, 1e-9 * own.seconds);
}

TEST(Plan, AFlowThatIsWaitedForProbablyEndsSooner) {
    deck::Case config = tube().config;
    EXPECT_EQ(plan_flow(tube(), 2).longest_seconds, plan_flow(tube(), 2).seconds);
    config.numerics.convergence.emplace();
    const FlowPlan waited = plan_flow(*build_frame(config), 2);
    // From rest eight windows, each an eighth of what 2 mL/s need through 40 mm of 4 mm: 0.2513 s.
    EXPECT_NEAR(waited.seconds / waited.longest_seconds, 0.2513, 1e-3);
    EXPECT_NEAR(waited.longest_seconds, plan_flow(tube(), 2).seconds, 1e-9 * waited.longest_seconds);
    config.numerics.convergence->window = 0.5;   // and never after its duration
    EXPECT_DOUBLE_EQ(plan_flow(*build_frame(config), 2).seconds, waited.longest_seconds);
}

TEST(FinestSpacing, MoreBudgetIsNeverCoarserAndAlwaysKept) {
    double before = 1;
    for (double seconds = 1; seconds < 1e5; seconds *= 1.7) {
        const double dp = finest_spacing(tube(), {seconds, 1e12, 2}, 4e-3);
        EXPECT_LE(dp, before) << seconds;
        EXPECT_LE(plan_flow(tube(), 2, dp).seconds, seconds);
        EXPECT_GT(plan_flow(tube(), 2, dp / 1.11).seconds, seconds) << dp;   // two steps finer it is not
        before = dp;
    }
    EXPECT_LT(before, 0.2e-3);
}

TEST(FinestSpacing, MemoryBindsToo) {
    const double dp = finest_spacing(tube(), {1e9, 1e8, 2}, 4e-3);
    EXPECT_LE(plan_flow(tube(), 2, dp).memory, 1e8);
    EXPECT_GT(plan_flow(tube(), 2, dp / 1.11).memory, 1e8);
    EXPECT_EQ(finest_spacing(tube(), {1e-9, 1, 2}, 4e-3), 4e-3);   // none is paid for
}

}   // namespace
}   // namespace patency
