// SPDX-License-Identifier: Apache-2.0
// A deployment by contact: the stent crimped, brought in, opened by a balloon or by a load on its struts, let go.
#pragma once

#include "patency/stages/deploy.h"

namespace patency {

/// summary.json, timing.json, deployment.csv, stent.csv, frames of stent and wall, lumen_after.vtp and .stl, case_after.yaml. Returns whether
/// it came to its end; interrupted, it leaves frames and tables but no summary.json.
bool deploy_by_contact(const deck::Case& config, const DeployStage& stage);

}   // namespace patency
