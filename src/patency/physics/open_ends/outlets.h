// SPDX-License-Identifier: Apache-2.0
// What lies behind an opening: 0-D models that turn the flow out of it into the pressure on it. One step is exact for a
// flow (and an intramyocardial pressure) that is constant or linear in time over the step, so it is stable for any step.
// Knows no particles; the state of a model is two numbers that the caller keeps. THEORY section 9.
#pragma once

#include <array>
#include <complex>
#include <variant>

#include "patency/physics/open_ends/waveform.h"

namespace patency {

/// p = p_d + R Q. THEORY (9.1).
struct Resistance {
    double resistance;            // R, Pa s/m3
    double distal_pressure = 0;   // p_d, Pa
};

/// p = p_c + R_p Q,  C dp_c/dt = Q - (p_c - p_d) / R_d: three-element Windkessel, THEORY (9.2).
struct Rcr {
    double proximal_resistance;   // R_p, Pa s/m3, >= 0
    double compliance;            // C, m3/Pa
    double distal_resistance;     // R_d, Pa s/m3
    double distal_pressure = 0;   // p_d, Pa
};

/// Coronary bed with the heart muscle's squeeze (Kim et al., Ann Biomed Eng 38, 2010; open loop), THEORY (9.5):
///   p = p_1 + R_a Q                                arteries
///   C_a dp_1/dt = Q - (p_1 - p_2) / R_am           arterial compliance against the atmosphere
///   C_im d(p_2 - p_im)/dt = (p_1 - p_2) / R_am - (p_2 - p_v) / R_v    small vessels inside the muscle
struct Coronary {
    double arterial_resistance;        // R_a, Pa s/m3, >= 0
    double arterial_compliance;        // C_a, m3/Pa
    double microvascular_resistance;   // R_am, Pa s/m3
    double myocardial_compliance;      // C_im, m3/Pa
    double venous_resistance;          // R_v, Pa s/m3
    double venous_pressure = 0;        // p_v, Pa
    Waveform myocardial_pressure;      // p_im(t), Pa
};

using OutletModel = std::variant<Resistance, Rcr, Coronary>;

/// The capacitor pressures [Pa]. Resistance: (p_d, 0). Rcr: (p_c, 0). Coronary: (p_1, p_2).
using OutletState = std::array<double, 2>;

/// Pressure at the end of a step as a function of the flow of the step, p = p0 + dp_dq Q: what a flow solver needs to
/// find flow and pressure together.
struct OutletResponse {
    double p0;      // Pa
    double dp_dq;   // Pa s/m3, >= 0
};

/// A step from `begin` to `begin + length` [s], length >= 0.
struct TimeStep {
    double begin, length;
};

/// @throws DeckError if a resistance or compliance is not positive (R_p and R_a may be zero) or a number not finite.
void expect_valid(const OutletModel& model);

/// The state that a flow [m3/s] held for ever leads to, with p_im held at any value. A good start for a periodic flow
/// is the state of its mean.
OutletState make_steady_state(const OutletModel& model, double flow);

/// The state at time 0 that repeats after `period` [s] when the pressure on the opening [Pa] does: linear models, so three periods
/// tell it. THEORY (9.13).
OutletState make_periodic_state(const OutletModel& model, const Waveform& pressure, double period);

/// Pressure on the opening [Pa] at an instant, flow [m3/s] positive out of the domain.
double outlet_pressure(const OutletModel& model, const OutletState& state, double flow);

/// State at the end of a step over which the flow goes linearly from flow_begin to flow_end [m3/s]. Exact then; of
/// second order for any smooth flow.
OutletState advanced(const OutletModel& model, const OutletState& state, TimeStep step, double flow_begin,
                     double flow_end);
/// The same for a flow that is constant over the step (the volume that left, over the step). For an Rcr:
/// p_c <- p_d + R_d Q + (p_c - p_d - R_d Q) exp(-dt / (R_d C)), THEORY (9.3).
OutletState advanced(const OutletModel& model, const OutletState& state, TimeStep step, double flow);

/// Response to an unknown flow that is constant over the step.
OutletResponse step_response(const OutletModel& model, const OutletState& state, TimeStep step);
/// Response to an unknown flow at the end of the step, linear in time from the known flow_begin [m3/s].
OutletResponse step_response(const OutletModel& model, const OutletState& state, TimeStep step, double flow_begin);

/// Pressure over flow for an oscillation e^(i w t) [Pa s/m3], w >= 0 in rad/s, distal and muscle pressures held.
/// At w = 0 the sum of the resistances. Rcr: R_p + R_d / (1 + i w R_d C), THEORY (9.4).
std::complex<double> impedance(const OutletModel& model, double angular_frequency);

}   // namespace patency
