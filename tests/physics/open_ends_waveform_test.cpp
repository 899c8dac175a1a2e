// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/waveform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "patency/base/errors.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;
using Numbers = std::vector<double>;

const Numbers times{0.1, 0.3, 0.4, 0.9}, values{1, 3, -2, 1};

Waveform table(Interpolation interpolation, Repeat repeat) {
    return make_waveform(times, values, interpolation, repeat);
}

Numbers sampled(std::size_t count, double (*f)(double), double period) {
    Numbers v;
    for (std::size_t i = 0; i <= count; ++i) v.push_back(f(period * double(i) / double(count)));
    return v;
}

/// Gauss-Legendre of three points on many pieces; cubics are exact when no piece contains a kink.
double quadrature(const Waveform& f, double a, double b, int pieces) {
    double sum = 0;
    const double h = (b - a) / pieces, x = std::sqrt(0.6);
    for (int i = 0; i < pieces; ++i) {
        const double m = a + (i + 0.5) * h;
        sum += h / 18 * (5 * f(m - x * h / 2) + 8 * f(m) + 5 * f(m + x * h / 2));
    }
    return sum;
}

TEST(Waveform, passes_through_its_table) {
    for (auto interpolation : {Interpolation::linear, Interpolation::monotone_cubic})
        for (auto repeat : {Repeat::periodic, Repeat::once}) {
            const Waveform f = table(interpolation, repeat);
            for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(f(times[i]), values[i], 1e-14);
        }
}

TEST(Waveform, linear_is_linear) {
    const Waveform f = table(Interpolation::linear, Repeat::periodic);
    EXPECT_NEAR(f(0.2), 2, 1e-14);
    EXPECT_NEAR(f(0.35), 0.5, 1e-14);
}

TEST(Waveform, repeats_both_ways) {
    for (auto interpolation : {Interpolation::linear, Interpolation::monotone_cubic}) {
        const Waveform f = table(interpolation, Repeat::periodic);
        EXPECT_DOUBLE_EQ(f.period().value(), 0.8);
        for (double t = 0.1; t < 0.9; t += 0.07)
            for (int turns : {-3, -1, 1, 1000}) EXPECT_NEAR(f(t + turns * 0.8), f(t), 1e-10);   // 800 s eps / 0.1 s
    }
}

TEST(Waveform, played_once_holds_its_ends) {
    const Waveform f = table(Interpolation::monotone_cubic, Repeat::once);
    EXPECT_EQ(f(-5), 1);
    EXPECT_NEAR(f(7), 1, 1e-14);
    EXPECT_FALSE(f.period());
}

TEST(Waveform, cubic_has_no_overshoot_and_a_continuous_slope) {
    const Waveform f = table(Interpolation::monotone_cubic, Repeat::periodic);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        const double step = (times[i + 1] - times[i]) / 100, rise = values[i + 1] - values[i];
        for (int k = 0; k < 100; ++k) EXPECT_GE((f(times[i] + (k + 1) * step) - f(times[i] + k * step)) * rise, -1e-14);
    }
    for (double t : times) {
        // One-sided differences at distance d agree to O(d f''), f'' below 6 * 5 / 0.1^2.
        const double d = 1e-7;
        EXPECT_NEAR((f(t + d) - f(t)) / d, (f(t) - f(t - d)) / d, 3000 * d + 1e-7);
    }
}

TEST(Waveform, cubic_converges_faster_than_linear) {
    // Away from extrema the harmonic-mean slope is second order, so the values are third order; near extrema
    // monotonicity costs an order. In the mean over the period: order 2 for linear, at least 2.5 for the cubic.
    const auto error = [](std::size_t count, Interpolation interpolation) {
        const auto wave = [](double t) { return std::sin(2 * pi * t); };
        Numbers t = sampled(
                    count, [](double x) { return x; }, 1),
                v = sampled(count, wave, 1);
        const Waveform f = make_waveform(t, v, interpolation, Repeat::periodic);
        double sum = 0;
        for (int i = 0; i < 10000; ++i) sum += std::abs(f(i / 1e4) - wave(i / 1e4)) / 1e4;
        return sum;
    };
    const auto order = [&](Interpolation i) { return std::log2(error(40, i) / error(80, i)); };
    EXPECT_NEAR(order(Interpolation::linear), 2.0, 0.1);
    EXPECT_GT(order(Interpolation::monotone_cubic), 2.5);
    EXPECT_LT(error(80, Interpolation::monotone_cubic), 0.25 * error(80, Interpolation::linear));
}

