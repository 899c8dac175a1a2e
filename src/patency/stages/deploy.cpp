// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy.h"

#include "patency/base/errors.h"
#include "patency/stages/deploy_geometric.h"

namespace patency {

bool run_deploy(const deck::Case& config, const DeployStage& stage) {
    if (config.deployment.mode == deck::DeploymentMode::geometric) {
        deploy_geometrically(config, stage);
        return true;
    }
    throw DeckError("deployment.mode: only geometric is there yet");
}

}   // namespace patency
