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
    std::function<bool()> interrupted = {};     ///< asked now and then
    Log log = no_log;
    Progress* progress = nullptr;
};

/// As deployment.mode says. Returns whether it came to its end; interrupted, it leaves frames and tables but no summary.json, and begins
/// anew when called again. Throws DeckError, GeometryError, FileError, DivergedError.
bool run_deploy(const deck::Case& config, const DeployStage& stage);

}   // namespace patency
