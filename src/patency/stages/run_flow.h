// SPDX-License-Identifier: Apache-2.0
// The flow stage from a case to a folder of results: summary.json, timing.json, tables, the resolved deck.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "patency/config/case.h"
#include "patency/stages/scene.h"

namespace patency {

/// Where a run stands, for whoever shows it.
struct FlowProgress {
    double time, duration;        ///< [s]
    std::int64_t steps;           ///< acoustic
    double inflow_less_outflow;   ///< [m^3/s]
    double wall_seconds;          ///< since the start of the stage
};

struct FlowStage {
    std::filesystem::path out;
    std::function<bool()> interrupted = {};                        ///< asked after every advection step
    std::function<void(std::string_view)> say = {};                ///< one line of the log
    std::function<void(const FlowProgress&)> show = {};            ///< after every advection step
};

enum class Outcome { done, interrupted };

/// Throws DeckError, GeometryError, FileError, DivergedError. After an interruption there is no summary.json.
Outcome run_flow(const deck::Case& config, const FlowStage& stage);

}  // namespace patency
