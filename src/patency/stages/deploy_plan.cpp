// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_plan.h"

#include <algorithm>
#include <numbers>

#include "patency/bodies/stent.h"
#include "patency/shape/wall_thickness.h"
#include "patency/stages/deploy_program.h"
#include "patency/stages/deploy_scene.h"

namespace patency {

namespace {

// Measured on one core with AVX-512 in mixed precision, contact included: particles of the stent, steps per second.
constexpr double particle_steps_per_second = 1.2e6;
// Metal that is bent bears shorter steps, and not every stent bears the tools' full speed: 1.2 to 1.6 times the program's in what was run.
constexpr double more_steps = 1.3;

}   // namespace

DeployPlan plan_deploy(const deck::Case& config, int threads) {
    const Vessel vessel = read_vessel(config, network_resolution(config));
    DeployPlan plan{.place = place_stent(config, vessel)};
    const StentPlace& place = plan.place;
    if (config.deployment.mode == deck::DeploymentMode::geometric) return plan;
    wall_materials(config.wall), stent_material(*config.stent, place.pattern);   // refuse what they do not know
    const double thickness = config.wall.thickness.value_or(coronary_wall_thickness(place.reference_diameter));
    plan.wall_spacing = config.wall.spacing.value_or(usual_wall_spacing(thickness));
    plan.stent_spacing = config.stent->spacing.value_or(largest_stent_spacing(place.form));
    const auto cube = [](double x) { return x * x * x; };
    const double inner = place.reference_diameter / 2, outer = inner + thickness,
                 length = (1 + 2 * config.deployment.region) * place.pattern.length;
    plan.wall_particles = std::numbers::pi * (outer * outer - inner * inner) * length / cube(plan.wall_spacing);
    plan.stent_particles = metal_volume(place.form) / cube(plan.stent_spacing);
    plan.mass_scaling = stent_mass_scaling(config, place, plan.stent_spacing);
    const double ramps = make_deploy_program(place, config.deployment).usual_end / config.deployment.ramp;
    plan.steps = more_steps * ramps * config.deployment.steps;
    plan.seconds = plan.steps * plan.stent_particles / particle_steps_per_second / threads;
    return plan;
}

}   // namespace patency
