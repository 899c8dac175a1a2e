// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace patency {
namespace {

struct Stent {
    double radius = 1e-3, speed = 0;
    RadialLoad load{.pumped = [](double t) { return t; },
                    .radius = [this] { return radius; },
                    .speed = [this] { return speed; },
                    .most = 8e6,
                    .mass_by_area = 3};
};

TEST(RadialLoad, RisesWithTheLagAsFarAsItMay) {
    Stent stent;
    const RadialLoad& load = stent.load;
    EXPECT_EQ(load.pressure(0.9e-3), 0) << "the stent is ahead";
    EXPECT_EQ(load.pressure(1e-3), 0);
    EXPECT_NEAR(load.pressure(1e-3 * (1 + RadialLoad::full_lag / 4)), 2e6, 1);
    EXPECT_EQ(load.pressure(1.5e-3), 8e6) << "and no more";
    stent.speed = 1;
    EXPECT_LT(load.pressure(1.02e-3), 0.4 * 8e6);
    stent.speed = 1e3;
    EXPECT_EQ(load.pressure(1.5e-3), 0) << "it pushes and does not pull";
    stent.radius = 1.6e-3, stent.speed = -1e3;
    EXPECT_EQ(load.pressure(1.5e-3), 0) << "nothing is pumped so far";
    stent.load.filled = 1.4e-3, stent.radius = 1.39e-3, stent.speed = 0;
    EXPECT_NEAR(load.pressure(1.5e-3), 8e6 * 0.01 / 1.39 / RadialLoad::full_lag, 1) << "no more is pumped in";
    EXPECT_EQ(load.pressure(1.38e-3), 0) << "but out";
}

/// A mass that yields under one pressure opens as fast as the fluid is pumped, and does not swing about that.
TEST(RadialLoad, KeepsWhatYieldsAtItsSpeed) {
    Stent stent;
    constexpr double yield = 2e6, speed = 0.25, dt = 1e-7, end = 2e-3;
    stent.load.pumped = [](double t) { return 1e-3 + speed * t; };
    double least = INFINITY, most = 0;
    for (double t = 0; t < end; t += dt) {
        const double push = stent.load.pressure(t);
        if (t > 0.2 * end) least = std::min(least, push), most = std::max(most, push);
        stent.speed = std::max(0.0, stent.speed + dt * (push - yield) / stent.load.mass_by_area);
        stent.radius += dt * stent.speed;
    }
    EXPECT_NEAR(stent.speed, speed / (1 + RadialLoad::full_lag * yield / 8e6),
                0.01 * speed);   // the lag grows with the radius
    EXPECT_GT(least, 0.99 * yield);
    EXPECT_LT(most, 1.01 * yield);
    // And stops where no more is pumped in, but for the way on which the damper takes its speed.
    const double filled_at = stent.radius;
    stent.load.fill(end);
    for (double t = end; t < 2 * end; t += dt) {
        stent.speed = std::max(0.0, stent.speed + dt * (stent.load.pressure(t) - yield) / stent.load.mass_by_area);
        stent.radius += dt * stent.speed;
    }
    EXPECT_EQ(stent.speed, 0);
    const double frequency = std::sqrt(8e6 / (RadialLoad::full_lag * filled_at) / stent.load.mass_by_area);
    EXPECT_LT(stent.radius - filled_at, 0.5 * speed / frequency);
}

}   // namespace
}   // namespace patency
