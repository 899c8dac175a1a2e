// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/outlets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;

// A coronary outlet in SI: R C = 0.8 s.
const Rcr rcr{2e9, 8e-11, 1e10, 700};

Coronary coronary() {
    return {3e9, 3e-12, 5e9, 3e-11, 3e9, 600, make_waveform(FourierSeries{6000, {-2000}, {3000}, 0.9})};
}

const std::vector<OutletModel> models{Resistance{1e10, 700}, rcr, coronary()};

double flow(double time) {
    const double phase = 2 * pi * time / 0.9;
    return 1e-6 + 0.7e-6 * std::sin(phase) + 0.2e-6 * std::cos(2 * phase);
}
constexpr double mean_flow = 1e-6;

enum class FlowShape { constant, linear };

/// State after marching `steps` equal steps over 0..end.
OutletState marched(const OutletModel& model, OutletState state, double end, int steps, FlowShape shape) {
    const double dt = end / steps;
    for (int i = 0; i < steps; ++i) {
        const TimeStep step{i * dt, dt};
        state = shape == FlowShape::constant ? advanced(model, state, step, flow((i + 0.5) * dt))
                                             : advanced(model, state, step, flow(i * dt), flow((i + 1) * dt));
    }
    return state;
}

TEST(Outlets, steady_state_is_the_sum_of_the_resistances) {
    const double q = 1.3e-6;
    EXPECT_NEAR(outlet_pressure(models[0], make_steady_state(models[0], q), q), 700 + 1e10 * q, 1e-9);
    EXPECT_NEAR(outlet_pressure(models[1], make_steady_state(models[1], q), q), 700 + 1.2e10 * q, 1e-9);
    EXPECT_NEAR(outlet_pressure(models[2], make_steady_state(models[2], q), q), 600 + 1.1e10 * q, 1e-9);
}

TEST(Outlets, steady_state_stays) {
    OutletModel still = coronary();
    std::get<Coronary>(still).myocardial_pressure = make_constant(5000);
    for (const OutletModel& model : {models[0], models[1], still}) {
        const OutletState steady = make_steady_state(model, 1.3e-6);
        for (double dt : {0.0, 1e-9, 1e-3, 1.0, 1e9}) {
            const OutletState next = advanced(model, steady, {0, dt}, 1.3e-6);
            for (int i = 0; i < 2; ++i) EXPECT_NEAR(next[i], steady[i], 1e-11 * 13000) << dt;
        }
    }
}

TEST(Outlets, rcr_relaxes_exponentially) {
    // THEORY (9.3): any step.
    for (double dt : {1e-6, 0.01, 0.8, 5.0}) {
        const double q = 0.4e-6, end = 700 + 1e10 * q;
        EXPECT_NEAR(advanced(rcr, {9000, 0}, {3.0, dt}, q)[0], end + (9000 - end) * std::exp(-dt / 0.8), 1e-9);
    }
}

TEST(Outlets, many_small_steps_are_one_large_step) {
    // Exact for inputs linear in time: twenty steps and one give the same but for round-off.
    Coronary model = coronary();
    model.myocardial_pressure =
        make_waveform(std::vector<double>{0, 2}, std::vector<double>{2000, 9000}, Interpolation::linear, Repeat::once);
    const auto q = [](double t) { return 1e-6 * (1 + 3 * t); };
    for (const OutletModel& m : {OutletModel(model), OutletModel(rcr)}) {
        const OutletState start{8000, 7000};
        OutletState small = start;
        for (int i = 0; i < 20; ++i) small = advanced(m, small, {i * 0.05, 0.05}, q(i * 0.05), q((i + 1) * 0.05));
        const OutletState large = advanced(m, start, {0, 1}, q(0), q(1));
        const int states = m.index() == 2 ? 2 : 1;
        for (int i = 0; i < states; ++i) EXPECT_NEAR(small[i], large[i], 1e-9);
    }
}

