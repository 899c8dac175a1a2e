// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/physics/open_ends/profile.h"
#include "patency/stages/build.h"
#include "patency/stages/lumen_of_case.h"

namespace patency {

namespace {

// Measured on two cores with AVX-512 (patency bench flow): particle-steps per second and thread, resident bytes per
// particle with its row of neighbours. Guides for a person who decides whether to wait, no promises.
constexpr double steps_per_second = 2.5e6;
constexpr double bytes_per_particle_in_space = 2500, bytes_per_particle_in_plane = 1500;
constexpr double viscous_number = 0.125;   // as the scheme's: dt <= 0.125 h^2 / nu

}  // namespace

FlowPlan plan_flow(const Scene& scene, int threads) {
    const FlowNumerics& n = scene.numerics;
    const double dp = n.spacing, h = n.smoothing_ratio * dp, c = scene.material.sound_speed, u = n.reference_speed;
    const double cell = n.planar ? dp * dp : dp * dp * dp, width = scene.lumen.narrowest;
    const double developed = parabola_profile(n.planar ? Section::planar : Section::circular, 0);
    const double thickness = 2 * h + 0.5 * dp, beyond = buffer_spacings * dp;
    double area = 0, rim = 0;
    for (const Opening& opening : scene.lumen.openings) {
        area += opening.area;
        rim += n.planar ? 2 : 2 * std::sqrt(std::numbers::pi * opening.area);
    }
    FlowPlan plan{};
    plan.speed = u;
    plan.reynolds = scene.material.density * u / developed * width / scene.material.viscosity;
    plan.sound_speed = c;
    plan.advection_step = std::min(n.advection_cfl * h / u, viscous_number * h * h / scene.material.kinematic_viscosity());
    const double acoustic = n.acoustic_cfl * h / (c + u);
    const double inner = std::ceil(plan.advection_step / acoustic);
    plan.acoustic_step = plan.advection_step / inner;
    plan.acoustic_steps = scene.config.numerics.duration / plan.acoustic_step;
    plan.fluid_particles = (scene.lumen.volume + area * beyond) / cell;
    plan.wall_particles = (scene.lumen.wall_area + rim * (beyond + 2 * h)) * thickness / cell;
    plan.across_narrowest = width / dp;
    plan.memory = (plan.fluid_particles + plan.wall_particles) * (n.planar ? bytes_per_particle_in_plane : bytes_per_particle_in_space);
    plan.threads = threads;
    plan.seconds = plan.fluid_particles * plan.acoustic_steps / (steps_per_second * threads);
    return plan;
}

}  // namespace patency
