// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/initial_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/stages/estimated_field.h"
#include "patency/stages/lumen_of_case.h"

namespace patency {

namespace {

using VectorField = std::function<Vec3(const Vec3&)>;

// How fast a jet widens, at most: so much radius per length is what laboratories saw behind the sudden expansion of the FDA's nozzle
// at Re 500, where the peak falls from 0.73 to 0.61 m/s over 48 mm. What widens faster is left by the flow, which goes on as a jet.
constexpr double jet_widening = 0.004;

StraightAxis axis_for(const Scene& scene, const char* what) {
    auto axis = find_straight_axis(scene.config.geometry);
    if (!axis)
        throw DeckError(fmt::format(
            "{} needs a shape with one straight axis: channel, tube, cone or nozzle; start from rest", what));
    return *axis;
}

/// Radius of the stream at a place along the axis: the lumen's, or that of the jet that left a narrower place upstream [m].
double stream_radius(const StraightAxis& axis, double axial) {
    double radius = axis.radius_at(axial);
    for (const AxialRadius& place : axis.outline)
        if (place.axial <= axial) radius = std::min(radius, place.radius + jet_widening * (axial - place.axial));
    return radius;
}

/// Velocity of the flow that a waveform drives: its profile at time zero.
VectorField womersley_field(const Scene& scene) {
    for (std::size_t k = 0; k < scene.ends.size(); ++k)
        if (scene.ends[k].velocity) return scene.ends[k].velocity(0);
    const StraightAxis axis = axis_for(scene, "initial.velocity: womersley");
    if (scene.laws.size() != 2) throw DeckError("initial.velocity: womersley needs a waveform at an opening");
    // Between two pressures: the flow of their difference, one period long.
    constexpr std::size_t modes = 20;
    const double radius = axis.outline.front().radius;
    const FourierSeries inlet = make_fourier_series(scene.laws[0].signal.waveform, modes);
    const FourierSeries outlet = make_fourier_series(scene.laws[1].signal.waveform, modes);
    const FourierSeries& pulse = inlet.modes() > 0 ? inlet : outlet;
    FourierSeries gradient{(inlet.mean - outlet.mean) / axis.length, {}, {}, pulse.period};
    gradient.cosines.resize(pulse.modes()), gradient.sines.resize(pulse.modes());
    for (std::size_t k = 1; k <= pulse.modes(); ++k) {
        const auto of = [&](const FourierSeries& s) {
            return k <= s.modes() ? s.amplitude(k) : std::complex<double>{};
        };
        gradient.set_amplitude(k, (of(inlet) - of(outlet)) / axis.length);
    }
    const double rho = scene.material.density, mu = scene.material.viscosity;
    const WomersleyProfile profile(axis.section, radius, rho, mu,
                                   make_womersley_flow(axis.section, radius, rho, mu, gradient));
    return [axis, radius, now = profile.at(0)](const Vec3& x) {
        return now(std::min(axis.radial(x) / radius, 1.0)) * axis.direction;
    };
}

/// A particle stands for the cell around it, whose mean of a curved profile is less than the value in its middle: in a parabola
/// eight spacings wide by 2 % of the flow, which sound would have to take away. Exact for quadratic profiles: the mean of the points
/// half a spacing away, at the wall the last of which rests.
VectorField mean_over_cell(VectorField velocity, double spacing) {
    return [velocity = std::move(velocity), ways = ways_around(spacing)](const Vec3& x) {
        Vec3 sum{};
        for (const Vec3& d : ways) sum += velocity(x + d);
        return sum / 6;
    };
}

std::shared_ptr<const EstimatedField> estimated_field(const Scene& scene) {
    return std::make_shared<const EstimatedField>(*scene.vessel, *scene.estimate);
}

/// A pulse starts where its inflow does.
double share_of_estimate(const Scene& scene) {
    double now = 0, mean = 0;
    for (const EndLaw& law : scene.laws)
        if (law.prescribes_flow()) now += law.signal(0), mean += law.signal.waveform.mean();
    return std::abs(mean) > 0 ? now / mean : 1;
}

VectorField velocity_field(const Scene& scene) {
    const deck::Initial& initial = scene.config.initial;
    const double speed = initial.speed.value_or(0);
    switch (scene.config.initial_velocity()) {
        case deck::InitialVelocity::rest: return [](const Vec3&) { return Vec3{}; };
        case deck::InitialVelocity::plug: {
            const auto axis = find_straight_axis(scene.config.geometry);
            const Vec3 direction = axis ? axis->direction : Vec3{1, 0, 0};
            return [=](const Vec3&) { return speed * direction; };
        }
        case deck::InitialVelocity::parabola: {
            const StraightAxis axis = axis_for(scene, "initial.velocity: parabola");
            const double first = section_area(axis.section, axis.outline.front().radius);
            return [=](const Vec3& x) {   // the mean is that of the first section; the same flow passes everywhere
                const double radius = stream_radius(axis, axis.axial(x)), share = axis.radial(x) / radius;
                if (share > 1) return Vec3{};   // beside the jet
                const double mean = speed * first / section_area(axis.section, radius);
                return mean * parabola_profile(axis.section, share) * axis.direction;
            };
        }
        case deck::InitialVelocity::taylor_green: {
            const double k = 2 * std::numbers::pi / scene.config.geometry.shape->size.x;
            return [=](const Vec3& x) {   // THEORY.md (12.7)
                return Vec3{-speed * std::cos(k * x.x) * std::sin(k * x.y),
                            speed * std::sin(k * x.x) * std::cos(k * x.y), 0};
            };
        }
        case deck::InitialVelocity::womersley: return womersley_field(scene);
        case deck::InitialVelocity::cells: break;   // all places at once
        case deck::InitialVelocity::estimate: {
            const auto at = [&scene, share = share_of_estimate(scene), field = estimated_field(scene)](const Vec3& x) {
                return share * field->at(x, -scene.lumen.distance.value(x)).velocity;
            };
            return mean_over_cell(at, scene.numerics.spacing);
        }
    }
    return [](const Vec3&) { return Vec3{}; };
}

struct PressureField {
    std::function<double(const Vec3&)> value;
    VectorField gradient;
};

PressureField taylor_green_pressure(const Scene& scene) {
    const double k = 2 * std::numbers::pi / scene.config.geometry.shape->size.x;
    const double p = 0.25 * scene.material.density * *scene.config.initial.speed * *scene.config.initial.speed;
    return {[=](const Vec3& x) { return -p * (std::cos(2 * k * x.x) + std::cos(2 * k * x.y)); },
            [=](const Vec3& x) {
                return Vec3{2 * k * p * std::sin(2 * k * x.x), 2 * k * p * std::sin(2 * k * x.y), 0};
            }};
}

/// Linear along the axis between the openings' pressures; where the inlet prescribes a flow, with Poiseuille's gradient
/// of the initial velocity up from the outlet.
PressureField linear_pressure(const Scene& scene) {
    const StraightAxis axis = axis_for(scene, "initial.pressure: linear");
    double first = NAN, last = NAN;
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        if (scene.laws[k].prescribes_flow()) continue;
        const EndLaw& law = scene.laws[k];
        const double p = law.outlet ? scene.reference_pressure : law.signal(0);   // an outlet model starts at the level
        (dot(scene.ends[k].normal, axis.direction) < 0 ? first : last) = p;
    }
    const double a = axis.outline.front().radius;
    double slope = 0;
    const auto velocity = scene.config.initial_velocity();
    if (velocity != deck::InitialVelocity::rest && velocity != deck::InitialVelocity::plug)
        slope = -scene.config.initial.speed.value_or(0) * scene.material.viscosity *
                (axis.section == Section::planar ? 3 : 8) / (a * a);
    if (!std::isnan(first) && !std::isnan(last))
        slope = (last - first) / axis.length;
    else if (std::isnan(first))
        first = last - slope * axis.length;
    return {[=](const Vec3& x) { return first + slope * axis.axial(x); },
            [=](const Vec3&) { return slope * axis.direction; }};
}

PressureField pressure_field(const Scene& scene) {
    if (scene.config.initial_velocity() == deck::InitialVelocity::taylor_green) return taylor_green_pressure(scene);
    if (scene.config.initial_pressure() == deck::InitialPressure::linear) return linear_pressure(scene);
    if (scene.config.initial_pressure() == deck::InitialPressure::estimate) {
        const auto field = estimated_field(scene);
        return {[=](const Vec3& x) { return field->at(x, 0).pressure; },
                [=](const Vec3& x) { return field->at(x, 0).pressure_gradient; }};
    }
    const double level = scene.reference_pressure;   // zero above the level: no shock where nothing drives
    return {[=](const Vec3&) { return level; }, [](const Vec3&) { return Vec3{}; }};
}

}   // namespace