TEST(Outlets, step_satisfies_the_equations_of_the_coronary_bed) {
    // A small step against the right-hand sides written out; the remainder is of order (dt / 0.005 s)^2 of 1e4 Pa,
    // 0.005 s the fast time constant.
    const Coronary m = coronary();
    const OutletState x{9000, 7500};
    const double t = 0.2, dt = 1e-7, q = 1.1e-6, f = 2 * pi / 0.9;
    const double muscle_slope = f * (2000 * std::sin(f * t) + 3000 * std::cos(f * t));
    const double through = (x[0] - x[1]) / 5e9;
    const OutletState next = advanced(m, x, {t, dt}, q);
    EXPECT_NEAR((next[0] - x[0]) / dt, (q - through) / 3e-12, 20);
    EXPECT_NEAR((next[1] - x[1]) / dt, muscle_slope + (through - (x[1] - 600) / 3e9) / 3e-11, 20);
}

TEST(Outlets, periodic_flow_gives_the_impedance) {
    // After 30 periods (34 time constants) the start is forgotten; the linear flow over 1/400 of a period is off by
    // (w dt)^2 / 12 = 2e-5 of the amplitude of the flow for the first mode, four times that for the second.
    Coronary still = coronary();
    still.myocardial_pressure = make_constant(0);
    for (const OutletModel& model : {OutletModel(rcr), OutletModel(still)}) {
        const double period = 0.9, distal = model.index() == 1 ? 700 : 600;
        OutletState x = make_steady_state(model, mean_flow);
        x = marched(model, x, 30 * period, 30 * 400, FlowShape::linear);
        for (int i = 0; i < 400; ++i) {
            const double a = i * period / 400, b = (i + 1) * period / 400;
            x = advanced(model, x, {a, b - a}, flow(a), flow(b));
            const double w = 2 * pi / period;
            const auto z = [&](int k) { return impedance(model, k * w) * std::polar(1.0, k * w * b); };
            const double steady = distal + impedance(model, 0).real() * mean_flow;
            const double exact = steady + 0.7e-6 * z(1).imag() + 0.2e-6 * z(2).real();
            ASSERT_NEAR(outlet_pressure(model, x, flow(b)), exact, 1e-4 * 1e10 * 0.9e-6);
        }
    }
}

TEST(Outlets, second_order_in_the_step) {
    for (const OutletModel& model : {models[1], models[2]})
        for (FlowShape shape : {FlowShape::constant, FlowShape::linear}) {
            const OutletState start{9000, 7500};
            const double exact = marched(model, start, 0.7, 40000, FlowShape::linear)[0];
            const auto error = [&](int steps) { return std::abs(marched(model, start, 0.7, steps, shape)[0] - exact); };
            // Next term of the expansion: a tenth of an order at these steps (0.7 s / 200 below all time constants).
            EXPECT_NEAR(std::log2(error(400) / error(800)), 2.0, 0.1) << model.index();
        }
}

TEST(Outlets, huge_steps_are_stable) {
    for (const OutletModel& model : models) {
        OutletState x{1e6, -1e6};
        for (int i = 0; i < 100; ++i) x = advanced(model, x, {i * 1e6, 1e6}, 1e-6);
        EXPECT_GT(x[0], -1e5);
        EXPECT_LT(x[0], 1e5);
    }
    // Far beyond the time constant the Windkessel is its steady state.
    EXPECT_NEAR(advanced(rcr, {1e6, 0}, {0, 1e6}, 1e-6)[0], 700 + 1e4, 1e-9);
}

TEST(Outlets, stiff_and_soft_beds_keep_their_slow_time_constant) {
    // C_a a million times smaller than C_im: the arterial node follows at once, and the muscle empties through
    // R_v with R_v C_im; the eigenvalues are ten decades apart.
    const Coronary m{0, 1e-18, 5e6, 3e-11, 3e9, 0, make_constant(0)};
    const OutletState x = advanced(m, {1e4, 1e4}, {0, 0.09}, 0);
    EXPECT_NEAR(x[1], 1e4 * std::exp(-1.0), 1e-3);
    EXPECT_NEAR(x[0], x[1], 1e-3);
}

