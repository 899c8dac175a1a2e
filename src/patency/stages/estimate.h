// SPDX-License-Identifier: Apache-2.0
// The answer in a second: a case's vessel as a tree of tubes (physics/tree), its flows, pressures and FFR. Makes no particles.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patency/physics/tree/tree_flow.h"
#include "patency/stages/vessel.h"

namespace patency {

/// What may be different from what the deck and the surface say, for bands.
struct EstimateChange {
    double flow = 1;       ///< factor on what the bed takes, and on prescribed flows
    double diameter = 0;   ///< added to every diameter [m]
    double exponent = 0;   ///< added to Murray's
};

/// A lesion and what it does.
struct EstimatedLesion {
    std::size_t number;          ///< in Assessment::lesions
    double flow;                 ///< [m^3/s]
    double drop;                 ///< of the mean pressure from its start to where FFR is read [Pa]
    double read_arc;             ///< along its line: 15 mm behind its end, or at the vessel's [m]
    std::optional<double> ffr;   ///< there; none without an aortic pressure
};

struct Estimate {
    TreeCase tree;   ///< branches as the vessel's
    TreeFlow flow;
    std::vector<double> opening_flows;       ///< out of the domain, as the vessel's openings [m^3/s]
    std::vector<double> opening_pressures;   ///< [Pa], the deck's datum
    std::vector<deck::Opening> outlets;      ///< as the openings, resistances tuned
    std::vector<EstimatedLesion> lesions;
    double level = 0;                        ///< added to pressures for FFR: aortic less the inlet's [Pa]
    std::optional<double> aortic_pressure;   ///< [Pa]

    /// Pressure over the aortic one at a station; none without an aortic pressure.
    std::optional<double> ffr(std::size_t branch, std::size_t station) const;
};

/// Of a vessel that was followed. Steady: waveforms count by their means. Throws DeckError if openings of deck and vessel differ, or the ends leave the
/// pressure open; GeometryError if no flow agrees.
Estimate estimate_flow(const deck::Case& config, const Vessel& vessel, const EstimateChange& change = {});

/// Where a vessel's lesions have their FFR read, in space [m], one for each of the estimate's.
std::vector<Vec3> reading_places(const Estimate& estimate, const VesselAlong& along);
/// At the station nearest to a place, which may be another vessel's; none without an aortic pressure.
std::optional<double> ffr_near(const Estimate& estimate, const VesselAlong& along, const Vec3& place);

/// The smallest and the largest of a number over the changes.
struct Band {
    double low, high;
};
struct EstimateBand {
    std::vector<Band> lesion_ffr;      ///< as Estimate::lesions; empty without an aortic pressure
    std::vector<Band> opening_flows;   ///< as Estimate::opening_flows [m^3/s]
    std::vector<Band> place_ffr;       ///< as the places; empty without an aortic pressure
};
/// Flow and lumen a tenth and a tenth of a millimetre up and down, Murray's exponent by a half, every combination. `places`: where else
/// FFR is read.
EstimateBand estimate_band(const deck::Case& config, const Vessel& vessel, std::span<const Vec3> places = {});

}   // namespace patency
