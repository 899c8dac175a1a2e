// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/developed_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace patency {
namespace {

constexpr double radius = 2e-3, viscosity = 3.3e-6;
const std::vector<double> places = {0, 0.3, 0.6, 0.9, 0.98};

TEST(DevelopedFlow, AtRestInTimeIsTheParabola) {
    for (const Section section : {Section::circular, Section::planar}) {
        const DevelopedFlow flow(section, radius, viscosity);
        for (const double s : places) {
            EXPECT_NEAR(flow.unit(s), parabola_profile(section, s), 2e-4);
            EXPECT_EQ(flow.rest(s), 0);
        }
        EXPECT_EQ(flow.unit(1), 0);
    }
}

TEST(DevelopedFlow, StaysWhereItHasSettled) {
    DevelopedFlow flow(Section::circular, radius, viscosity);
    std::vector<double> speeds;
    for (const double s : places) speeds.push_back(0.2 * parabola_profile(Section::circular, s));
    flow.start_from(places, speeds, 0.2);   // a parabola is found whatever the places
    for (int k = 0; k < 3; ++k) {
        flow.begin_step(TimeRate::of_steps(1e-2, k == 0 ? 0 : 1e-2));
        for (const double s : places)
            EXPECT_NEAR(flow.rest(s) + 0.2 * flow.unit(s), 0.2 * parabola_profile(Section::circular, s), 1e-4);
        flow.end_step(0.2);
    }
}

/// The largest difference from Womersley's profile over the last of some periods, over the mean speed's amplitude.
double error_of(Section section, double alpha, int steps, int periods) {
    const double omega = alpha * alpha * viscosity / (radius * radius), dt = 2 * std::numbers::pi / omega / steps;
    const WomersleyMode mode(section, alpha);
    DevelopedFlow flow(section, radius, viscosity);
    double worst = 0;
    for (int k = 1; k <= periods * steps; ++k) {
        const double mean = std::cos(omega * k * dt);
        flow.begin_step(TimeRate::of_steps(dt, k == 1 ? 0 : dt));
        if (k > (periods - 1) * steps)
            for (const double s : places) {
                const double exact = (mode.shape(s) * std::polar(1.0, omega * k * dt)).real();
                worst = std::max(worst, std::abs(flow.rest(s) + mean * flow.unit(s) - exact));
            }
        flow.end_step(mean);
    }
    return worst;
}

TEST(DevelopedFlow, OfAnOscillationIsWomersleysProfile) {
    for (const Section section : {Section::circular, Section::planar})
        for (const double alpha : {1.0, 2.8, 5.0, 12.0}) EXPECT_LT(error_of(section, alpha, 400, 12), 2e-3) << alpha;
    EXPECT_GT(error_of(Section::circular, 5, 50, 4),
              10 * error_of(Section::circular, 5, 200, 4));   // of second order in time
}

TEST(DevelopedFlow, GoesOnFromItsState) {
    DevelopedFlow one(Section::circular, radius, viscosity), other = one;
    const auto step = [](DevelopedFlow& flow, double mean) {
        flow.begin_step(TimeRate::of_steps(1e-2, 1e-2));
        flow.end_step(mean);
    };
    step(one, 0.1), step(one, 0.3);
    other.restore(one.state());
    step(one, 0.2), step(other, 0.2);
    EXPECT_EQ(one.state(), other.state());
}

TEST(TimeRate, IsExactForParabolasInTime) {
    const double dt = 0.3, before = 0.2, t = 1.7;
    const TimeRate rate = TimeRate::of_steps(dt, before);
    const auto f = [](double x) { return 2 - 3 * x + 5 * x * x; };
    EXPECT_NEAR(rate.now * f(t) + rate.last * f(t - dt) + rate.before * f(t - dt - before), -3 + 10 * t, 1e-12);
}

}   // namespace
}   // namespace patency
