// SPDX-License-Identifier: Apache-2.0
// What a deployment will be and cost, without doing it.
#pragma once

#include "patency/stages/stent_placement.h"

namespace patency {

struct DeployPlan {
    StentPlace place;
    double wall_spacing = 0, stent_spacing = 0;       ///< [m]
    double wall_particles = 0, stent_particles = 0;   ///< about
    double mass_scaling = 1, steps = 0;               ///< of the stent
    double seconds = 0;                               ///< of wall clock, about
};

/// Refuses what run_deploy refuses, with the same sentences. Throws DeckError, GeometryError, FileError.
DeployPlan plan_deploy(const deck::Case& config, int threads);

}   // namespace patency