TEST(Waveform, mean_is_the_integral) {
    for (auto interpolation : {Interpolation::linear, Interpolation::monotone_cubic})
        for (auto repeat : {Repeat::periodic, Repeat::once}) {
            const Waveform f = table(interpolation, repeat);
            EXPECT_NEAR(f.mean(), quadrature(f, 0.1, 0.9, 8) / 0.8, 1e-13);   // the pieces end on the table's times
            EXPECT_NEAR(f.mean(-0.5, 1.6), quadrature(f, -0.5, 1.6, 21) / 2.1, 1e-13);
        }
    const Waveform s = make_waveform(FourierSeries{2, {1, 0.5}, {-1, 3}, 0.7});
    EXPECT_EQ(s.mean(), 2);
    EXPECT_NEAR(s.mean(0.1, 0.3), quadrature(s, 0.1, 0.3, 100) / 0.2, 1e-12);
}

TEST(Waveform, linear_mean_by_hand) {
    // 0.2 (1+3)/2 + 0.1 (3-2)/2 + 0.5 (-2+1)/2 = 0.4 + 0.05 - 0.25 = 0.2; over 0.8.
    EXPECT_NEAR(table(Interpolation::linear, Repeat::periodic).mean(), 0.25, 1e-15);
}

TEST(Waveform, fourier_series_and_amplitudes_are_the_formula) {
    FourierSeries series{1.5, {2, 0}, {0, -3}, 0.5};
    const Waveform f = make_waveform(series);
    for (double t : {-0.3, 0.0, 0.2, 5.1})
        EXPECT_NEAR(f(t), 1.5 + 2 * std::cos(4 * pi * t) - 3 * std::sin(8 * pi * t), 1e-12);
    EXPECT_NEAR(series.frequency(2), 8 * pi, 1e-14);
    const double phase = series.frequency(2) * 0.07;
    EXPECT_NEAR((series.amplitude(2) * std::polar(1.0, phase)).real(), -3 * std::sin(phase), 1e-14);
    series.set_amplitude(1, {0.25, -4});
    EXPECT_EQ(series.cosines[0], 0.25);
    EXPECT_EQ(series.sines[0], 4);
}

TEST(Waveform, modes_of_a_series_come_back) {
    const FourierSeries series{1.5, {2, 0, 0.1}, {0, -3, 0.2}, 0.8};
    const FourierSeries back = make_fourier_series(make_waveform(series), 4);
    EXPECT_NEAR(back.mean, 1.5, 1e-14);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(back.cosines[k], series.cosines[k], 1e-12);
        EXPECT_NEAR(back.sines[k], series.sines[k], 1e-12);
    }
    EXPECT_NEAR(back.cosines[3], 0, 1e-12);
}

TEST(Waveform, modes_of_a_triangle) {
    // Triangle of height 1 over a period: mean 1/2, cosines -4/(pi k)^2 for odd k. Folding adds the modes that differ
    // by the number of samples: about 2 * 4/(pi 4096)^2 = 5e-8.
    const Waveform f = make_waveform(Numbers{0, 1, 2}, Numbers{0, 1, 0}, Interpolation::linear, Repeat::periodic);
    const FourierSeries series = make_fourier_series(f, 5);
    EXPECT_EQ(series.period, 2);
    for (int k = 1; k <= 5; ++k) {
        EXPECT_NEAR(series.cosines[k - 1], k % 2 ? -4 / (pi * pi * k * k) : 0, 1e-7);
        EXPECT_NEAR(series.sines[k - 1], 0, 1e-12);
    }
}

