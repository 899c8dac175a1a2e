// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/cell_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "patency/physics/open_ends/profile.h"
#include "patency/stages/bed.h"
#include "patency/stages/cell_scene.h"
#include "patency/stages/end_law.h"
#include "patency/stages/material.h"
#include "patency/stages/speeds.h"

namespace patency {

namespace {

// One core of a slow machine takes 19 s to build 49,000 cells of the reference paper's bifurcation and to write what they say, 40 s of
// 95,000, 70 s of 226,000 and 147 s of 763,000: most of it is at the wall, whose cells grow by the power 2/3. To solve them it takes 11, 15,
// 38 and 92 s. One of a quick machine takes half of that; what stands here is in between. A lesion of 84 % in a real left tree
// takes three times as long to solve. Memory: the largest resident one of a run was 121 MB with 5,200 cells, 369 MB with 49,000 and 1,330 MB with
// 226,000 (which mixed forty steps; thirty take 72 MB less).
constexpr double seconds_at_wall = 0.0127, seconds_per_cell = 0.115e-3, bytes_per_cell = 5000, bytes_at_least = 120e6;
// Of pipes and a Y with pressures or Windkessels behind them 3 to 6 us; of a bifurcation with an aortic pressure in front, a lesion and
// coronary beds behind 18, ten iterations in a step.
constexpr double seconds_per_cell_and_step = 15e-6;
constexpr double shared = 0.9;   // of the work that a second thread takes half of

/// The volume over the cube of the spacing, along the centrelines; each stretch counts once.
double count_along(const VesselAlong& along, const SpacingField& field) {
    double count = 0;
    for (std::size_t n = 0; n < along.lines.lines.size(); ++n) {
        const auto& points = along.lines.lines[n].points;
        std::size_t first = 1;
        for (std::size_t m = 0; m < n; ++m)
            first = std::max(first, shared_points(along.lines.lines[m], along.lines.lines[n]));
        for (std::size_t k = first; k < points.size(); ++k) {
            const double r = points[k].radius;
            count +=
                std::numbers::pi * r * r * (points[k].arc - points[k - 1].arc) / std::pow(field(points[k].place), 3);
        }
    }
    return count;
}

/// The same on a grid, of a shape that has no centrelines.
double count_inside(const Lumen& lumen, const SpacingField& field) {
    constexpr int side = 48;
    const Vec3 size = lumen.bounds.high - lumen.bounds.low;
    double inside = 0, count = 0;
    for (int n = 0; n < side * side * side; ++n) {
        const int i = n / (side * side), j = n / side % side, k = n % side;
        const Vec3 share{(i + 0.5) / side, (j + 0.5) / side, (k + 0.5) / side};
        const Vec3 x = lumen.bounds.low + Vec3{share.x * size.x, share.y * size.y, share.z * size.z};
        if (contains(lumen, x)) inside += 1, count += std::pow(field(x), -3);
    }
    return inside > 0 ? lumen.volume * count / inside : 0;
}

/// Of a periodic flow; of one that waits until it repeats, and whose beds begin in the beat of the pressure that drives it, three beats: two
/// that are alike and one that means are taken of.
double steps_of(const deck::Case& config) {
    if (config.about.mode == deck::Mode::steady) return 0;
    const bool repeats_soon = config.numerics.convergence && is_driven_by_pulse(config);
    const double beats = config.numerics.duration / *config.about.period;
    return (repeats_soon ? std::min(3.0, beats) : beats) * config.numerics.steps_per_period;
}

}   // namespace

CellPlan plan_cells(const deck::Case& config, int threads, const Vessel* known) {
    std::optional<Vessel> vessel;
    if (config.has_vessel() && !known) known = &vessel.emplace(read_vessel(config));
    const Lumen lumen = make_cell_lumen(config, known);
    CellPlan plan{.cells = 0,
                  .finest = config.numerics.spacing,
                  .coarsest = config.numerics.spacing,
                  .across_narrowest = 0,
                  .memory = 0,
                  .seconds = 0,
                  .steps = steps_of(config),
                  .threads = threads};
    if (config.numerics.follows_vessel()) {
        const SpacingField field = make_cell_spacing(lumen, known, config.numerics);
        plan.cells = known ? count_along(*known->along, field) : count_inside(lumen, field);
        plan.finest = field.settings().smallest;
        plan.coarsest = std::min(field.settings().largest, 2 * lumen.openings.front().radius / *config.numerics.across);
    } else {
        plan.cells = lumen.volume / std::pow(plan.finest, lumen.planar ? 2 : 3);
    }
    plan.across_narrowest = lumen.narrowest / plan.finest;
    deck::Case complete = config;   // whatever is wrong with its openings is said now, and not by the flow
    complete_openings(complete, lumen.openings);
    std::vector<EndLaw> laws;
    for (const Opening& opening : lumen.openings)
        laws.push_back(make_end_law(opening, complete.openings.at(opening.name), complete));
    const FluidMaterial blood = make_material(complete.blood);
    plan.speed = estimate_expected(complete, lumen, laws, blood).speed;
    const double developed = parabola_profile(lumen.planar ? Section::planar : Section::circular, 0);
    plan.reynolds = blood.density * plan.speed / developed * lumen.narrowest / blood.viscosity;
    plan.memory = bytes_at_least + bytes_per_cell * plan.cells;
    const double work = seconds_at_wall * std::cbrt(plan.cells * plan.cells) +
                        (seconds_per_cell + plan.steps * seconds_per_cell_and_step) * plan.cells;
    plan.seconds = work * (1 - shared + shared / threads);
    return plan;
}

}   // namespace patency
