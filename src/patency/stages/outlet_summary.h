// SPDX-License-Identifier: Apache-2.0
// What lies behind an outlet, for summary.json: its resistances, compliances and the pressure behind them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "patency/config/case.h"

namespace patency {

/// Adds resistance_pa_s_per_m3 (of all in series) and distal_pressure_pa, and of rcr and coronary outlets their parts and
/// compliances; nothing for openings of other types. `datum` [Pa] is added to the pressure (Scene::datum).
void add_outlet(nlohmann::ordered_json& opening, const deck::Opening& said, double datum = 0);

}   // namespace patency
