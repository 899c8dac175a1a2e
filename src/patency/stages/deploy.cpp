// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy.h"

#include "patency/stages/deploy_geometric.h"
#include "patency/stages/deploy_mechanical.h"

namespace patency {

bool run_deploy(const deck::Case& config, const DeployStage& stage) {
    if (config.deployment.mode != deck::DeploymentMode::geometric) return deploy_by_contact(config, stage);
    deploy_geometrically(config, stage);
    return true;
}

}   // namespace patency
