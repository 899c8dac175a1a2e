// SPDX-License-Identifier: Apache-2.0
// The blood at time zero: velocity and pressure as the deck says, with the pressure gradient that belongs to them.
#pragma once

#include <functional>
#include <memory>

#include "patency/stages/cell_start.h"
#include "patency/stages/scene.h"

namespace patency {

using SolveOnCells = std::function<std::unique_ptr<const CellStart>(const Scene&)>;

/// Overwrites velocity, pressure (above scene.reference_pressure), pressure gradient, pressure rate and viscosity; what the ends hear
/// of sound departs from the pressures there. A flow on cells that the deck did not ask for and that cannot be had is replaced by the
/// estimate, with a remark. Throws DeckError where the shape knows no such field, and what the flow on cells throws that was asked for.
void compute_initial_state(
    Scene& scene,
    const SolveOnCells& solve = [](const Scene& scene) { return std::make_unique<const CellStart>(scene); });

}   // namespace patency
