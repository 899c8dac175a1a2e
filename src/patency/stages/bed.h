// SPDX-License-Identifier: Apache-2.0
// Resistances that a deck leaves to its bed.
#pragma once

#include <vector>

#include "patency/config/case.h"
#include "patency/shape/lumen.h"

namespace patency {

/// What a bed takes of a vessel whose inlet has this area [m^2], if nobody says: [m^3/s].
double flow_of_bed(deck::BedState state, double inlet_area);

/// Gives every outlet of type resistance without a value its resistance and the venous pressure behind it. The flow is the
/// deck's, or what the state of the bed brings through the largest of the other openings. Throws DeckError.
void tune_outlets(deck::Case& config, const std::vector<Opening>& openings);

}   // namespace patency
