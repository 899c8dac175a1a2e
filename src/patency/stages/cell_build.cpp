// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/cell_build.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/schemes/cell_march.h"
#include "patency/stages/build.h"
#include "patency/stages/cell_scene.h"
#include "patency/stages/initial_state.h"
#include "patency/stages/material.h"
#include "patency/stages/waveform_of_deck.h"

namespace patency {

namespace {

bool is_periodic(const Scene& scene) { return scene.config.about.mode == deck::Mode::periodic; }

/// What an opening's waveform is at first; the mean of a flow that nearly rests then, which no steady flow can be found from.
double start_of(const EndLaw& law) {
    constexpr double nearly_at_rest = 0.1;
    const double now = law.signal.waveform(0), mean = law.signal.waveform.mean();
    return law.prescribes_flow() && std::abs(now) < nearly_at_rest * std::abs(mean) ? mean : now;
}

/// The steady case whose openings do what the case's do at first.
deck::Case start_of(const deck::Case& config, const Scene& scene) {
    deck::Case start = config;
    start.about.mode = deck::Mode::steady;
    const bool is_known = is_driven_by_pulse(config);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        deck::Opening& opening = start.openings.at(scene.ends[k].name);
        const double value = opening.waveform ? start_of(scene.laws[k]) : 0;
        if (opening.waveform && opening.type == deck::OpeningType::pressure) opening.pressure = value;
        if (opening.waveform && opening.type == deck::OpeningType::flow) opening.flow = value;
        if (opening.waveform && opening.type == deck::OpeningType::velocity)
            opening.velocity = value / scene.ends[k].area;
        opening.waveform.reset();
        if (is_known && scene.laws[k].outlet && opening.type != deck::OpeningType::resistance) {
            opening.type = deck::OpeningType::resistance;   // at once a compliance holds its pressure
            opening.resistance = opening.proximal_resistance;
            opening.distal_pressure = scene.laws[k].state[0];
        }
        opening.ramp = 0;
        if (opening.profile == deck::VelocityProfile::womersley) opening.profile = deck::VelocityProfile::parabola;
    }
    return start;
}

std::vector<MarchedEnd> marched_ends(const Scene& scene, const Rheology& rheology) {
    std::vector<MarchedEnd> ends;
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        const Opening& opening = scene.lumen.openings[k];
        const EndLaw& law = scene.laws[k];
        const bool is_drawn =
            law.prescribes_flow() && law.signal.waveform.mean() < 0;   // blood that is drawn out finds its own profile
        // Of shear-thinning blood that of the mean shear in a parabola that reaches the reference speed.
        const double shear = scene.numerics.reference_speed * 4 / 3 / opening.radius;
        ends.push_back({.kind = !law.prescribes_flow() ? CellEnd::Kind::pressure
                                : is_drawn             ? CellEnd::Kind::flow
                                                       : CellEnd::Kind::velocity,
                        .section = opening.planar ? Section::planar : Section::circular,
                        .radius = opening.radius,
                        .viscosity = viscosity(rheology, shear) / scene.config.blood.density});
    }
    return ends;
}

/// How long blood takes to pass the narrowest place's diameter [s].
double passage_of(const Scene& scene) { return scene.lumen.narrowest / scene.numerics.reference_speed; }

/// Of a pulse as the deck says. Of a jet that swings a half of its passage: its eddies, about as wide, go by in four.
double longest_step_of(const Scene& scene) {
    constexpr double per_passage = 0.5;
    return is_periodic(scene) ? *scene.config.about.period / scene.config.numerics.steps_per_period
                              : per_passage * passage_of(scene);
}

/// A flow without rest is watched in windows of so many passages: a jet swings to and fro once in three or five, what it leaves behind goes round
/// ten times as slowly. The deck's own times are those of moving particles, which start from rest.
void watch_jets(Scene& scene) {
    constexpr double passages = 50, windows = 40;
    deck::Numerics& numerics = scene.config.numerics;
    if (!numerics.convergence) numerics.convergence.emplace();
    numerics.convergence->window = passages * passage_of(scene);
    numerics.duration = windows * *numerics.convergence->window;
}

/// Two Newton's steps leave a tenth of what changes in a step, and means ask for no more.
constexpr MarchedStep of_jets{.tolerance = 5e-3, .least = 2};

void start_march(Scene& scene, CellMesh mesh) {
    if (!is_periodic(scene)) watch_jets(scene);
    constexpr double careful = 1.0 / 64;   // a jet was left somewhere on its way
    const double longest = longest_step_of(scene);
    const Rheology rheology = make_rheology(scene.config.blood);
    auto march = std::make_unique<CellMarch>(
        CellMarchDomain{.mesh = std::move(mesh),
                        .material = {scene.config.blood.density, rheology, scene.numerics.free_slip},
                        .fluid = scene.fluid,
                        .ends = scene.ends,
                        .marched = marched_ends(scene, rheology),
                        .reference_speed = scene.numerics.reference_speed,
                        .first_step = is_periodic(scene) ? longest : careful * longest,
                        .longest_step = longest,
                        .each_step = is_periodic(scene) ? MarchedStep{} : of_jets});
    const CellMarch& started = *march;
    march->update_ends = [&scene](std::span<OpenEnd> ends, double time, double dt) {
        impose_laws_ahead(scene.laws, ends, time, dt);
    };
    march->settle_ends = [&scene, &started] {
        advance_laws(scene.laws, scene.ends, scene.time);
        scene.wall_parts = wall_parts_of(started.mesh(), started.balance());
    };
    scene.scheme = std::move(march);
}

