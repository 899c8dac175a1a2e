// SPDX-License-Identifier: Apache-2.0
// What a deck imposes at an opening, as a law in time: a velocity over the section, a pressure, or an outlet model with
// its state; and the moving level above which pressures are solved. Finds no particles (bodies/open_end.h).
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "patency/bodies/open_end.h"
#include "patency/config/case.h"
#include "patency/physics/open_ends/outlets.h"
#include "patency/physics/open_ends/waveform.h"
#include "patency/shape/lumen.h"

namespace patency {

/// A value in time from a deck: constant or waveform, times a smooth rise.
struct Signal {
    Waveform waveform;
    double ramp = 0;   ///< [s]

    double operator()(double time) const { return waveform(time) * (ramp > 0 ? smooth_ramp(time, ramp) : 1.0); }
};

struct EndLaw {
    deck::OpeningType type = deck::OpeningType::pressure;
    Signal signal;                       ///< flow into the domain [m^3/s] of a velocity end; pressure [Pa]
    double peak_to_mean = 1;             ///< of the velocity over the section
    std::optional<OutletModel> outlet;   ///< of resistance, rcr and coronary

    // The state, kept in checkpoints.
    OutletState state{};                      ///< at time `known_until`
    double known_until = 0, known_flow = 0;   ///< [s], [m^3/s] out of the domain
    double known_pressure = 0;                ///< at the plane then, of a scheme that integrates by trapezia [Pa]
    bool is_started = false;
    OutletState level_state{};   ///< of the same model in the network that gives the moving level
    double level_flow = 0;       ///< into it there [m^3/s]
    double volume_out = 0;       ///< since the start [m^3]
    double pressure_time = 0;    ///< integral of the mean pressure at the plane [Pa s]

    bool prescribes_flow() const { return type == deck::OpeningType::velocity || type == deck::OpeningType::flow; }
};

/// Whether a pressure over time, an opening's own or the aorta's, drives a periodic flow. Outlets then begin in the state that it brings
/// them back to from beat to beat.
bool is_driven_by_pulse(const deck::Case& config);

/// The law of an opening. Files of waveforms are read here: throws FileError or DeckError naming the opening.
EndLaw make_end_law(const Opening& opening, const deck::Opening& said, const deck::Case& config);

/// What an end that prescribes its flow imposes over its section at a time.
std::function<SectionVelocity(double)> make_end_velocity(const Opening& opening, const deck::Opening& said,
                                                         const EndLaw& law, const deck::Blood& blood);

/// The flow into the domain [m^3/s] that this velocity carries through the opening at a time: the signal's, but less in a start
/// from rest, and of a Womersley profile that of its modes.
std::function<double(double)> make_end_flow(const Opening& opening, const deck::Opening& said, const EndLaw& law,
                                            const deck::Blood& blood);

/// Sets what the pressure-like ends impose over an acoustic step of dt from `time` [s], from the flows they have
/// measured, and returns the moving level [Pa] that it is above: the mean of the pressures that are prescribed; without
/// any, the pressure at which the outlet models together would take up the prescribed inflow if they met in one point.
///
/// That level is a function of time, never of the flow that the particles answer with. A level that follows the measured
/// flows makes every outlet echo into the others: with resistances r_1 and r_2 (over rho c / A) and the level at r_1,
/// waves between two outlets grow for r_1 > r_2. So each outlet stays passive, whatever it is made of.
double impose_laws(std::span<EndLaw> laws, std::span<OpenEnd> ends, double time, double dt,
                   deck::PressureReference reference);

/// For a scheme that finds pressure and flow at the end of a step together: what holds there, dt after `time` [s].
void impose_laws_ahead(std::span<EndLaw> laws, std::span<OpenEnd> ends, double time, double dt);
/// Its ends' states and integrals from when they are known to `time`, the flows there being the ends'.
void advance_laws(std::span<EndLaw> laws, std::span<const OpenEnd> ends, double time);

/// The response of a pressure-like end at `time` to the flow [m^3/s] a time `ahead` [s] later.
OutletResponse response_of(const EndLaw& law, double time, double ahead);

}   // namespace patency
