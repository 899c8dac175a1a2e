// SPDX-License-Identifier: Apache-2.0
// Solids from a case to a folder of results: summary.json, timing.json, energies.csv, a series of frames per solid.
#pragma once

#include <functional>

#include "patency/base/log.h"
#include "patency/config/case.h"
#include "patency/io/output_folder.h"
#include "patency/io/progress.h"

namespace patency {

struct SolidStage {
    const OutputFolder& folder;
    std::string binary_hash = {};             ///< of the program: another one would not go on with the same bits
    std::function<bool()> interrupted = {};   ///< asked after every step
    Log log = no_log;
    Progress* progress = nullptr;
    double wall_between_checkpoints = 300;   ///< where the deck has no checkpoint_interval [s of wall time]
};

/// Goes on where the folder's checkpoint of solids stands, else begins (the caller clears the folder to begin anew); the results
/// have the same bits either way, and for any number of threads. Returns whether it came to its end; interrupted, it leaves a
/// checkpoint and no summary.json. Solids that diverge leave the last good checkpoint, and where they were in offenders.vtp.
/// Throws DeckError, GeometryError, FileError, CheckpointError, DivergedError.
bool run_solids(const deck::Case& config, const SolidStage& stage);

}   // namespace patency
