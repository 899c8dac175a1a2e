// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "patency/analysis/section_flow.h"
#include "patency/base/errors.h"
#include "patency/stages/bed.h"
#include "patency/stages/cell_build.h"
#include "patency/stages/estimated_field.h"
#include "patency/stages/flow.h"
#include "patency/stages/initial_state.h"
#include "patency/stages/lumen_of_case.h"
#include "patency/stages/material.h"
#include "patency/stages/speeds.h"

namespace patency {

namespace {

// Beside the points: what a particle may stray before it has left the domain, and what a buffer's tail needs.
constexpr double margin_spacings = 5;

double support_of(const FlowNumerics& numerics) { return 2 * numerics.smoothing_ratio * numerics.spacing; }

PointsExtent extent_of(const FlowNumerics& numerics) {
    const double dp = numerics.spacing, support = support_of(numerics), buffer = buffer_spacings * dp;
    return {.wall_thickness = support + 0.5 * dp, .fluid_extension = buffer, .wall_extension = buffer + support};
}

FlowNumerics make_numerics(const deck::Case& config, const Lumen& lumen) {
    FlowNumerics numerics;
    numerics.spacing = config.numerics.spacing;
    if (config.numerics.follows_vessel()) {   // the widest there is
        const auto wide = [](const Opening& a, const Opening& b) { return a.radius < b.radius; };
        numerics.spacing =
            2 * std::max_element(lumen.openings.begin(), lumen.openings.end(), wide)->radius / *config.numerics.across;
    }
    numerics.smoothing_ratio = config.numerics.smoothing_ratio;
    numerics.planar = lumen.planar;
    numerics.advection_cfl = config.numerics.advection_cfl;
    numerics.acoustic_cfl = config.numerics.acoustic_cfl;
    numerics.free_slip = config.wall.slip == deck::Slip::free_slip;
    numerics.body_force = config.body_force;
    return numerics;
}

// To the radius, of the grid that measures an entrance's section: to 1e-3 of its area.
constexpr int squares_across = 24;

/// The section at the end of an opening's entrance: none in a plane, whose sections have no grid; where the vessel parts before; or
/// where another opening is near.
std::optional<SectionShape> entrance_section_of(const Scene& scene, const OpenEnd& end) {
    const Lumen& lumen = scene.lumen;
    if (lumen.planar) return {};
    const double dp = scene.numerics.spacing, radius = std::sqrt(end.area / std::numbers::pi);
    const WallHint wall{.distance = [&](const Vec3& x) { return lumen.distance.value(x); },
                        .normal = [&](const Vec3& x) { return lumen.distance.gradient(x); },
                        .velocity = {}};
    const auto is_clear = [&](const Vec3& x) {
        return end.in_reach(x) && std::none_of(scene.ends.begin(), scene.ends.end(), [&](const OpenEnd& other) {
                   return &other != &end && other.axial(x) > -near_end * dp && other.in_reach(x);
               });
    };
    for (double depth = 1;; ++depth) {
        const bool is_last = depth == entrance_depth;
        const SectionGrid grid = make_section_grid({end.centre - depth * dp * end.normal, end.normal, radius}, wall,
                                                   is_last ? squares_across : squares_across / 3);
        if (grid.place.empty() || !grid.closed || !std::all_of(grid.place.begin(), grid.place.end(), is_clear))
            return {};
        if (is_last) return shape_of(grid);
    }
}

void make_ends(Scene& scene) {
    const double dp = scene.numerics.spacing;
    for (const Opening& opening : scene.lumen.openings) {
        const deck::Opening& said = scene.config.openings.at(opening.name);
        // Fewer particles do not see a section; a profile would be noise.
        if (2 * opening.radius < 4 * dp && !scene.config.numerics.follows_vessel())
            throw GeometryError(
                fmt::format("openings.{}: {:.3g} mm wide, less than 4 particles of numerics.spacing {:.3g} mm",
                            opening.name, 2e3 * opening.radius, 1e3 * dp));
        EndLaw law = make_end_law(opening, said, scene.config);
        OpenEnd end;
        end.name = opening.name;
        end.kind = law.prescribes_flow() ? OpenEnd::Kind::velocity : OpenEnd::Kind::pressure;
        end.centre = opening.centre;
        end.normal = opening.normal;
        end.area = opening.area;
        end.mean_square = opening.mean_square;
        end.reach = opening.reach + dp;
        end.buffer_length = buffer_spacings * dp;
        if (law.prescribes_flow()) {
            end.velocity = make_end_velocity(opening, said, law, scene.config.blood);
            end.imposed_flow = [flow = make_end_flow(opening, said, law, scene.config.blood)](double time) {
                return -flow(time);
            };
        }
        scene.ends.push_back(std::move(end));
        scene.laws.push_back(std::move(law));
    }
    for (OpenEnd& end : scene.ends)
        if (end.imposed_flow) end.entrance_section = entrance_section_of(scene, end);
}

std::unique_ptr<Frame> make_frame(const Scene& scene) {
    const Lumen& lumen = scene.lumen;
    const double dp = scene.numerics.spacing;
    const PointsExtent extent = extent_of(scene.numerics);
    const double past =
        (lumen.openings.empty() ? 0 : extent.wall_extension) + extent.wall_thickness + margin_spacings * dp;
    Bounds box = grown(lumen.bounds, past);
    const std::array<bool, 3> periodic{lumen.period.x > 0, lumen.period.y > 0, lumen.period.z > 0};
    if (periodic[0]) box.low.x = lumen.bounds.low.x, box.high.x = lumen.bounds.high.x;
    if (periodic[1]) box.low.y = lumen.bounds.low.y, box.high.y = lumen.bounds.high.y;
    if (periodic[2]) box.low.z = lumen.bounds.low.z, box.high.z = lumen.bounds.high.z;
    if (lumen.planar) box.low.z = -dp, box.high.z = dp;
    return std::make_unique<Frame>(box.low, box.high, support_of(scene.numerics), periodic);
}

/// Takes from the deck's pressures the lowest that it imposes. The same flow at another level is then the same numbers, bit for
/// bit, and not nearly the same, of which particles soon make a different flow.
void set_datum(Scene& scene) {
    // Levels that move or begin at zero, and what is asked for without a level, stay as they are.
    if (scene.config.scheme() == deck::SchemeName::cells ||
        scene.config.numerics.pressure_reference != deck::PressureReference::moving)
        return;
    double lowest = INFINITY;
    for (const auto& [name, opening] : scene.config.openings) {
        using deck::OpeningType;
        if (opening.type == OpeningType::velocity || opening.type == OpeningType::flow) continue;
        if (opening.type == OpeningType::coronary || opening.waveform || opening.ramp > 0) return;
        lowest = std::min(lowest, opening.type == OpeningType::pressure ? *opening.pressure : opening.distal_pressure);
    }
    if (!std::isfinite(lowest)) return;
    scene.datum = lowest;
    for (auto& [name, opening] : scene.config.openings) {
        if (opening.pressure) *opening.pressure -= lowest;
        if (opening.initial_pressure) *opening.initial_pressure -= lowest;
        opening.distal_pressure -= lowest;
    }
}

/// The vessel behind the lumen and its estimate, which knows the narrowest place that nobody named.
void follow(Scene& scene) {
    scene.estimate = estimate_flow(scene.config, *scene.vessel);
    for (const Centreline& line : scene.vessel->along->lines.lines)
        for (const CentrelinePoint& point : line.points)
            scene.lumen.narrowest = std::min(scene.lumen.narrowest, 2 * point.radius);
}

/// Compliances begin as the estimate's flow would leave them, where the deck names no pressure and no pulse tells what is in them.
void fill_compliances(Scene& scene) {
    if (is_driven_by_pulse(scene.config)) return;
    const auto& openings = scene.vessel->openings;
    for (std::size_t k = 0; k < openings.size(); ++k)
        for (std::size_t e = 0; e < scene.ends.size(); ++e) {
            EndLaw& law = scene.laws[e];
            if (!law.outlet || scene.ends[e].name != openings[k].opening.name) continue;
            if (scene.config.openings.at(scene.ends[e].name).initial_pressure) continue;
            law.state = law.level_state = make_steady_state(*law.outlet, scene.estimate->opening_flows[k]);
        }
}

Expected expect_flow(const Scene& scene) {
    Expected expected = estimate_expected(scene.config, scene.lumen, scene.laws, scene.material);
    if (scene.estimate)
        expect_estimate(expected, scene.config, EstimatedField(*scene.vessel, *scene.estimate), scene.laws,
                        scene.material);
    return expected;
}

/// Zero, or of the deck's wall that the particle belongs to.
Vec3 wall_velocity(const deck::Wall& wall, const Vec3& normal) {
    if (const auto named = wall.velocity.find(std::string(plane_wall_name(normal))); named != wall.velocity.end())
        return named->second;
    if (const auto all = wall.velocity.find("all"); all != wall.velocity.end()) return all->second;
    return {};
}

void expect_wall_names(const Scene& scene) {
    const auto& shape = scene.config.geometry.shape;
    const bool has_plane_walls = shape && (shape->is_planar() || shape->type == deck::ShapeType::box);
    for (const auto& [name, velocity] : scene.config.wall.velocity) {
        const bool is_plane =
            name.size() > 2 && (name.ends_with("_low") || name.ends_with("_high")) && name[0] >= 'x' && name[0] <= 'z';
        if (name != "all" && !(has_plane_walls && is_plane))
            throw DeckError(fmt::format("wall.velocity.{}: the shape has no such wall; use all{}", name,
                                        has_plane_walls ? ", y_low, y_high (x_, z_ in boxes)" : ""));
    }
}

void place_particles(Scene& scene) {
    const Lumen& lumen = scene.lumen;
    const FittedPoints points =
        make_relaxed_points(lumen, scene.numerics.spacing, extent_of(scene.numerics), &scene.relax_quality);
    if (points.fluid.empty()) throw GeometryError("no particle fits into the lumen: numerics.spacing is too large");

    FluidParticles& fluid = scene.fluid;
    fluid.resize(points.fluid.size());
    std::size_t i = 0;
    for (std::size_t part = 0; part < points.fluid_count.size(); ++part)
        for (std::size_t n = 0; n < points.fluid_count[part]; ++n, ++i) {
            fluid.position[i] = points.fluid[i];
            fluid.volume[i] = points.volume;
            fluid.opening[i] = std::int32_t(part);   // 0 inside, else past opening part - 1
        }
    for (std::size_t k = 0; k < scene.ends.size(); ++k) scene.ends[k].buffer_length = points.fluid_end[k];

    WallParticles& wall = scene.wall;
    wall.resize(points.wall.size());
    for (std::size_t w = 0; w < wall.size(); ++w) {
        const DistanceSample here = lumen.distance.sample(points.wall[w]);
        wall.position[w] = points.wall[w];
        wall.normal[w] = here.gradient;
        wall.depth[w] = here.value;
        wall.curvature[w] =
            lumen.distance.curvature(points.wall[w] - here.value * here.gradient);   // of the surface itself
        wall.velocity[w] = wall_velocity(scene.config.wall, here.gradient);
        wall.volume[w] = points.volume;
    }
}

// In times that sound needs through the vessel. The slowest swing is let out: between ends that impose flow and pressure a quarter
// of a wave, between two pressures a half. A longer memory would let more of it out; but at a pressure it delays the flow's own way
// to rest, like so much more vessel.                                                                  THEORY.md (8.12), (8.13)
constexpr double memory_at_flow = 2, memory_at_pressure = 0.5;
// In spacings: the pressure of an end is that of a few layers within it.
constexpr double sound_delay = 8;

/// A run that waits for its flow to settle need not wait for sound between its ends.
void absorb_sound(Scene& scene) {
    const deck::Case& config = scene.config;
    if (config.about.mode != deck::Mode::steady || !config.numerics.convergence) return;
    const double c = scene.material.sound_speed, crossing = norm(scene.lumen.bounds.high - scene.lumen.bounds.low) / c;
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        const EndLaw& law = scene.laws[k];
        const bool is_constant = law.outlet ? !std::holds_alternative<Coronary>(*law.outlet)
                                            : law.signal.waveform.is_constant() && law.signal.ramp == 0;
        if (!is_constant || (law.prescribes_flow() && law.signal(0) == 0)) continue;
        scene.ends[k].absorber = {.impedance = scene.material.density * c / scene.ends[k].area,
                                  .memory = (law.prescribes_flow() ? memory_at_flow : memory_at_pressure) * crossing,
                                  .delay = sound_delay * scene.numerics.spacing / c};
    }
}

}   // namespace