TEST(Waveform, constant) {
    const Waveform f = make_constant(3);
    EXPECT_EQ(f(-1), 3);
    EXPECT_EQ(f(1e9), 3);
    EXPECT_EQ(f.mean(), 3);
    EXPECT_EQ(f.mean(1, 2), 3);
    EXPECT_FALSE(f.period());
    EXPECT_TRUE(f.is_constant());
    EXPECT_EQ(make_fourier_series(f, 3).modes(), 0u);
    EXPECT_EQ(Waveform()(1), 0);
}

TEST(Waveform, period_longer_than_the_table_closes_it) {
    const Waveform f = make_waveform(Numbers{0, 1}, Numbers{0, 2}, Interpolation::linear, Repeat::periodic, 2.0);
    EXPECT_DOUBLE_EQ(f(1.5), 1);
    EXPECT_DOUBLE_EQ(f(3.5), 1);
}

TEST(Waveform, rounding_at_the_seam_is_forgiven) {
    const Waveform f = make_waveform(Numbers{0, 1, 2}, Numbers{1, 5, 1.002}, Interpolation::linear, Repeat::periodic);
    EXPECT_EQ(f(2 - 1e-12), f(2 + 1e-12));
}

TEST(Waveform, refuses_what_is_not_a_function_of_time) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto make = [](Numbers t, Numbers v, Repeat r = Repeat::once, std::optional<double> period = {}) {
        return make_waveform(t, v, Interpolation::linear, r, period);
    };
    EXPECT_THROW(make({0}, {1}), DeckError);
    EXPECT_THROW(make({}, {}), DeckError);
    EXPECT_THROW(make({0, 1}, {1}), DeckError);
    EXPECT_THROW(make({0, 1, 1}, {1, 2, 3}), DeckError);
    EXPECT_THROW(make({0, 2, 1}, {1, 2, 3}), DeckError);
    EXPECT_THROW(make({0, nan}, {1, 2}), DeckError);
    EXPECT_THROW(make({0, 1}, {1, nan}), DeckError);
    EXPECT_THROW(make({0, 1}, {1, std::numeric_limits<double>::infinity()}), DeckError);
    EXPECT_THROW(make({0, 1}, {1, 2}, Repeat::periodic), DeckError);        // does not close
    EXPECT_THROW(make({0, 1}, {1, 1}, Repeat::periodic, 0.5), DeckError);   // longer than its period
    EXPECT_THROW(make({0, 1}, {1, 1}, Repeat::periodic, -1.0), DeckError);
    EXPECT_THROW(make({0, 1}, {1, 1}, Repeat::once, 1.0), DeckError);
    EXPECT_THROW(make_constant(nan), DeckError);
    EXPECT_THROW(make_waveform(FourierSeries{0, {1}, {}, 1}), DeckError);
    EXPECT_THROW(make_waveform(FourierSeries{0, {1}, {nan}, 1}), DeckError);
    EXPECT_THROW(make_waveform(FourierSeries{0, {1}, {1}, 0}), DeckError);
    EXPECT_THROW(make_fourier_series(make({0, 1}, {1, 2}), 2), DeckError);
}

TEST(SmoothRamp, rises_once_from_zero_to_one) {
    EXPECT_EQ(smooth_ramp(-1, 2), 0);
    EXPECT_EQ(smooth_ramp(0, 2), 0);
    EXPECT_NEAR(smooth_ramp(1, 2), 0.5, 1e-15);
    EXPECT_EQ(smooth_ramp(2, 2), 1);
    EXPECT_EQ(smooth_ramp(0, 0), 1);
    for (double t = 0; t < 2; t += 0.01) EXPECT_LT(smooth_ramp(t, 2), smooth_ramp(t + 0.01, 2));
    EXPECT_NEAR(smooth_ramp(1e-4, 2), 0.25 * pi * pi * 0.25e-8, 1e-15);   // no jump of slope: (pi t / 2T)^2
}

}   // namespace
}   // namespace patency
