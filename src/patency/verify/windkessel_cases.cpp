// SPDX-License-Identifier: Apache-2.0
// Outlets with 0-D models behind them: a pipe with an RCR against another program's result, and a Y of pipes with two
// different RCRs against the network of tubes and models.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "patency/verify/closed_forms.h"
#include "patency/verify/measures.h"
#include "patency/verify/sampling_of_scene.h"

namespace patency {

namespace {

Rcr rcr_of(const deck::Opening& o) {
    return {o.proximal_resistance, o.compliance, o.distal_resistance, o.distal_pressure};
}

FourierSeries inflow_of(const deck::Case& c) {
    const deck::Fourier& f = *c.openings.at("inlet").waveform->fourier;
    return {f.mean, f.cosines, f.sines, f.period};
}

/// Times, flows and pressures at every opening, after every step. The pressure of an outlet is what its model says; at
/// the inlet it is the mean over the section.
void record_openings(const Scene& scene, RunData& data) {
    data.lists["times"].push_back(scene.time);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        data.lists["flow_" + scene.ends[k].name].push_back(scene.ends[k].flow);
        data.lists["pressure_" + scene.ends[k].name].push_back(scene.ends[k].mean_pressure + scene.level());
    }
}

// The pipe of svFSI-Tests 04-fluid/01-pipe3D_RCR: pressures of every 5 ms, in dyn/cm^2, inlet and outlet, three lines of
// heading (pressure_average: SimVascular/svFSI-Tests at c38514ff).
constexpr double svfsi_dt = 0.005;
struct Reference {
    std::vector<double> times, inlet, outlet;
};

Reference read_svfsi(const std::filesystem::path& folder) {
    Reference reference;
    std::ifstream file(folder / "svFSI_pipe_RCR" / "B_NS_Pressure_average.txt");
    std::string line;
    for (int i = 0; i < 3; ++i) std::getline(file, line);
    for (double inlet, outlet, wall; file >> inlet >> outlet >> wall;) {
        reference.times.push_back(svfsi_dt * double(reference.times.size() + 1));
        reference.inlet.push_back(0.1 * inlet);
        reference.outlet.push_back(0.1 * outlet);
    }
    return reference;
}

double interpolated(const std::vector<double>& times, const std::vector<double>& values, double t) {
    const auto k = std::size_t(std::clamp<std::ptrdiff_t>(
        std::lower_bound(times.begin(), times.end(), t) - times.begin(), 1, std::ptrdiff_t(times.size()) - 1));
    const double f = (t - times[k - 1]) / (times[k] - times[k - 1]);
    return values[k - 1] + f * (values[k] - values[k - 1]);
}

/// The same flow through the model alone: what a rigid pipe of an incompressible liquid hands on.
Reference solve_rcr(const deck::Case& c, double until) {
    const OutletModel model = rcr_of(c.openings.at("outlet"));
    const FourierSeries inflow = inflow_of(c);
    OutletState state = {c.openings.at("outlet").initial_pressure.value_or(0), 0};
    Reference reference;
    constexpr double dt = 1e-3;   // the step is of second order: (w dt)^2 / 12 = 3e-6 of the amplitude
    for (int k = 0; k * dt < until; ++k) {
        state = advanced(model, state, {k * dt, dt}, inflow(k * dt), inflow((k + 1) * dt));
        reference.times.push_back((k + 1) * dt);
        reference.outlet.push_back(outlet_pressure(model, state, inflow((k + 1) * dt)));
    }
    return reference;
}

void measure_windkessel(Scene& scene, const RunContext& context, RunData& data) {
    const double until = scene.config.numerics.duration;
    if (context.name == "y") {
        const double period = inflow_of(scene.config).period;
        run_until(scene, context, until - period);
        record_openings(scene, data);
        run_until(scene, context, until, [&](const Scene& now, double) { record_openings(now, data); });
        // The network of tubes and models that it stands for.
        const deck::Case& c = scene.config;
        const auto& branches = c.geometry.shape->branches;
        const auto tube = [](const deck::Branch& b) {
            return YNetwork::Tube{0.5 * b.diameters[0], norm(b.to - b.from)};
        };
        YNetwork network{
            .density = c.blood.density, .viscosity = c.blood.viscosity, .inlet = tube(branches.at(0)), .branches = {}};
        for (std::size_t k : {1, 2})
            network.branches.push_back({tube(branches.at(k)), rcr_of(c.openings.at("outlet_" + branches[k].name))});
        const YNetworkFlow exact = solve_y_network(network, inflow_of(c));
        for (std::size_t k = 0; k < 2; ++k)
            for (const double t : data.list("times")) {
                data.lists["exact_flow_outlet_" + branches[k + 1].name].push_back(exact.flows[k](t));
                data.lists["exact_pressure_outlet_" + branches[k + 1].name].push_back(exact.outlet_pressures[k](t));
            }
        return;
    }
    run_until(scene, context, until, [&](const Scene& now, double) { record_openings(now, data); });
    const Reference alone = solve_rcr(scene.config, until + 0.01);
    for (const double t : data.list("times"))
        data.lists["model_outlet"].push_back(interpolated(alone.times, alone.outlet, t));
    const Reference other = read_svfsi(context.reference);
    if (other.times.empty() || other.times.back() < until - 1e-9) return;
    for (const double t : data.list("times")) {
        data.lists["other_outlet"].push_back(interpolated(other.times, other.outlet, t));
        data.lists["other_inlet"].push_back(interpolated(other.times, other.inlet, t));
    }
}

/// Largest difference from `from` [s] on, over the largest reference there.
double largest_error_percent(const RunData& run, const std::string& computed, const std::string& exact, double from) {
    double error = 0, peak = 0;
    const auto &t = run.list("times"), &a = run.list(computed), &b = run.list(exact);
    for (std::size_t k = 0; k < t.size(); ++k) {
        if (t[k] < from) continue;
        error = std::max(error, std::abs(a[k] - b[k]));
        peak = std::max(peak, std::abs(b[k]));
    }
    return 100 * error / peak;
}

double mean_in_time(const std::vector<double>& times, const std::vector<double>& values) {
    double sum = 0;
    for (std::size_t k = 1; k < times.size(); ++k) sum += 0.5 * (values[k] + values[k - 1]) * (times[k] - times[k - 1]);
    return sum / (times.back() - times.front());
}

constexpr double settled = 2;   // s: the start is left out

void windkessel_figures(const Results& results, FigureList& figures) {
    for (const std::string run : {"pipe", "pipe_short"}) {
        if (run == "pipe_short" && results.was_tried("pipe")) continue;   // the quick run is the start of the long one
        const auto r = [&]() -> const RunData& { return results[run]; };
        const double from = run == "pipe" ? settled : 0.1;
        figures.add({"pressure_error_percent", "percent", Bar{1.0}}, {run}, [&] {
            return largest_error_percent(r(), "pressure_outlet",
                                         r().lists.contains("other_outlet") ? "other_outlet" : "model_outlet", from);
        });
        figures.add({"pressure_error_to_model_percent", "percent", {}}, {run},
                    [&] { return largest_error_percent(r(), "pressure_outlet", "model_outlet", from); });
        if (results.has(run) && r().lists.contains("other_inlet"))
            figures.add({"inlet_pressure_difference_percent", "percent", {}}, {run},
                        [&] { return largest_error_percent(r(), "pressure_inlet", "other_inlet", from); });
    }
    const std::vector<std::string> sides = {"outlet_left", "outlet_right"};
    figures.add({"y_flow_error_percent", "percent", Bar{1.0}}, {"y"}, [&] {   // of the mean flows
        const RunData& r = results["y"];
        double worst = 0;
        for (const std::string& side : sides) {
            const double exact = mean_in_time(r.list("times"), r.list("exact_flow_" + side));
            worst = std::max(worst, 100 * std::abs(mean_in_time(r.list("times"), r.list("flow_" + side)) / exact - 1));
        }
        return worst;
    });
    figures.add({"y_wave_error_percent", "percent", Bar{2.0}}, {"y"}, [&] {   // of the pressures over time
        const RunData& r = results["y"];
        double worst = 0;
        for (const std::string& side : sides)
            worst = std::max(worst, largest_error_percent(r, "pressure_" + side, "exact_pressure_" + side, 0));
        return worst;
    });
    figures.add({"y_flow_wave_error_percent", "percent", {}}, {"y"}, [&] {
        const RunData& r = results["y"];
        double worst = 0;
        for (const std::string& side : sides)
            worst = std::max(worst, largest_error_percent(r, "flow_" + side, "exact_flow_" + side, 0));
        return worst;
    });
}

std::vector<Picture> windkessel_pictures(const Results& results) {
    std::vector<Picture> pictures;
    const auto scaled = [](std::vector<double> values, double factor) {
        for (double& v : values) v *= factor;
        return values;
    };
    for (const std::string run : {"pipe", "pipe_short"}) {
        if (!results.has(run)) continue;
        const RunData& r = results[run];
        Plot plot{"t [s]",
                  "outlet pressure [mmHg]",
                  {{"model alone", r.list("times"), scaled(r.list("model_outlet"), 1 / 133.322), false}}};
        if (r.lists.contains("other_outlet"))
            plot.curves.push_back({"svFSI", r.list("times"), scaled(r.list("other_outlet"), 1 / 133.322), false});
        plot.curves.push_back({"patency", r.list("times"), scaled(r.list("pressure_outlet"), 1 / 133.322), false});
        pictures.push_back({"windkessel_pipe", "Pipe with an RCR", format_plot(plot)});
        break;
    }
    if (results.has("y")) {
        const RunData& r = results["y"];
        Plot plot{"t [s]", "flow [mL/min]", {}};
        for (const std::string side : {"left", "right"}) {
            plot.curves.push_back(
                {"network, " + side, r.list("times"), scaled(r.list("exact_flow_outlet_" + side), 6e7), false});
            plot.curves.push_back(
                {"patency, " + side, r.list("times"), scaled(r.list("flow_outlet_" + side), 6e7), false});
        }
        pictures.push_back({"windkessel_y", "A Y with two different RCRs", format_plot(plot)});
    }
    return pictures;
}

}   // namespace

std::vector<VerifyCase> windkessel_cases() {
    return {{.name = "windkessel",
             .title = "A pipe and a Y of pipes with RCR outlets",
             .is_full = [](const std::string& run) { return run == "pipe"; },
             .measure = measure_windkessel,
             .figures = windkessel_figures,
             .pictures = windkessel_pictures},
            {.name = "cells_windkessel",
             .title = "A pipe and a Y of pipes with RCR outlets, on cells",
             .is_full = [](const std::string& run) { return run == "pipe"; },
             .measure = measure_windkessel,
             .figures = windkessel_figures,
             .pictures = {}}};
}

}   // namespace patency
