// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/outlets.h"

#include <cmath>
#include <string>

#include "patency/base/errors.h"

namespace patency {
namespace {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;   // g++ does without, older clang does not

// For x' = a x + g + g' s over a step h and z = a h:  x(h) = e^z x(0) + h phi_1(z) g + h^2 phi_2(z) g'
// (exponential integrators; Hochbruck and Ostermann, Acta Numerica 19, 2010).
double phi1(double z) { return z == 0 ? 1.0 : std::expm1(z) / z; }
double phi2(double z) {
    if (std::abs(z) > 0.5) return (phi1(z) - 1) / z;
    double term = 0.5, sum = 0.5;   // 1/2! + z/3! + z^2/4! + ...: the difference above cancels for small z
    for (int k = 3; k < 20; ++k) sum += term *= z / k;
    return sum;
}

/// x(end) = free + begin Q_begin + end Q_end.
struct StepMap {
    OutletState free, begin, end;
};

/// C x' = Q - (x - p_d) / R: the flow enters as g = Q_begin / C, g' = (Q_end - Q_begin) / (C h).
StepMap make_map(const Rcr& m, const OutletState& x, TimeStep step) {
    const double h = step.length, z = -h / (m.distal_resistance * m.compliance);
    const double rise = h / m.compliance * phi2(z);
    return {{m.distal_pressure + (x[0] - m.distal_pressure) * std::exp(z), 0},
            {h / m.compliance * phi1(z) - rise, 0},
            {rise, 0}};
}

StepMap make_map(const Resistance& m, const OutletState&, TimeStep) { return {{m.distal_pressure, 0}, {}, {}}; }

/// In y = (sqrt(C_a) p_1, sqrt(C_im) (p_2 - p_im)) the two equations have a symmetric negative definite matrix; along
/// its two orthogonal axes they are two independent equations, each solved as above.
StepMap make_map(const Coronary& m, const OutletState& x, TimeStep step) {
    const double h = step.length;
    const double a = std::sqrt(m.arterial_compliance), b = std::sqrt(m.myocardial_compliance);
    const double g_am = 1 / m.microvascular_resistance, g_v = 1 / m.venous_resistance;
    const double m11 = -g_am / (a * a), m12 = g_am / (a * b), m22 = -(g_am + g_v) / (b * b);
    const double angle = 0.5 * std::atan2(2 * m12, m11 - m22);
    const double c = std::cos(angle), s = std::sin(angle);
    // Eigenvalues: the fast one from the trace, the slow one from the determinant, which would cancel otherwise.
    const double fast = 0.5 * (m11 + m22) - std::hypot(0.5 * (m11 - m22), m12);
    const double slow = g_am * g_v / (a * a * b * b) / fast;

    const double muscle_begin = m.myocardial_pressure(step.begin);
    const double muscle_end = m.myocardial_pressure(step.begin + h);
    // Right-hand sides (g at the begin, g at the end) of the known inputs and of a unit flow.
    const auto known = [&](double muscle) {
        return OutletState{g_am * muscle / a, (g_v * (m.venous_pressure - muscle) - g_am * muscle) / b};
    };
    const OutletState known_begin = known(muscle_begin), known_end = known(muscle_end);
    const OutletState y{a * x[0], b * (x[1] - muscle_begin)};

    StepMap map{{0, muscle_end}, {}, {}};
    const auto add_axis = [&](double eigenvalue, double e1, double e2) {
        const double z = eigenvalue * h;
        const double to_end = h * phi2(z), to_begin = h * phi1(z) - to_end;
        const double free = std::exp(z) * (e1 * y[0] + e2 * y[1]) +
                            to_begin * (e1 * known_begin[0] + e2 * known_begin[1]) +
                            to_end * (e1 * known_end[0] + e2 * known_end[1]);
        const OutletState back{e1 / a, e2 / b};
        for (int i = 0; i < 2; ++i) {
            map.free[i] += back[i] * free;
            map.begin[i] += back[i] * to_begin * e1 / a;
            map.end[i] += back[i] * to_end * e1 / a;
        }
    };
    add_axis(slow, c, s);   // atan2 puts the larger eigenvalue, the slow one, on this axis
    add_axis(fast, -s, c);
    return map;
}

StepMap make_map(const OutletModel& model, const OutletState& state, TimeStep step) {
    return std::visit([&](const auto& m) { return make_map(m, state, step); }, model);
}

/// What lies between the opening and the first capacitor.
double series_resistance(const OutletModel& model) {
    return std::visit(
        Overloaded{[](const Resistance& m) { return m.resistance; }, [](const Rcr& m) { return m.proximal_resistance; },
                   [](const Coronary& m) { return m.arterial_resistance; }},
        model);
}

void expect_positive(double value, const char* what) {
    if (!(std::isfinite(value) && value > 0))
        throw DeckError(std::string("an outlet's ") + what + " must be positive, not " + std::to_string(value));
}
void expect_not_negative(double value, const char* what) {
    if (!(std::isfinite(value) && value >= 0))
        throw DeckError(std::string("an outlet's ") + what + " must not be negative, and is " + std::to_string(value));
}
void expect_finite(double value, const char* what) {
    if (!std::isfinite(value)) throw DeckError(std::string("an outlet's ") + what + " is not a finite number");
}

}   // namespace

void expect_valid(const OutletModel& model) {
    std::visit(Overloaded{[](const Resistance& m) {
                              expect_positive(m.resistance, "resistance");
                              expect_finite(m.distal_pressure, "distal pressure");
                          },
                          [](const Rcr& m) {
                              expect_not_negative(m.proximal_resistance, "proximal resistance");
                              expect_positive(m.compliance, "compliance");
                              expect_positive(m.distal_resistance, "distal resistance");
                              expect_finite(m.distal_pressure, "distal pressure");
                          },
                          [](const Coronary& m) {
                              expect_not_negative(m.arterial_resistance, "arterial resistance");
                              expect_positive(m.arterial_compliance, "arterial compliance");
                              expect_positive(m.microvascular_resistance, "microvascular resistance");
                              expect_positive(m.myocardial_compliance, "myocardial compliance");
                              expect_positive(m.venous_resistance, "venous resistance");
                              expect_finite(m.venous_pressure, "venous pressure");
                          }},
               model);
}

OutletState make_steady_state(const OutletModel& model, double flow) {
    return std::visit(Overloaded{[](const Resistance& m) {
                                     return OutletState{m.distal_pressure, 0};
                                 },
                                 [&](const Rcr& m) {
                                     return OutletState{m.distal_pressure + m.distal_resistance * flow, 0};
                                 },
                                 [&](const Coronary& m) {
                                     const double p2 = m.venous_pressure + m.venous_resistance * flow;
                                     return OutletState{p2 + m.microvascular_resistance * flow, p2};
                                 }},
                      model);
}

OutletState make_periodic_state(const OutletModel& model, const Waveform& pressure, double period) {
    if (std::holds_alternative<Resistance>(model)) return make_steady_state(model, 0);
    constexpr int steps = 400;   // each exact for a constant flow
    const auto after_a_period = [&](OutletState state) {
        for (int k = 0; k < steps; ++k) {
            const TimeStep step{k * period / steps, period / steps};
            const OutletResponse answer = step_response(model, state, step);
            const double flow = (pressure(step.begin + step.length) - answer.p0) / answer.dp_dq;
            state = advanced(model, state, step, flow);
        }
        return state;
    };
    // x(T) = f + M x(0), and x(T) = x(0) is wanted.
    const OutletState free = after_a_period({0, 0}), a = after_a_period({1, 0}), b = after_a_period({0, 1});
    const double m11 = 1 - (a[0] - free[0]), m21 = -(a[1] - free[1]), m12 = -(b[0] - free[0]),
                 m22 = 1 - (b[1] - free[1]), determinant = m11 * m22 - m12 * m21;
    return {(free[0] * m22 - m12 * free[1]) / determinant, (m11 * free[1] - m21 * free[0]) / determinant};
}

double outlet_pressure(const OutletModel& model, const OutletState& state, double flow) {
    return state[0] + series_resistance(model) * flow;
}

OutletState advanced(const OutletModel& model, const OutletState& state, TimeStep step, double flow_begin,
                     double flow_end) {
    const StepMap map = make_map(model, state, step);
    OutletState next;
    for (int i = 0; i < 2; ++i) next[i] = map.free[i] + map.begin[i] * flow_begin + map.end[i] * flow_end;
    return next;
}

OutletState advanced(const OutletModel& model, const OutletState& state, TimeStep step, double flow) {
    return advanced(model, state, step, flow, flow);
}

OutletResponse step_response(const OutletModel& model, const OutletState& state, TimeStep step) {
    const StepMap map = make_map(model, state, step);
    return {map.free[0], map.begin[0] + map.end[0] + series_resistance(model)};
}

OutletResponse step_response(const OutletModel& model, const OutletState& state, TimeStep step, double flow_begin) {
    const StepMap map = make_map(model, state, step);
    return {map.free[0] + map.begin[0] * flow_begin, map.end[0] + series_resistance(model)};
}

std::complex<double> impedance(const OutletModel& model, double angular_frequency) {
    using Complex = std::complex<double>;
    const Complex iw{0, angular_frequency};
    return std::visit(Overloaded{[](const Resistance& m) { return Complex{m.resistance}; },
                                 [&](const Rcr& m) {
                                     const double distal = m.distal_resistance;
                                     return m.proximal_resistance + distal / (1.0 + iw * distal * m.compliance);
                                 },
                                 [&](const Coronary& m) {
                                     const double vein = m.venous_resistance;
                                     const Complex muscle = vein / (1.0 + iw * vein * m.myocardial_compliance);
                                     const Complex bed = m.microvascular_resistance + muscle;
                                     return m.arterial_resistance + bed / (1.0 + iw * m.arterial_compliance * bed);
                                 }},
                      model);
}

}   // namespace patency
