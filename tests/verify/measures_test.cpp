// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace patency {
namespace {

using Numbers = std::vector<double>;
constexpr double pi = std::numbers::pi;

TEST(Measures, rmsep_is_local_and_l2_is_not) {
    const Numbers exact{1, 2, 4}, computed{1.01, 2.02, 4.04};
    EXPECT_NEAR(rmsep_percent(computed, exact), 1, 1e-10);
    EXPECT_NEAR(l2_percent(computed, exact, 4), 100 * std::sqrt((0.01 * 0.01 + 0.02 * 0.02 + 0.04 * 0.04) / 3) / 4,
                1e-10);
    EXPECT_EQ(rmsep_percent(exact, exact), 0);
    EXPECT_EQ(l2_percent(exact, exact, 4), 0);
}

TEST(Measures, order_of_a_power) {
    EXPECT_NEAR(observed_order(3 * std::pow(0.1, 1.7), 0.1, 3 * std::pow(0.02, 1.7), 0.02), 1.7, 1e-12);
}

TEST(Measures, extrapolates_a_parabola_and_bounds_its_error) {
    const auto value = [](double h) { return 7 + 2 * h * h; };
    const SpacingStudy study{{0.4, 0.3, 0.2}, {value(0.4), value(0.3), value(0.2)}};
    EXPECT_NEAR(study.extrapolated(), 7, 1e-12);
    EXPECT_NEAR(study.convergence_index_percent(), 1.25 * 100 * (value(0.2) - 7) / value(0.2), 1e-10);
    const SpacingStudy rough{{0.4, 0.3, 0.2},
                             {value(0.4) + 1, value(0.3), value(0.2)}};   // what the coarse ones say counts as well
    EXPECT_NEAR(rough.convergence_index_percent(), 1.25 * 100 * (1 + 2 * 0.07) / 0.07 * 0.04 / value(0.2), 1e-10);
}

TEST(Measures, amplitude_of_a_wave_among_others) {
    // Two whole periods, uneven samples: t = 2 x + 0.1 sin(2 pi x) / pi still covers 0..2 smoothly and periodically, so
    // the sum converges fast; 400 samples leave (w h)^2 / 12 = 8e-5 at worst.
    Numbers times, values;
    const double w = 2 * pi;
    for (int i = 0; i <= 400; ++i) {
        const double x = i / 400.0, t = 2 * x + 0.1 * std::sin(2 * pi * x) / pi;
        times.push_back(t);
        values.push_back(5 + 3 * std::cos(w * t) - 4 * std::sin(w * t) + 2 * std::cos(3 * w * t));
    }
    const auto a = amplitude(times, values, w);
    EXPECT_NEAR(a.real(), 3, 1e-3);
    EXPECT_NEAR(a.imag(), 4, 1e-3);
}

TEST(Measures, decay_of_an_exponential) {
    Numbers times, values;
    for (double t : {0.0, 0.1, 0.5, 0.7, 2.0}) {
        times.push_back(t);
        values.push_back(7 * std::exp(-3.2 * t));
    }
    EXPECT_NEAR(decay_rate(times, values), 3.2, 1e-12);
}

}   // namespace
}   // namespace patency
