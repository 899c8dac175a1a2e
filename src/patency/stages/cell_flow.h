// SPDX-License-Identifier: Apache-2.0
// The flow stage of the scheme `cells`: the steady flow of a deck into its folder. run_flow calls it.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "patency/stages/cell_scene.h"
#include "patency/stages/run_flow.h"

namespace patency {

/// Leaves summary.json, timing.json, and the cells and the wall as frames. An interruption leaves nothing to go on from:
/// the whole takes less than what a checkpoint would save. `follow` takes over a flow that has no rest, if the deck wants that. Throws as
/// run_flow.
Outcome run_cell_flow(const deck::Case& config, const FlowStage& stage,
                      const std::function<Outcome(const CellScene&)>& follow);

/// The numbers of a flow's part of summary.json: a function of the scene only. Throws DivergedError where one is not finite.
nlohmann::ordered_json make_cell_summary(const CellScene& scene);

}   // namespace patency
