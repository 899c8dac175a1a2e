// SPDX-License-Identifier: Apache-2.0
// Flow in a round, body-fitted pipe against Hagen-Poiseuille and Womersley: between pressures and behind a velocity
// inlet, along a lattice direction and along none.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "patency/verify/closed_forms.h"
#include "patency/verify/measures.h"
#include "patency/verify/sampling_of_scene.h"

namespace patency {

namespace {

constexpr double wall_layer = 3;   // spacings from the wall over which a parabola is fitted: three layers of particles

/// Slope of the axial velocity at the wall [1/s], over the particles in the middle half.
void add_wall_layer(const Scene& scene, const StraightAxis& axis, double weight, WallFit& fit) {
    const double radius = axis.outline.front().radius, depth = wall_layer * scene.numerics.spacing;
    for_each_near_middle(scene, axis, 0.25 * axis.length, [&](std::size_t i, double, double r) {
        if (const double s = radius - r; s > 0 && s < depth)
            fit.add(s, dot(scene.fluid.velocity[i], axis.direction), weight);
    });
}

// Pipe. Runs are called WAY_REYNOLDS_RESOLUTION, for instance pressure_re100_d12, tilted_velocity_re400_d20.

const std::array resolutions = {std::string("d12"), std::string("d20")};
const std::array reynolds = {std::string("re100"), std::string("re400")};

void measure_pipe(Scene& scene, const RunContext& context, RunData& data) {
    const StraightAxis axis = axis_of(scene);
    const double radius = axis.outline.front().radius, area = std::numbers::pi * radius * radius,
                 mu = scene.material.viscosity;
    const deck::Opening &inlet = scene.config.openings.at("inlet"), &outlet = scene.config.openings.at("outlet");
    const double exact_flow =
        inlet.pressure ? pipe_flow({radius, (*inlet.pressure - outlet.pressure.value_or(0)) / axis.length}, mu)
                       : *inlet.velocity * area;
    const double until = scene.config.numerics.duration;
    run_until(scene, context, 0.6 * until);
    TimeMean gradient;
    WallFit layer;
    ProfileFit profile = make_pipe_fit(scene, axis);
    run_until(scene, context, until, [&](const Scene& now, double dt) {
        gradient.add(pressure_gradient_in_middle(now, axis), dt);
        add_wall_layer(now, axis, dt, layer);
        add_pipe_profile(now, axis, dt, profile);
    });
    put_number(data, "flow", flow_through(profile, radius));
    put_number(data, "exact_flow", exact_flow);
    put_number(data, "gradient", gradient.value());
    put_number(data, "exact_gradient", pipe_pressure_gradient(radius, mu, exact_flow));
    put_number(data, "wss", mu * layer.slope());
    put_number(data, "exact_wss", pipe_wall_shear_stress(radius, mu, exact_flow));
    put_number(data, "radius", radius);
    data.lists["stations"] = profile.stations();
    data.lists["velocity"] = profile.values();
}

double ratio(const RunData& run, const std::string& name) { return run.number(name) / run.number("exact_" + name); }
double error_percent(const RunData& run, const std::string& name) { return 100 * std::abs(ratio(run, name) - 1); }

/// The worst of what `of` says about the runs that were done, and about those that must have been.
template <class Of>
double worst_of(const std::vector<std::string>& runs, Of of) {
    double worst = 0;
    for (const std::string& run : runs) worst = std::max(worst, of(run));
    return worst;
}

void pipe_figures(const Results& results, FigureList& figures) {
    for (const std::string& d : resolutions) {
        const std::optional<Bar> bar = Bar{d == "d12" ? 3.0 : 1.0};
        std::vector<std::string> pressure, velocity;
        for (const std::string& re : reynolds)
            for (const std::string tilt : {"", "tilted_"}) {
                pressure.push_back(tilt + "pressure_" + re + "_" + d);
                velocity.push_back(tilt + "velocity_" + re + "_" + d);
            }
        figures.add({"flow_error_percent_" + d, "percent", bar}, pressure, [&] {
            return worst_of(pressure, [&](const std::string& run) { return error_percent(results[run], "flow"); });
        });
        figures.add({"gradient_error_percent_" + d, "percent", bar}, velocity, [&] {
            return worst_of(velocity, [&](const std::string& run) { return error_percent(results[run], "gradient"); });
        });
        std::vector<std::string> all = pressure;
        all.insert(all.end(), velocity.begin(), velocity.end());
        figures.add(
            {"wss_error_percent_" + d, "percent", d == "d20" ? std::optional(Bar{3.0}) : std::nullopt}, all,
            [&] { return worst_of(all, [&](const std::string& run) { return error_percent(results[run], "wss"); }); });
    }
    // The tilt is compared at the finest spacing at which it was run.
    const std::string d = results.was_tried("tilted_pressure_re100_d20") ? "d20" : "d12";
    std::vector<std::string> pairs;
    for (const std::string drive : {"pressure_", "velocity_"})
        for (const std::string& re : reynolds) pairs.push_back(drive + re + "_" + d);
    std::vector<std::string> all = pairs;
    for (const std::string& run : pairs) all.push_back("tilted_" + run);
    figures.add({"tilt_difference_percent", "percent", Bar{1.0}}, all, [&] {
        return worst_of(pairs, [&](const std::string& run) {
            const std::string name = run.starts_with("pressure") ? "flow" : "gradient";
            return 100 * std::abs(ratio(results["tilted_" + run], name) - ratio(results[run], name));
        });
    });
    for (const std::string& run : all) {
        const std::string name = run.find("pressure") != std::string::npos ? "flow" : "gradient";
        figures.add({name + "_error_percent_" + run, "percent", {}}, {run},
                    [&] { return error_percent(results[run], name); });
    }
}

std::vector<Picture> pipe_pictures(const Results& results) {
    Plot plot{"r / R", "u / u_max", {}};
    Curve exact{"closed form", {}, {}, false};
    for (int k = 0; k <= 50; ++k) exact.x.push_back(k / 50.0), exact.y.push_back(1 - k * k / 2500.0);
    plot.curves.push_back(exact);
    for (const std::string& re : reynolds)
        for (const std::string& d : resolutions) {
            const std::string run = "pressure_" + re + "_" + d;
            if (!results.has(run)) continue;
            const RunData& r = results[run];
            const double radius = r.number("radius"),
                         peak = 2 * r.number("exact_flow") / (std::numbers::pi * radius * radius);
            Curve curve{"Re " + re.substr(2) + ", D/" + d.substr(1), {}, {}, true};
            for (std::size_t k = 0; k < r.list("stations").size(); ++k) {
                curve.x.push_back(r.list("stations")[k] / radius);
                curve.y.push_back(r.list("velocity")[k] / peak);
            }
            plot.curves.push_back(curve);
        }
    return {{"pipe_profiles", "Pipe between two pressures", format_plot(plot)}};
}

// Womersley

/// Mean wall shear stress along the axis, of the middle half [Pa].
double stress_of_parts(const WallParts& parts, const StraightAxis& axis) {
    double force = 0, area = 0;
    for (std::size_t k = 0; k < parts.area.size(); ++k) {
        if (std::abs(axis.axial(parts.places.position[k]) - 0.5 * axis.length) > 0.25 * axis.length) continue;
        force += parts.area[k] * dot(parts.flow.shear_stress[k], axis.direction), area += parts.area[k];
    }
    return force / area;
}

void measure_womersley(Scene& scene, const RunContext& context, RunData& data) {
    const StraightAxis axis = axis_of(scene);
    const double radius = axis.outline.front().radius;
    const deck::Fourier& wave = *scene.config.openings.at("inlet").waveform->fourier;
    const double omega = 2 * std::numbers::pi / wave.period, gradient = wave.cosines.at(0) / axis.length;
    auto &times = data.lists["times"], &flows = data.lists["flows"], &stresses = data.lists["stresses"];
    const auto record = [&](const Scene& now, double) {
        if (now.wall_parts) {   // cells say themselves what passes and what it does to the wall
            times.push_back(now.time);
            flows.push_back(-now.ends[0].flow);
            stresses.push_back(stress_of_parts(*now.wall_parts, axis));
            return;
        }
        WallFit layer;
        add_wall_layer(now, axis, 1, layer);
        times.push_back(now.time);
        ProfileFit profile = make_pipe_fit(now, axis);
        add_pipe_profile(now, axis, 1, profile);
        flows.push_back(flow_through(profile, radius));
        stresses.push_back(now.material.viscosity * layer.slope());
    };
    const double until = scene.config.numerics.duration;
    run_until(scene, context, until - wave.period);
    record(scene, 0);
    run_until(scene, context, until, record);
    const Oscillation oscillation{omega, scene.material.density, scene.material.viscosity};
    const auto flow = womersley_pipe_flow({radius, gradient}, oscillation);
    const auto stress = womersley_pipe_wall_shear_stress({radius, gradient}, oscillation);
    const auto put = [&](const std::string& name, std::complex<double> a) { data.lists[name] = {a.real(), a.imag()}; };
    put("exact_flow", flow);
    put("exact_stress", stress);
    put("flow", amplitude(times, flows, omega));
    put("stress", amplitude(times, stresses, omega));
    put_number(data, "angular_frequency", omega);
}

std::complex<double> complex_of(const RunData& run, const std::string& name) {
    return {run.list(name).at(0), run.list(name).at(1)};
}

/// Bars in percent of the amplitudes.
void add_womersley_figures(const Results& results, FigureList& figures, double flow_bar, double stress_bar) {
    const std::vector<std::string> runs = {"alpha2_8", "alpha5"};
    const auto off = [&](const std::string& run, const std::string& name) {
        return complex_of(results[run], name) / complex_of(results[run], "exact_" + name);
    };
    const auto amplitude_error = [&](const std::string& name) {
        return [&, name] {
            return worst_of(runs, [&](const std::string& run) { return 100 * std::abs(std::abs(off(run, name)) - 1); });
        };
    };
    figures.add({"flow_amplitude_error_percent", "percent", Bar{flow_bar}}, runs, amplitude_error("flow"));
    figures.add({"flow_phase_error_deg", "deg", Bar{3.0}}, runs, [&] {
        return worst_of(runs, [&](const std::string& run) {
            return std::abs(std::arg(off(run, "flow"))) * 180 / std::numbers::pi;
        });
    });
    figures.add({"wss_amplitude_error_percent", "percent", Bar{stress_bar}}, runs, amplitude_error("stress"));
}

void womersley_figures(const Results& results, FigureList& figures) { add_womersley_figures(results, figures, 2, 4); }
void cells_womersley_figures(const Results& results, FigureList& figures) {
    add_womersley_figures(results, figures, 1, 2);
}

std::vector<Picture> womersley_pictures(const Results& results) {
    std::vector<Picture> pictures;
    for (const std::string run : {"alpha2_8", "alpha5"}) {
        if (!results.has(run)) continue;
        const RunData& r = results[run];
        const std::complex<double> exact = complex_of(r, "exact_flow");
        const double omega = r.number("angular_frequency");
        Curve computed{"computed", r.list("times"), r.list("flows"), true},
            closed{"closed form", r.list("times"), {}, false};
        for (double& q : computed.y) q *= 6e7;
        for (const double t : r.list("times")) closed.y.push_back(6e7 * (exact * std::polar(1.0, omega * t)).real());
        pictures.push_back({"womersley_" + run, "Flow over the last period, " + run,
                            format_plot({"t [s]", "Q [mL/min]", {closed, computed}})});
    }
    return pictures;
}

}   // namespace

std::vector<VerifyCase> pipe_cases() {
    return {
        {.name = "pipe",
         .title = "Steady flow in a body-fitted pipe, straight and tilted",
         .is_full = [](const std::string& run) { return run.ends_with("_d20"); },
         .measure = measure_pipe,
         .figures = pipe_figures,
         .pictures = pipe_pictures},
        {.name = "womersley",
         .title = "Oscillating flow in a pipe between two pressures",
         .is_full = {},
         .measure = measure_womersley,
         .figures = womersley_figures,
         .pictures = womersley_pictures},
        {.name = "cells_womersley",
         .title = "Oscillating flow in a pipe between two pressures, on cells",
         .is_full = {},
         .measure = measure_womersley,
         .figures = cells_womersley_figures,
         .pictures = {}},
    };
}

}   // namespace patency