TEST(Outlets, response_is_the_pressure_at_the_end_of_the_step) {
    for (const OutletModel& model : models)
        for (double dt : {1e-5, 1e-2, 3.0})
            for (double q : {-1e-6, 0.0, 2e-6}) {
                const OutletState x = make_steady_state(model, 0.5e-6);
                const TimeStep step{0.3, dt};
                const OutletResponse constant = step_response(model, x, step);
                EXPECT_NEAR(constant.p0 + constant.dp_dq * q, outlet_pressure(model, advanced(model, x, step, q), q),
                            1e-8);
                const OutletResponse linear = step_response(model, x, step, 0.7e-6);
                EXPECT_NEAR(linear.p0 + linear.dp_dq * q,
                            outlet_pressure(model, advanced(model, x, step, 0.7e-6, q), q), 1e-8);
                EXPECT_GT(linear.dp_dq, 0);
                EXPECT_GE(constant.dp_dq, linear.dp_dq);
            }
}

TEST(Outlets, response_limits) {
    // A vanishing step feels the series resistance only, an endless one the sum of all.
    EXPECT_NEAR(step_response(rcr, {700, 0}, {0, 1e-12}).dp_dq, 2e9, 1e2);
    EXPECT_NEAR(step_response(rcr, {700, 0}, {0, 1e12}).dp_dq, 1.2e10, 1e-3);
    EXPECT_NEAR(step_response(coronary(), {700, 0}, {0, 1e12}).dp_dq, 1.1e10, 1e-3);
}

TEST(Outlets, squeeze_pushes_blood_out_of_the_bed) {
    // Rising muscle pressure raises the pressure the artery sees; falling pressure lowers it.
    Coronary m = coronary();
    const auto ramp = [&](double to) {
        m.myocardial_pressure = make_waveform(std::vector<double>{0, 1}, std::vector<double>{5000, to},
                                              Interpolation::linear, Repeat::once);
        return advanced(m, make_steady_state(m, 1e-6), {0, 0.1}, 1e-6)[0];
    };
    EXPECT_GT(ramp(9000), ramp(5000));
    EXPECT_LT(ramp(1000), ramp(5000));
}

TEST(Outlets, volume_is_conserved) {
    // What entered an RCR's compliance: int Q dt - int (p_c - p_d)/R_d dt = C (p_c(end) - p_c(begin)); the second
    // integral by Simpson's rule over the exact states inside one step.
    const double dt = 0.3, q0 = 0.5e-6, q1 = 1.7e-6;
    const auto pc = [&](double t) { return advanced(rcr, {6000, 0}, {0, t}, q0, q0 + (q1 - q0) * t / dt)[0]; };
    double leaked = 0;
    const int n = 100;
    for (int i = 0; i < n; ++i) {
        const double a = i * dt / n, h = dt / n;
        leaked += h / 6 * ((pc(a) - 700) + 4 * (pc(a + h / 2) - 700) + (pc(a + h) - 700)) / 1e10;
    }
    EXPECT_NEAR(8e-11 * (pc(dt) - 6000), 0.5 * (q0 + q1) * dt - leaked, 1e-18);
}

TEST(Outlets, refuses_what_cannot_be_a_vessel_bed) {
    for (const OutletModel& model : models) EXPECT_NO_THROW(expect_valid(model));
    EXPECT_THROW(expect_valid(Resistance{0}), DeckError);
    EXPECT_THROW(expect_valid(Rcr{-1, 1, 1}), DeckError);
    EXPECT_THROW(expect_valid(Rcr{1, 0, 1}), DeckError);
    EXPECT_THROW(expect_valid(Rcr{1, 1, std::nan("")}), DeckError);
    EXPECT_THROW(expect_valid(Rcr{1, 1, 1, std::nan("")}), DeckError);
    Coronary dry = coronary();
    dry.venous_resistance = 0;
    EXPECT_THROW(expect_valid(dry), DeckError);
}

}   // namespace
}   // namespace patency