std::unique_ptr<Scene> build_frame(const deck::Case& config, const Vessel* known) {
    auto scene = std::make_unique<Scene>();
    scene->config = config;
    if (config.wall.motion != deck::WallMotion::rigid)
        throw DeckError("wall.motion: walls that deform come with the solids; use rigid");
    if (config.has_vessel()) scene->vessel = known ? *known : read_vessel(config);
    scene->lumen = make_lumen(config, config.geometry.surface ? &*scene->vessel : nullptr);
    scene->nominal_narrowest = scene->lumen.narrowest;
    complete_openings(scene->config, scene->lumen.openings);
    set_datum(*scene);
    if (scene->vessel) follow(*scene);
    expect_wall_names(*scene);
    scene->material = make_material(config.blood);
    scene->numerics = make_numerics(config, scene->lumen);
    make_ends(*scene);
    const auto start = config.initial_pressure();
    if (scene->estimate && (start == deck::InitialPressure::estimate || start == deck::InitialPressure::cells))
        fill_compliances(*scene);
    const Expected expected = expect_flow(*scene);
    scene->numerics.reference_speed = expected.speed;
    scene->material.sound_speed = choose_sound_speed(config, scene->lumen, expected, scene->material);
    absorb_sound(*scene);
    scene->frame = make_frame(*scene);
    return scene;
}

std::unique_ptr<Scene> build_scene(const deck::Case& config) {
    if (config.scheme() == deck::SchemeName::cells) return build_cell_scene(config);
    auto scene = build_frame(config);
    place_particles(*scene);
    // The level at time zero, of ends through which nothing flows yet.
    scene->reference_pressure = impose_laws(scene->laws, scene->ends, 0, 0, config.numerics.pressure_reference);
    for (EndLaw& law : scene->laws) law.is_started = false;
    compute_initial_state(*scene);
    start_scheme(*scene);
    return scene;
}

}   // namespace patency
