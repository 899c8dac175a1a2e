// SPDX-License-Identifier: Apache-2.0
// What results will take on the disk, said before they are there.
#pragma once

#include "patency/config/case.h"
#include "patency/stages/deploy_plan.h"
#include "patency/stages/vessel.h"

namespace patency {

/// Of one flow [bytes]: its frames, a checkpoint, the vessel's surface and lines, the page. `blood`, `wall`: particles of either, cells have
/// no wall's; `vessel`: null of a shape.
double flow_disk(const deck::Case& config, double blood, double wall, const Vessel* vessel);

/// Of the deployment [bytes].
double deploy_disk(const deck::Case& config, const DeployPlan& plan, const Vessel& vessel);

}   // namespace patency