std::unique_ptr<Scene> build_frame_of_cells(const deck::Case& config) {
    auto scene = build_frame(config);
    expect_possible(config);
    return scene;   // its reference pressure is zero: fields are in double precision
}

CellMesh place_points(Scene& scene) {
    const deck::Numerics& numerics = scene.config.numerics;
    const Vessel* vessel = scene.vessel ? &*scene.vessel : nullptr;
    Lumen lumen = scene.lumen;
    lumen.narrowest = scene.nominal_narrowest;   // as make_solved_scene has it: a resumed run is on the same cells
    const CellPoints points = numerics.follows_vessel()
                                  ? make_cell_points(lumen, make_cell_spacing(lumen, vessel, numerics))
                                  : make_cell_points(lumen, numerics.spacing);
    scene.spacing_at = points.spacing_at;
    CellMesh mesh = make_cell_mesh(points.point, points.spacing, scene.lumen);
    place_cells(scene, mesh);
    return mesh;
}

/// Flows and pressures that the ends start from, and compliances that these have filled where no pulse tells what is in them.
void start_ends(Scene& scene, std::span<const CellEndState> states) {
    const bool is_known = is_driven_by_pulse(scene.config);
    for (std::size_t k = 0; k < states.size(); ++k) {
        EndLaw& law = scene.laws[k];
        scene.ends[k].flow = law.known_flow = states[k].flow;
        scene.ends[k].mean_pressure = law.known_pressure = states[k].pressure;
        if (law.outlet && !is_known && !scene.config.openings.at(scene.ends[k].name).initial_pressure)
            law.state = make_steady_state(*law.outlet, states[k].flow);
    }
}

void go_on(Scene& scene, const CellScene& solved) {
    scene.spacing_at = solved.spacing_at;
    place_cells(scene, solved.mesh);
    set_flow(scene, solved.balance->fields());
    start_ends(scene, solved.balance->end_states());
    start_march(scene, solved.mesh);
}

}   // namespace

WallParts wall_parts_of(const CellMesh& mesh, const CellBalance& balance) {
    const auto stress = balance.wall_shear_stress();
    const auto pressure = balance.patch_pressure();
    WallParts parts;
    for (std::size_t k = 0; k < stress.size(); ++k) {
        const CellPatch& patch = mesh.patches[k];
        if (patch.opening != CellPatch::wall) continue;
        parts.places.position.push_back(patch.centroid);
        parts.places.normal.push_back(patch.normal);
        parts.area.push_back(norm(patch.area));
        parts.flow.shear_stress.push_back(stress[k]);
        parts.flow.pressure.push_back(pressure[k]);
    }
    return parts;
}

void place_cells(Scene& scene, const CellMesh& mesh) {
    scene.fluid.resize(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        scene.fluid.position[i] = mesh.point[i];
        scene.fluid.volume[i] = mesh.volume[i] / mesh.depth;
    }
    std::vector<const CellPatch*> feet;
    for (const CellPatch& patch : mesh.patches)
        if (patch.opening == CellPatch::wall) feet.push_back(&patch);
    scene.wall.resize(feet.size());
    for (std::size_t k = 0; k < feet.size(); ++k) {
        scene.wall.position[k] = feet[k]->centroid;
        scene.wall.normal[k] = feet[k]->normal;
        scene.wall.depth[k] = 0;
    }
}

void set_flow(Scene& scene, const CellFields& fields) {
    for (std::size_t i = 0; i < fields.velocity.size(); ++i) {
        scene.fluid.velocity[i] = fields.velocity[i];
        scene.fluid.pressure[i] = fields.pressure[i];
    }
}

std::unique_ptr<Scene> build_cell_frame(const deck::Case& config) {
    auto scene = build_frame_of_cells(config);
    start_march(*scene, place_points(*scene));
    return scene;
}

std::unique_ptr<Scene> build_cell_scene(const deck::Case& config) {
    auto scene = build_frame_of_cells(config);
    if (config.initial.velocity) {
        CellMesh mesh = place_points(*scene);
        compute_initial_state(*scene);
        start_march(*scene, std::move(mesh));
        return scene;
    }
    go_on(*scene, *make_solved_scene(start_of(scene->config, *scene)));
    return scene;
}

std::unique_ptr<Scene> build_cell_scene(const deck::Case& config, const CellScene& solved) {
    auto scene = build_frame_of_cells(config);
    go_on(*scene, solved);
    return scene;
}

}   // namespace patency
