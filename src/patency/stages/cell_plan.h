// SPDX-License-Identifier: Apache-2.0
// What a flow on cells will cost, said before it runs.
#pragma once

#include "patency/config/case.h"
#include "patency/stages/vessel.h"

namespace patency {

struct CellPlan {
    double cells;
    double finest, coarsest;   ///< spacing [m]
    double across_narrowest;   ///< cells
    double memory;             ///< bytes
    double seconds;            ///< expected on `threads` threads
    double steps;              ///< in time; none of a steady flow
    int threads;
    double speed = 0, reynolds = 0;   ///< expected: the largest [m/s]; of the mean speed through the narrowest width
};

/// Of a deck of scheme cells. Throws DeckError for what a flow on cells cannot be, GeometryError.
/// vessel: of the deck, if it was read before.
CellPlan plan_cells(const deck::Case& config, int threads, const Vessel* vessel = nullptr);

}   // namespace patency
