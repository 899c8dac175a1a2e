// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/disk_plan.h"

#include <cmath>

namespace patency {

namespace {

// Bytes measured in folders of results, compressed as they are: of flows with 5,000 to 50,000 particles and cells, of solids with 9,000.
constexpr double per_moving_particle = 30, per_cell = 43;   ///< velocity and pressure; of cells the wall's sides too
constexpr double per_checkpoint_particle = 180;
constexpr double per_solid_particle = 78;
constexpr double per_surface_point = 42, per_opened_point = 120;   ///< wall.vtp; lumen_after as VTP and STL
constexpr double lines_and_tables = 0.5e6, page = 1.5e6, opened_stent = 2.9e6;

}   // namespace

double flow_disk(const deck::Case& config, double blood, double wall, const Vessel* vessel) {
    const bool moves = config.scheme() != deck::SchemeName::cells;
    const double frames =
        moves && config.output.interval ? std::floor(config.numerics.duration / *config.output.interval) + 1 : 1;
    const double bodies =
        moves ? frames * per_moving_particle * blood + per_checkpoint_particle * (blood + wall) : per_cell * blood;
    return bodies + page +
           (vessel ? lines_and_tables + per_surface_point * double(vessel->checked.surface.points.size()) : 0);
}

double deploy_disk(const deck::Case& config, const DeployPlan& plan, const Vessel& vessel) {
    const double opened = per_opened_point * double(vessel.checked.surface.points.size());
    if (config.deployment.mode == deck::DeploymentMode::geometric) return opened + opened_stent;
    return opened + config.deployment.frames * per_solid_particle * (plan.stent_particles + plan.wall_particles);
}

}   // namespace patency
