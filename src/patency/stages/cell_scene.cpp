// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/cell_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "patency/base/errors.h"
#include "patency/bodies/graded_points.h"
#include "patency/bodies/relax.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/stages/bed.h"
#include "patency/stages/end_law.h"
#include "patency/stages/lumen_of_case.h"
#include "patency/stages/material.h"
#include "patency/stages/speeds.h"

namespace patency {

namespace {

constexpr double steady_time = 1e6;         // s: when every rise from rest is over
constexpr double coarsening = 1.6;          // of the spacing of the first solution: a quarter of the cells
constexpr double fewest_across = 6;         // of the narrowest place, in a first solution
constexpr double coarse_tolerance = 1e-2;   // of it: less than what the coarse cells err by
constexpr int coarse_sharp_steps = 60;      // of it: without rest by then, the finer cells start like the coarse ones
constexpr int fading = 60;                  // steps

OpenEnd::Kind kind_of(const EndLaw& law) {
    return law.prescribes_flow() ? OpenEnd::Kind::velocity : OpenEnd::Kind::pressure;
}

CellEnd make_end(const Opening& opening, const deck::Opening& said, const EndLaw& law, const deck::Blood& blood) {
    CellEnd end;
    const Section section = opening.planar ? Section::planar : Section::circular;
    // What enters through an opening whose profile nobody gives has come a long way through such a vessel.
    end.velocity = [opening, section](const Vec3& x) {
        return -parabola_profile(section, norm(opening_coordinates(opening, x).radial) / opening.radius) *
               opening.normal;
    };
    if (kind_of(law) == OpenEnd::Kind::velocity) {
        end.flow = -law.signal(steady_time);
        // Blood that is drawn out finds its own profile.
        end.kind = end.flow > 0 ? CellEnd::Kind::flow : CellEnd::Kind::velocity;
        if (end.kind == CellEnd::Kind::velocity)
            end.velocity = make_end_velocity(opening, said, law, blood)(steady_time);
        return end;
    }
    if (!law.outlet) {
        end.pressure = law.signal(steady_time);
        return end;
    }
    // Steadily, a model is its resistances.
    end.pressure = outlet_pressure(*law.outlet, make_steady_state(*law.outlet, 0), 0);
    end.resistance = outlet_pressure(*law.outlet, make_steady_state(*law.outlet, 1), 1) - end.pressure;
    return end;
}

}   // namespace

void expect_possible(const deck::Case& config) {
    const std::string ask = "; scheme sph can do that";
    if (config.wall.motion != deck::WallMotion::rigid)
        throw DeckError("numerics.scheme: cells is for rigid walls" + ask);
    if (!config.wall.velocity.empty())
        throw DeckError("numerics.scheme: cells is for walls at rest, and wall.velocity moves them" + ask);
    if (norm(config.body_force) > 0) throw DeckError("numerics.scheme: cells knows no body_force" + ask);
    for (const auto& [name, opening] : config.openings)
        if (opening.waveform && config.about.mode == deck::Mode::steady)
            throw DeckError(fmt::format(
                "openings.{}.waveform: of a steady flow on cells there is none; case.mode: periodic follows it", name));
}

Lumen make_cell_lumen(const deck::Case& config, const Vessel* vessel) {
    expect_possible(config);
    return make_lumen(config, vessel);
}

namespace {

/// Around the centrelines of a vessel.
std::vector<InscribedBall> balls_of(const VesselAlong& along) {
    std::vector<InscribedBall> balls;
    for (const Centreline& line : along.lines.lines)
        for (const CentrelinePoint& p : line.points) balls.push_back({p.place, p.radius});
    return balls;
}

}   // namespace

SpacingField make_cell_spacing(const Lumen& lumen, const Vessel* vessel, const deck::Numerics& numerics) {
    const double finest = std::max(lumen.narrowest / *numerics.across, numerics.smallest_spacing.value_or(0)),
                 widest = norm(lumen.bounds.high - lumen.bounds.low);
    const SpacingSettings settings{.smallest = finest,
                                   .largest = std::max(finest, numerics.largest_spacing.value_or(widest)),
                                   .across = *numerics.across};
    return vessel ? make_spacing_field(lumen, balls_of(*vessel->along), settings) : make_spacing_field(lumen, settings);
}

CellPoints make_cell_points(const Lumen& lumen, const SpacingField& field) {
    GradedPoints graded = make_graded_points(lumen, field);
    return {std::move(graded.points), std::move(graded.spacing), field};
}

CellPoints make_cell_points(const Lumen& lumen, double spacing) {
    const FittedPoints fitted = make_relaxed_points(lumen, spacing, {});
    const std::size_t count = fitted.fluid_count.empty() ? fitted.fluid.size() : fitted.fluid_count[0];
    CellPoints points;
    points.point.assign(fitted.fluid.begin(), fitted.fluid.begin() + std::ptrdiff_t(count));
    points.spacing.assign(count, spacing);
    points.spacing_at = [spacing](const Vec3&) { return spacing; };
    return points;
}

std::unique_ptr<CellScene> make_cell_scene(const deck::Case& config, const Lumen& lumen, const CellPoints& points) {
    auto scene = std::make_unique<CellScene>(CellScene{
        config, lumen, make_cell_mesh(points.point, points.spacing, lumen), points.spacing_at, {}, 0, {}, {}});
    complete_openings(scene->config, lumen.openings);
    std::vector<EndLaw> laws;
    for (const Opening& opening : lumen.openings) {
        const deck::Opening& said = scene->config.openings.at(opening.name);
        laws.push_back(make_end_law(opening, said, scene->config));
        scene->ends.push_back(make_end(opening, said, laws.back(), config.blood));
    }
    scene->reference_speed = estimate_expected(scene->config, lumen, laws, make_material(config.blood)).speed;
    const CellFluid fluid{config.blood.density, make_rheology(config.blood), config.wall.slip == deck::Slip::free_slip};
    scene->balance = std::make_unique<CellBalance>(scene->mesh, fluid, scene->ends, scene->reference_speed);
    return scene;
}

void solve_scene(CellScene& scene, const CellScene* coarser, const CellSolverSettings& settings) {
    if (coarser) {
        scene.balance->set_fields(coarser->balance->fields_at(scene.mesh.point));
        scene.balance->start_ends_as(
            *coarser->balance);   // or the first gradients would see other pressures at the openings
    }
    CellMatrix matrix(scene.mesh);
    scene.solution = solve_steady(*scene.balance, matrix, settings);
}

std::unique_ptr<CellScene> make_solved_scene(const deck::Case& config,
                                             const std::function<bool(const CellScene&)>& watch,
                                             const std::function<std::string(const CellScene&)>& describe_remains,
                                             std::shared_ptr<const Vessel> vessel) {
    if (!vessel && config.has_vessel()) vessel = std::make_shared<const Vessel>(read_vessel(config));
    const Lumen lumen = make_cell_lumen(config, vessel.get());
    const deck::Numerics& numerics = config.numerics;
    std::optional<SpacingField> field;
    if (numerics.follows_vessel()) field = make_cell_spacing(lumen, vessel.get(), numerics);
    const double across = field ? *numerics.across : lumen.narrowest / numerics.spacing;
    const auto solved = [&](double coarser_by, const CellScene* coarser) {
        auto scene = make_cell_scene(config, lumen,
                                     field ? make_cell_points(lumen, field->scaled(coarser_by))
                                           : make_cell_points(lumen, coarser_by * numerics.spacing));
        scene->vessel = vessel;
        CellSolverSettings settings{.tolerance = coarser_by > 1 ? coarse_tolerance : CellSolverSettings{}.tolerance,
                                    .starts_sharp = coarser && !coarser->solution.is_damped,
                                    .gives_up = numerics.without_rest == deck::WithoutRest::follow};
        if (settings.gives_up)
            settings.mixes_below = 0;   // steps that are mixed find a steady flow also where none would last
        // Nor would finer cells find rest: only what the coarse ones' fields lack on them is to fade.
        if (coarser && coarser->solution.is_given_up) settings.most_iterations = fading;
        if (coarser_by > 1) settings.most_sharp_iterations = coarse_sharp_steps;
        if (watch) settings.interrupted = [&] { return watch(*scene); };
        try {
            solve_scene(*scene, coarser, settings);
        } catch (const DivergedError& error) {
            if (!describe_remains) throw;
            throw DivergedError(error.what() + describe_remains(*scene));
        }
        return scene;
    };
    std::unique_ptr<CellScene> coarse;
    if (across > fewest_across * coarsening) {
        coarse = solved(coarsening, nullptr);
        if (is_interrupted(coarse->solution)) return coarse;
    }
    return solved(1, coarse.get());
}

}   // namespace patency
