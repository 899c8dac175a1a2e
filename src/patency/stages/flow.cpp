// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow.h"

#include <fmt/format.h>

#include <algorithm>

#include "patency/base/errors.h"
#include "patency/schemes/paper_scheme.h"

namespace patency {

namespace {

// A step this much shorter than the reference speed's is a collapse: something runs away that nothing resolves.
constexpr double shortest_share = 0.02;

void expect_no_collapse(const Scene& scene, const FlowStep& step, double longest) {
    const double h = scene.numerics.smoothing_ratio * scene.numerics.spacing;
    const double advective = scene.numerics.advection_cfl * h / scene.numerics.reference_speed;
    if (step.dt >= longest * (1 - 1e-12) || step.fastest * shortest_share <= scene.numerics.reference_speed) return;
    throw DivergedError(fmt::format(
        "the time step collapsed at {:.6g} s: {:.3g} s where {:.3g} s were expected, because the blood reaches "
        "{:.3g} m/s instead of {:.3g} m/s; give numerics.reference_speed if that is meant",
        scene.time, step.dt, advective, step.fastest, scene.numerics.reference_speed));
}

/// Adds what the ends did in the last acoustic step to their integrals.
void settle(Scene& scene) {
    for (std::size_t k = 0; k < scene.ends.size(); ++k)
        scene.laws[k].pressure_time += scene.unsettled * (scene.ends[k].mean_pressure + scene.level());
    scene.unsettled = 0;
}

void update_ends(Scene& scene, double time, double dt) {
    settle(scene);   // before the level moves
    scene.reference_pressure = impose_laws(scene.laws, scene.ends, time, dt, scene.config.numerics.pressure_reference);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) scene.laws[k].volume_out += scene.ends[k].flow * dt;
    scene.unsettled = dt;
}

}   // namespace

void start_scheme(Scene& scene) {
    const FlowDomain domain{scene.fluid, scene.wall, scene.ends, *scene.frame,
                            [&lumen = scene.lumen](const Vec3& x) { return lumen.distance.value(x); }};
    const bool is_mixed = scene.config.numerics.precision == deck::Precision::mixed;
    const auto make = scene.config.scheme() == deck::SchemeName::paper ? make_paper_scheme : make_flow_scheme;
    scene.scheme =
        make(is_mixed ? Precision::mixed : Precision::double_precision, domain, scene.material, scene.numerics);
    scene.scheme->update_ends = [&scene](std::span<OpenEnd>, double time, double dt) { update_ends(scene, time, dt); };
    scene.scheme->settle_ends = [&scene] { settle(scene); };
}

void advance(Scene& scene, const FlowRun& run) {
    auto next = run.exact_times.begin();
    while (scene.time < run.until) {
        while (next != run.exact_times.end() && *next <= scene.time) ++next;
        const double stop = next == run.exact_times.end() ? run.until : std::min(*next, run.until);
        const double left = stop - scene.time;
        // Two halves rather than a whole step and a crumb.
        const bool is_crumb_ahead = left > scene.last_dt * (1 + 1e-6) && left < 2 * scene.last_dt * (1 - 1e-6);
        const double longest = is_crumb_ahead ? 0.5 * left : left;
        const FlowStep step = scene.scheme->step(scene.time, longest);
        expect_no_collapse(scene, step, longest);
        scene.time = step.dt >= left ? stop : scene.time + step.dt;
        scene.last_dt = step.dt;
        scene.acoustic_steps += step.acoustic_steps;
        ++scene.advection_steps;
        scene.scheme->settle_ends();
        if (run.observe) run.observe(scene, step);
        if (run.interrupted && run.interrupted()) return;
    }
}

}   // namespace patency
