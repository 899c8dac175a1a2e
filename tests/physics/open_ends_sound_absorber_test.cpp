// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/sound_absorber.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace patency {
namespace {

constexpr double crossing = 1;   // L / c [s]

SoundAbsorber make_absorber() { return {.impedance = 4, .memory = 2 * crossing, .delay = 0.02 * crossing}; }

/// Share of a plane wave p_in = sin(2 pi t / period) that comes back from an imposed flow: there p = 2 p_in - z q, for what flows out
/// lowers the pressure by rho c times its velocity.
double returned_share(double period) {
    SoundAbsorber end = make_absorber();
    const double dt = 1e-3 * crossing, omega = 2 * std::numbers::pi / period;
    std::complex<double> wave{};
    double span = 0;
    for (double t = 0; t < 40 * period; t += dt) {
        const double in = std::sin(omega * t), pressure = 2 * in - end.impedance * end.let_out;
        end.hear(pressure, dt);
        if (t < 20 * period) continue;
        wave += (pressure - in) * std::polar(dt, -omega * t);
        span += dt;
    }
    return 2 * std::abs(wave) / span;
}

TEST(SoundAbsorber, LetsOutTheSlowestSwingOfAVessel) {
    EXPECT_LT(returned_share(4 * crossing), 0.2);         // a quarter wave, which comes back whole without it
    EXPECT_LT(returned_share(4.0 / 3 * crossing), 0.1);   // and its next
}

TEST(SoundAbsorber, HoldsTheFlowAgainstADrift) {
    // Slowly: a share of about 2 pi memory / period of the admittance is let out, and nearly all comes back.
    EXPECT_GT(returned_share(400 * crossing), 0.95);
    SoundAbsorber end = make_absorber();
    end.mean = 100;
    double let_out = 0;
    for (int k = 0; k < 40000; ++k) {
        end.hear(130, 1e-3 * crossing);   // a pressure that stays
        let_out += 1e-3 * crossing * end.let_out;
    }
    EXPECT_NEAR(end.let_out, 0, 1e-6);
    EXPECT_NEAR(end.mean, 130, 1e-4);
    EXPECT_NEAR(let_out, end.memory * 30 / end.impedance, 1e-2 * let_out);   // THEORY (8.12)
}

/// The same from an imposed pressure, p' = z (q - its mean) and z q = 2 p_in - p.
double returned_from_pressure(double period) {
    SoundAbsorber end{.impedance = 4, .memory = 0.5 * crossing};
    const double dt = 1e-3 * crossing, omega = 2 * std::numbers::pi / period;
    std::complex<double> wave{};
    double span = 0;
    for (double t = 0; t < 40 * period; t += dt) {
        const double in = std::sin(omega * t), q = in / end.impedance + 0.5 * end.mean,
                     pressure = end.impedance * (q - end.mean);
        end.follow(q, dt);
        if (t < 20 * period) continue;
        wave += (pressure - in) * std::polar(dt, -omega * t);
        span += dt;
    }
    return 2 * std::abs(wave) / span;
}

TEST(SoundAbsorber, LetsSoundOutAtAPressure) {
    EXPECT_LT(returned_from_pressure(2 * crossing), 0.35);   // half a wave between two pressures
    EXPECT_LT(returned_from_pressure(4 * crossing), 0.6);    // a quarter: the other end takes more of it
    EXPECT_GT(returned_from_pressure(400 * crossing), 0.95);
}

TEST(SoundAbsorber, HearsNothingInAPressureThatIsItsMean) {
    SoundAbsorber end = make_absorber();
    end.mean = 80;
    for (int k = 0; k < 100; ++k) end.hear(80, 0.1);
    EXPECT_EQ(end.let_out, 0);
    EXPECT_EQ(end.mean, 80);
}

}   // namespace
}   // namespace patency
