// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/physics/open_ends/profile.h"
#include "patency/stages/build.h"
#include "patency/stages/flow_window.h"
#include "patency/stages/lumen_of_case.h"

namespace patency {

namespace {

// Measured on two cores with AVX-512: particle-steps per second of processor time of whole flows in space, 1.3 to 1.8 million
// from ten thousand to half a million particles (timing.json, docs/VERIFICATION.md); resident bytes per particle with its row
// of neighbours. Guides for a person who decides whether to wait, no promises.
constexpr double steps_per_second = 1.6e6;
constexpr double bytes_per_particle_in_space = 2500, bytes_per_particle_in_plane = 1500;
constexpr double viscous_number = 0.125;   // as the scheme's: dt <= 0.125 h^2 / nu

}   // namespace

FlowPlan plan_flow(const Scene& scene, int threads) { return plan_flow(scene, threads, scene.numerics.spacing); }

FlowPlan plan_flow(const Scene& scene, int threads, double dp) {
    const FlowNumerics& n = scene.numerics;
    const double h = n.smoothing_ratio * dp, c = scene.material.sound_speed, u = n.reference_speed;
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
    plan.advection_step =
        std::min(n.advection_cfl * h / u, viscous_number * h * h / scene.material.kinematic_viscosity());
    const double acoustic = n.acoustic_cfl * h / (c + u);
    const double inner = std::ceil(plan.advection_step / acoustic);
    plan.acoustic_step = plan.advection_step / inner;
    const double end = probable_end(scene);
    plan.acoustic_steps = end / plan.acoustic_step;
    plan.fluid_particles = (scene.lumen.volume + area * beyond) / cell;
    plan.wall_particles = (scene.lumen.wall_area + rim * (beyond + 2 * h)) * thickness / cell;
    plan.across_narrowest = width / dp;
    plan.memory = (plan.fluid_particles + plan.wall_particles) *
                  (n.planar ? bytes_per_particle_in_plane : bytes_per_particle_in_space);
    plan.threads = threads;
    plan.seconds = plan.fluid_particles * plan.acoustic_steps / (steps_per_second * threads);
    plan.longest_seconds = plan.seconds * scene.config.numerics.duration / end;
    return plan;
}

double round_spacing(double spacing) {
    constexpr int digits = 3, step = 5;
    const int exponent = int(std::floor(std::log10(1e3 * spacing))) - digits + 1;
    const auto made =
        [&](long n) {   // as it is read from a deck: the nearest number to the decimal one in mm, then in m
            return (exponent < 0 ? double(n) / std::pow(10.0, -exponent) : double(n) * std::pow(10.0, exponent)) / 1e3;
        };
    long n = long(1e3 * spacing / std::pow(10.0, exponent)) / step * step + step;
    while (made(n) > spacing) n -= step;
    return made(n);
}

double finest_spacing(const Scene& scene, const Budget& budget, double coarsest) {
    constexpr double least_step = 1 - 1e-9;
    double finest = round_spacing(coarsest);
    for (double dp = finest;; dp = round_spacing(least_step * dp)) {
        const FlowPlan plan = plan_flow(scene, budget.threads, dp);
        if (!(plan.longest_seconds <= budget.seconds && plan.memory <= budget.memory)) return finest;
        finest = dp;
    }
}

}   // namespace patency