namespace {

/// Of the case's own accord: what cannot be solved on cells starts from the estimate.
void fall_back(Scene& scene, const Error& error) {
    deck::Initial& initial = scene.config.initial;
    if (initial.velocity == deck::InitialVelocity::cells || initial.pressure == deck::InitialPressure::cells) throw;
    if (!initial.velocity) initial.velocity = deck::InitialVelocity::estimate;
    if (!initial.pressure) initial.pressure = deck::InitialPressure::estimate;
    scene.start_remark = fmt::format("starts from the estimate, for on cells: {}", error.what());
}

/// Velocities of places between those where they are known carry a per cent more or less than is known to flow, and so do profiles over the
/// distance to the wall of a section that is not round. Sound would have to take it away, and leaves the flow swinging for as long
/// as blood needs through the vessel. So every branch's velocities are scaled to what it carries.         THEORY.md (15.6)
void scale_to_flows(Scene& scene, const std::vector<double>& out) {
    FluidParticles& fluid = scene.fluid;
    const std::vector<double> flows = branch_flows(scene.vessel->along->lines, scene.lumen.openings, out);
    const auto field = estimated_field(scene);
    const std::vector<double> carried =
        field->carried({&fluid.position[0], fluid.size()}, {&fluid.velocity[0], fluid.size()}, fluid.volume[0]);
    constexpr double most = 1.25;   // where more lacks something else is wrong
    std::vector<double> share;
    for (std::size_t b = 0; b < flows.size(); ++b)
        share.push_back(flows[b] * carried[b] > 0 ? std::clamp(flows[b] / carried[b], 1 / most, most) : 1);
    for (std::size_t i = 0; i < fluid.size(); ++i) fluid.velocity[i] *= share[field->branch_at(fluid.position[i])];
}

/// The flow on cells, where the case starts from it; else none. Outlets' capacitors begin as it leaves them.
std::unique_ptr<const CellStart> solve_on_cells(Scene& scene, const SolveOnCells& solve) {
    const bool is_wanted = scene.config.initial_velocity() == deck::InitialVelocity::cells ||
                           scene.config.initial_pressure() == deck::InitialPressure::cells;
    if (!is_wanted) return nullptr;
    try {
        auto start = solve(scene);
        for (std::size_t k = 0; k < scene.ends.size(); ++k)
            if (EndLaw& law = scene.laws[k];
                law.outlet && !scene.config.openings.at(scene.ends[k].name).initial_pressure)
                law.state = law.level_state = make_steady_state(*law.outlet, start->ends()[k].flow);
        scene.start_remark = fmt::format("starts from the flow on {} cells", start->cells());
        return start;
    } catch (const Error& error) {
        fall_back(scene, error);
        return nullptr;
    }
}

/// What departs from these is sound.
void start_ends(Scene& scene, const std::vector<double>& pressures, const std::vector<double>& out) {
    find_members(scene.fluid, scene.numerics.spacing, scene.ends);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        OpenEnd& end = scene.ends[k];
        end.mean_pressure = pressures[k] - scene.reference_pressure;   // where a flow is imposed
        if (scene.laws[k].prescribes_flow()) {
            end.absorber.mean = pressures[k];
            continue;
        }
        measure_flow(end, scene.fluid, 0, 0);
        end.absorber.mean = out.empty() ? end.flow : out[k];
    }
}

}   // namespace

