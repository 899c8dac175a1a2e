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
    bool is_reference = false;           ///< its pressure is part of the moving level

    // The state, kept in checkpoints.
    OutletState state{};                 ///< at time `known_until`
    double known_until = 0, known_flow = 0;   ///< [s], [m^3/s] out of the domain
    bool is_started = false;
    double pressure = 0;                 ///< what was imposed last, as the deck counts it [Pa]
    double volume_out = 0;               ///< since the start [m^3]
    double pressure_time = 0;            ///< integral of the mean pressure at the plane [Pa s]

    bool prescribes_flow() const { return type == deck::OpeningType::velocity || type == deck::OpeningType::flow; }
};

/// The law of an opening. Files of waveforms are read here: throws FileError or DeckError naming the opening.
EndLaw make_end_law(const Opening& opening, const deck::Opening& said, const deck::Case& config);

/// Velocity [m/s] at x and a time, for an end that prescribes its flow. The function keeps a table of the last instant:
/// one thread at a time.
std::function<Vec3(const Vec3&, double)> make_end_velocity(const Opening& opening, const deck::Opening& said,
                                                           const EndLaw& law, const deck::Blood& blood);

/// Chooses which ends carry the moving level: those whose pressure is prescribed, else the one outlet that answers least
/// to its flow. A level that answered more would feed every outlet's echo into the others: with two outlets of
/// resistances r_1 and r_2 and the level at r_1, waves between them decay only if r_1 <= r_2. None with `fixed`.
void choose_reference(std::span<EndLaw> laws, deck::PressureReference reference);

/// Sets what the ends impose over an acoustic step of dt from `time` [s], from the flows they have measured, and returns
/// the moving level [Pa] that it is above.
double impose_laws(std::span<EndLaw> laws, std::span<OpenEnd> ends, double time, double dt);

/// The response of a pressure-like end at `time` to the flow [m^3/s] a time `ahead` [s] later.
OutletResponse response_of(const EndLaw& law, double time, double ahead);

}  // namespace patency
