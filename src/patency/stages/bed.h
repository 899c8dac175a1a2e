// SPDX-License-Identifier: Apache-2.0
// What a deck leaves to its aorta and to the bed behind its outlets.
#pragma once

#include <vector>

#include "patency/config/case.h"
#include "patency/shape/lumen.h"

namespace patency {

/// What a bed takes of a vessel whose inlet has this area [m^2], if nobody says: [m^3/s].
double flow_of_bed(deck::BedState state, double inlet_area);

/// Of the largest opening that is no tuned outlet [m^2]; 0 if there is none.
double inlet_area(const deck::Case& config, const std::vector<Opening>& openings);

/// Gives what the deck leaves to its aorta and its bed: to openings of type pressure without a value the aorta's pressure, which pulses
/// if the flow is periodic; to outlets of type resistance, rcr and coronary without numbers those that let the bed's flow through, and the
/// venous pressure behind it; to coronary ones the pressure of the left ventricle's muscle. The flow is the deck's, or what the state of
/// the bed brings through the largest of the other openings. THEORY.md (9.9) to (9.15). Throws DeckError.
void complete_openings(deck::Case& config, const std::vector<Opening>& openings);

/// The sum of what an outlet has in series between the vessel and the veins [Pa s/m^3]; 0 of other openings.
double total_resistance(const deck::Opening& outlet);

}   // namespace patency
