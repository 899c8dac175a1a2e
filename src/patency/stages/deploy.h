// SPDX-License-Identifier: Apache-2.0
// The deployment of a stent from a case to a folder of results: summary.json, tables, frames, the lumen after.
#pragma once

#include <functional>

#include "patency/base/log.h"
#include "patency/config/case.h"
#include "patency/io/output_folder.h"
#include "patency/io/progress.h"

namespace patency {

struct DeployStage {
    const OutputFolder& folder;
    std::string binary_hash = {};             ///< of the program: another one would not go on with the same bits
    std::function<bool()> interrupted = {};   ///< asked after every step
    Log log = no_log;
    Progress* progress = nullptr;
    double wall_between_checkpoints = 300;   ///< of a deployment with mechanics [s of wall time]
};

/// As deployment.mode says. With mechanics it goes on where the folder's checkpoint of the deployment stands, else begins (the caller
/// clears the folder to begin anew); the results have the same bits either way. Returns whether it came to its end; interrupted, it
/// leaves a checkpoint and no summary.json. Throws DeckError, GeometryError, FileError, CheckpointError, DivergedError.
bool run_deploy(const deck::Case& config, const DeployStage& stage);

}   // namespace patency
