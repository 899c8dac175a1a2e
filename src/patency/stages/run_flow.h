// SPDX-License-Identifier: Apache-2.0
// The flow stage from a case to a folder of results: summary.json, timing.json, tables, frames, checkpoints.
#pragma once

#include <functional>
#include <string>

#include "patency/base/log.h"
#include "patency/config/case.h"
#include "patency/io/output_folder.h"
#include "patency/io/progress.h"

namespace patency {

struct FlowStage {
    const OutputFolder& folder;
    std::string binary_hash = {};             ///< of the program: another one would not go on with the same bits
    std::function<bool()> interrupted = {};   ///< asked after every step
    Log log = no_log;
    Progress* progress = nullptr;
    double wall_between_checkpoints = 300;   ///< where the deck has no checkpoint_interval [s of wall time]
};

enum class Outcome {
    done,
    unsettled,   ///< results are there, but the flow had not settled at the end of its duration
    interrupted
};

/// Goes on where the folder's checkpoint of a flow stands, else begins (the caller clears the folder to begin anew). The
/// results have the same bits either way, and for any number of threads. An interruption leaves a checkpoint and no
/// summary.json; a flow that diverges leaves the last good checkpoint and the offenders in offenders.vtp. Throws
/// DeckError, GeometryError, FileError, CheckpointError, DivergedError.
Outcome run_flow(const deck::Case& config, const FlowStage& stage);

}   // namespace patency