void compute_initial_state(Scene& scene, const SolveOnCells& solve) {
    FluidParticles& fluid = scene.fluid;
    const auto on_cells = solve_on_cells(scene, solve);
    const VectorField velocity = velocity_field(scene);
    const PressureField pressure = pressure_field(scene);
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vec3& x = fluid.position[i];
        fluid.velocity[i] = velocity(x);
        fluid.pressure[i] = pressure.value(x) - scene.reference_pressure;
        fluid.pressure_gradient[i] = pressure.gradient(x);
        fluid.pressure_rate[i] = 0;
        fluid.viscosity[i] = scene.material.viscosity;
    }
    const std::span<const Vec3> places(&fluid.position[0], fluid.size());
    std::vector<double> end_pressures, out;   // what the start says of the ends; of flows, if it does
    for (const OpenEnd& end : scene.ends) end_pressures.push_back(pressure.value(end.centre));
    if (scene.config.initial_velocity() == deck::InitialVelocity::cells) {
        const std::vector<Vec3> solved = on_cells->velocities(places);
        for (std::size_t i = 0; i < fluid.size(); ++i) fluid.velocity[i] = solved[i];
        for (const CellEndState& end : on_cells->ends()) out.push_back(end.flow);
    }
    if (scene.config.initial_velocity() == deck::InitialVelocity::estimate)
        for (double flow : scene.estimate->opening_flows) out.push_back(share_of_estimate(scene) * flow);
    if (scene.config.initial_pressure() == deck::InitialPressure::cells) {
        const std::vector<double> solved = on_cells->pressures(places);
        for (std::size_t i = 0; i < fluid.size(); ++i) fluid.pressure[i] = solved[i] - scene.reference_pressure;
        for (std::size_t k = 0; k < scene.ends.size(); ++k) end_pressures[k] = on_cells->ends()[k].pressure;
    }
    if (!out.empty()) scale_to_flows(scene, out);
    start_ends(scene, end_pressures, out);
    if (scene.config.scheme() != deck::SchemeName::paper) return;
    // The paper's scheme sums densities: its particles must weigh what their pressure says.
    const double stiffness = scene.material.density * scene.material.sound_speed * scene.material.sound_speed;
    for (std::size_t i = 0; i < fluid.size(); ++i) fluid.volume[i] *= 1 + fluid.pressure[i] / stiffness;
}

}   // namespace patency
