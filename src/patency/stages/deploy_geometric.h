// SPDX-License-Identifier: Apache-2.0
// A deployment without mechanics: the lumen takes the stent's nominal shape at once. For a quick look.
#pragma once

#include "patency/stages/deploy.h"

namespace patency {

/// summary.json (marked as without mechanics), timing.json, stent.csv, stent.vtp, lumen_after.vtp and .stl, case_after.yaml.
void deploy_geometrically(const deck::Case& config, const DeployStage& stage);

}   // namespace patency
