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
    std::function<bool()> interrupted = {};   ///< asked after every step
    Log log = no_log;
    Progress* progress = nullptr;
};

/// Returns whether it came to its end; interrupted, it leaves frames and tables but no summary.json, and begins anew when
/// called again. Solids that diverge leave where they were in offenders.vtp. Throws DeckError, GeometryError,
/// FileError, DivergedError.
bool run_solids(const deck::Case& config, const SolidStage& stage);

}   // namespace patency
