// SPDX-License-Identifier: Apache-2.0
// Flow between plates against its closed forms: start-up and steady state behind a velocity inlet, between pressures,
// started as a plug; and decaying vortices.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "patency/stages/material.h"
#include "patency/verify/closed_forms.h"
#include "patency/verify/measures.h"
#include "patency/verify/sampling_of_scene.h"

namespace patency {

namespace {

constexpr std::array startup_times = {0.02, 0.05, 0.1, 0.2, 0.5};      // nu t / d^2
constexpr std::array channel_peaks = {1.1, 1.2, 1.3, 1.4, 1.4999};     // u_max / U at t1 .. t5
constexpr std::array paper_steady = {6.31, 3.87, 3.40};                // RMSEP [%] at d/12, d/25, d/50
constexpr std::array paper_channel = {2.83, 1.65, 4.60, 4.06, 2.03};   // RMSEP [%] at t1 .. t5
const std::array spacings = {std::string("d12"), std::string("d25"), std::string("d50")};

std::string at(double time) { return fmt::format("{:g}", time); }
bool is_paper(const std::string& run) { return run.starts_with("paper_"); }

/// The flow that a deck describes: between two pressures, or behind a parabola of a given peak.
PlaneFlow plane_flow_of(const Scene& scene) {
    const deck::Case& c = scene.config;
    const double gap = c.geometry.shape->gap, mu = c.blood.viscosity;
    const deck::Opening &inlet = c.openings.at("inlet"), &outlet = c.openings.at("outlet");
    const double gradient = inlet.pressure ? (*inlet.pressure - outlet.pressure.value_or(0)) / c.geometry.shape->length
                                           : 8 * mu * inlet.peak_velocity.value() / (gap * gap);
    return {gap, gradient, c.blood.density, mu};
}

template <class Exact>
void put_profile(RunData& data, const std::string& name, const ProfileFit& fit, Exact exact) {
    data.lists["velocity_" + name] = fit.values();
    data.lists["stations"] = fit.stations();
    std::vector<double>& values = data.lists["exact_" + name];
    values.clear();
    for (const double y : fit.stations()) values.push_back(exact(y));
}

Curve curve_of(const RunData& run, const std::string& list, const std::string& label, double length, double speed,
               bool is_dotted) {
    Curve curve{label, {}, {}, is_dotted};
    for (std::size_t k = 0; k < run.list("stations").size(); ++k) {
        curve.x.push_back(run.list("stations")[k] / length);
        curve.y.push_back(run.list(list)[k] / speed);
    }
    return curve;
}

// Poiseuille

void measure_poiseuille(Scene& scene, const RunContext& context, RunData& data) {
    const PlaneFlow flow = plane_flow_of(scene);
    const double unit = flow.gap * flow.gap * flow.density / flow.viscosity;   // d^2 / nu [s]
    put_number(data, "peak", plane_poiseuille_peak(flow));
    put_number(data, "gap", flow.gap);
    if (scene.config.initial_velocity() == deck::InitialVelocity::rest) {
        for (const double time : startup_times) {
            run_until(scene, context, time * unit);
            ProfileFit fit = make_plane_fit(scene);
            add_plane_profile(scene, 4, 1, fit);
            put_profile(data, at(time), fit, [&](double y) { return plane_startup_velocity(flow, y, scene.time); });
        }
        return;
    }
    const double until = scene.config.numerics.duration;
    run_until(scene, context, 0.7 * until);
    ProfileFit fit = make_plane_fit(scene);
    run_until(scene, context, until, [&](const Scene& now, double dt) { add_plane_profile(now, 4, dt, fit); });
    put_profile(data, "steady", fit, [&](double y) { return plane_poiseuille_velocity(flow, y); });
}

double steady_rmsep(const RunData& run) { return rmsep_percent(run.list("velocity_steady"), run.list("exact_steady")); }
double steady_l2(const RunData& run) {
    return l2_percent(run.list("velocity_steady"), run.list("exact_steady"), run.number("peak"));
}
double startup_l2(const RunData& run, double time) {
    return l2_percent(run.list("velocity_" + at(time)), run.list("exact_" + at(time)), run.number("peak"));
}
double worst_startup_l2(const RunData& run) {
    double worst = 0;
    for (const double time : startup_times) worst = std::max(worst, startup_l2(run, time));
    return worst;
}

void poiseuille_figures(const Results& results, FigureList& figures) {
    const std::array bars = {2.5, 1.0, 0.5};
    for (const std::string prefix : {"", "paper_"}) {
        const bool ours = prefix.empty();
        for (std::size_t k = 0; k < spacings.size(); ++k) {
            const std::string run = prefix + spacings[k];
            figures.add(
                {prefix + "rmsep_percent_" + spacings[k], "percent", ours ? std::optional(Bar{bars[k]}) : std::nullopt},
                {run}, [&] { return steady_rmsep(results[run]); });
            figures.add({prefix + "l2_percent_" + spacings[k], "percent", {}}, {run},
                        [&] { return steady_l2(results[run]); });
        }
        const std::string coarse = prefix + "d12", fine = prefix + "d50", startup = prefix + "startup_d25";
        figures.add(
            {prefix + "order", "1", ours ? std::optional(Bar{1.5, Sense::at_least}) : std::nullopt}, {coarse, fine},
            [&] { return observed_order(steady_l2(results[coarse]), 1.0 / 12, steady_l2(results[fine]), 1.0 / 50); });
        figures.add({prefix + "l2_startup_percent_d25", "percent", ours ? std::optional(Bar{1.5}) : std::nullopt},
                    {startup}, [&] { return worst_startup_l2(results[startup]); });
        for (const double time : startup_times)
            figures.add({fmt::format("{}l2_startup_percent_d25_at_{:g}", prefix, time), "percent", {}}, {startup},
                        [&] { return startup_l2(results[startup], time); });
    }
    for (std::size_t k = 0; k < spacings.size(); ++k)
        figures.add({"paper_printed_rmsep_percent_" + spacings[k], "percent", {}}, {}, [&] { return paper_steady[k]; });
}

std::vector<Picture> poiseuille_pictures(const Results& results) {
    std::vector<Picture> pictures;
    Plot steady{"y / d", "u / u_max", {}};
    for (const std::string& run : {spacings[2], spacings[1], spacings[0]}) {
        if (!results.has(run)) continue;
        const RunData& r = results[run];
        if (steady.curves.empty())
            steady.curves.push_back(
                curve_of(r, "exact_steady", "closed form", r.number("gap"), r.number("peak"), false));
        steady.curves.push_back(
            curve_of(r, "velocity_steady", "dp = d/" + run.substr(1), r.number("gap"), r.number("peak"), true));
    }
    if (!steady.curves.empty())
        pictures.push_back(
            {"poiseuille_steady", "Steady profile at three spacings (the paper's figure 5)", format_plot(steady)});
    Plot startup{"y / d", "u / u_max", {}};
    if (results.has("startup_d25")) {
        const RunData& r = results["startup_d25"];
        for (const double time : startup_times) {
            Curve exact = curve_of(r, "exact_" + at(time), "", r.number("gap"), r.number("peak"), false);
            exact.label = time == startup_times[0] ? "closed form" : "";
            startup.curves.push_back(std::move(exact));
        }
        for (const double time : startup_times)
            startup.curves.push_back(
                curve_of(r, "velocity_" + at(time), "nu t/d^2 = " + at(time), r.number("gap"), r.number("peak"), true));
        pictures.push_back(
            {"poiseuille_startup", "Start-up from rest at d/25 (the paper's figure 4)", format_plot(startup)});
    }
    return pictures;
}

// Poiseuille between two pressures

void measure_pressure_driven(Scene& scene, const RunContext& context, RunData& data) {
    const PlaneFlow flow = plane_flow_of(scene);
    const double until = scene.config.numerics.duration, gap = flow.gap;
    TimeMean mean;
    run_until(scene, context, 0.7 * until);
    const StraightAxis axis = axis_of(scene);
    run_until(scene, context, until,
              [&](const Scene& now, double dt) { mean.add(mean_velocity_in_middle(now, axis) * gap, dt); });
    put_number(data, "flow", mean.value());
    put_number(data, "exact_flow", plane_poiseuille_peak(flow) * 2 / 3 * gap);
}

void pressure_driven_figures(const Results& results, FigureList& figures) {
    const auto relative_flow = [&](const std::string& run) {
        return results[run].number("flow") / results[run].number("exact_flow");
    };
    figures.add({"flow_error_percent_d25", "percent", Bar{1.0}}, {"d25"},
                [&] { return 100 * std::abs(relative_flow("d25") - 1); });
    figures.add({"offset_change_percent", "percent", Bar{0.1}}, {"d25", "offset"},
                [&] { return 100 * std::abs(relative_flow("offset") - relative_flow("d25")); });
    figures.add({"offset_change_frozen_percent", "percent", Bar{1.0}}, {"d25", "offset_frozen"},
                [&] { return 100 * std::abs(relative_flow("offset_frozen") - relative_flow("d25")); });
    figures.add({"paper_flow_error_percent_d25", "percent", {}}, {"paper_d25"},
                [&] { return 100 * std::abs(relative_flow("paper_d25") - 1); });
}

// Blood that thins, between two pressures

void measure_thinning(Scene& scene, const RunContext& context, RunData& data) {
    const PlaneFlow flow = plane_flow_of(scene);
    const Rheology law = make_rheology(scene.config.blood);
    const double until = scene.config.numerics.duration;
    TimeMean mean;
    run_until(scene, context, 0.7 * until);
    const StraightAxis axis = axis_of(scene);
    ProfileFit fit = make_plane_fit(scene);
    run_until(scene, context, until, [&](const Scene& now, double dt) {
        mean.add(mean_velocity_in_middle(now, axis) * flow.gap, dt);
        add_plane_profile(now, 2, dt, fit);
    });
    put_profile(data, "steady", fit, [&](double y) { return thinning_plane_velocity(flow, law, y); });
    put_number(data, "peak", thinning_plane_velocity(flow, law, flow.gap / 2));
    put_number(data, "gap", flow.gap);
    put_number(data, "flow", mean.value());
    put_number(data, "exact_flow", thinning_plane_flow(flow, law));
}

void thinning_figures(const Results& results, FigureList& figures) {
    const auto flow_error = [&](const std::string& run) {
        return 100 * std::abs(results[run].number("flow") / results[run].number("exact_flow") - 1);
    };
    const std::array d25 = {std::string("carreau_yasuda"), std::string("casson"), std::string("power_law")};
    for (const std::string& law : d25) {
        figures.add({"flow_error_percent_" + law, "percent", Bar{1.0}}, {law}, [&] { return flow_error(law); });
        figures.add({"rmsep_percent_" + law, "percent", Bar{1.0}}, {law}, [&] { return steady_rmsep(results[law]); });
    }
    figures.add({"rmsep_percent_d12", "percent", Bar{2.5}}, {"d12"}, [&] { return steady_rmsep(results["d12"]); });
    figures.add({"rmsep_percent_d50", "percent", Bar{0.5}}, {"d50"}, [&] { return steady_rmsep(results["d50"]); });
    figures.add({"order", "1", Bar{1.5, Sense::at_least}}, {"d12", "d50"}, [&] {
        return observed_order(steady_l2(results["d12"]), 1.0 / 12, steady_l2(results["d50"]), 1.0 / 50);
    });
    figures.add({"paper_flow_error_percent", "percent", {}}, {"paper_d25"}, [&] { return flow_error("paper_d25"); });
    figures.add({"paper_rmsep_percent", "percent", {}}, {"paper_d25"},
                [&] { return steady_rmsep(results["paper_d25"]); });
}

std::vector<Picture> thinning_pictures(const Results& results) {
    Plot plot{"y / d", "u / u_max", {}};
    for (const bool is_exact : {true, false})
        for (const std::string run : {"carreau_yasuda", "casson", "power_law"}) {
            if (!results.has(run)) continue;
            const RunData& r = results[run];
            const std::string label = !is_exact ? run : plot.curves.empty() ? "closed forms" : "";
            plot.curves.push_back(curve_of(r, is_exact ? "exact_steady" : "velocity_steady", label, r.number("gap"),
                                           r.number("peak"), !is_exact));
        }
    if (plot.curves.empty()) return {};
    return {{"thinning_profiles", "Profiles of three laws at d/25", format_plot(plot)}};
}

// Channel started as a plug

void measure_channel(Scene& scene, const RunContext& context, RunData& data) {
    const deck::Case& c = scene.config;
    const double half = 0.5 * c.geometry.shape->gap, speed = *c.initial.speed;
    const double unit = half * half * c.blood.density / c.blood.viscosity;   // h^2 / nu [s]
    put_number(data, "speed", speed);
    put_number(data, "half_gap", half);
    for (std::size_t k = 0; k < channel_peaks.size(); ++k) {
        const double time = plug_start_time(channel_peaks[k]);
        run_until(scene, context, time * unit);
        ProfileFit fit = make_plane_fit(scene);
        add_plane_profile(scene, 4, 1, fit);
        put_profile(data, fmt::format("t{}", k + 1), fit,
                    [&](double y) { return speed * plug_start_velocity(y / half - 1, time); });
        if (k != 0 && k + 1 != channel_peaks.size()) continue;
        for (const char* name : {"x", "y", "u"}) data.lists[fmt::format("field_t{}_{}", k + 1, name)].clear();
        for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
            if (scene.fluid.opening[i] != 0) continue;
            data.lists[fmt::format("field_t{}_x", k + 1)].push_back(scene.fluid.position[i].x);
            data.lists[fmt::format("field_t{}_y", k + 1)].push_back(scene.fluid.position[i].y);
            data.lists[fmt::format("field_t{}_u", k + 1)].push_back(norm(scene.fluid.velocity[i]));
        }
    }
    put_number(data, "spacing", scene.numerics.spacing);
}

void channel_figures(const Results& results, FigureList& figures) {
    for (const std::string prefix : {"", "paper_"})
        for (std::size_t k = 1; k <= channel_peaks.size(); ++k)
            figures.add({fmt::format("{}rmsep_percent_t{}", prefix, k), "percent",
                         prefix.empty() ? std::optional(Bar{1.0}) : std::nullopt},
                        {prefix + "h25"}, [&] {
                            const RunData& r = results[prefix + "h25"];
                            return rmsep_percent(r.list(fmt::format("velocity_t{}", k)),
                                                 r.list(fmt::format("exact_t{}", k)));
                        });
    for (std::size_t k = 0; k < paper_channel.size(); ++k)
        figures.add({fmt::format("paper_printed_rmsep_percent_t{}", k + 1), "percent", {}}, {},
                    [&] { return paper_channel[k]; });
}

std::vector<Picture> channel_pictures(const Results& results) {
    std::vector<Picture> pictures;
    if (!results.has("h25")) return pictures;
    const RunData& r = results["h25"];
    const double speed = r.number("speed"), half = r.number("half_gap");
    Plot plot{"y / h", "u / U", {}};
    for (int k = 1; k <= 5; ++k)
        plot.curves.push_back(
            curve_of(r, fmt::format("exact_t{}", k), k == 1 ? "closed form" : "", half, speed, false));
    for (int k = 1; k <= 5; ++k)
        plot.curves.push_back(curve_of(r, fmt::format("velocity_t{}", k), fmt::format("t{}", k), half, speed, true));
    pictures.push_back({"channel_profiles", "Profiles at t1 to t5, started as a plug", format_plot(plot)});
    for (const int k : {1, 5})
        pictures.push_back({fmt::format("channel_field_t{}", k),
                            fmt::format("Speed of the particles at t{} (the paper's figure {})", k, k == 1 ? 6 : 7),
                            format_field({r.list(fmt::format("field_t{}_x", k)), r.list(fmt::format("field_t{}_y", k)),
                                          r.list(fmt::format("field_t{}_u", k)), r.number("spacing"), 0, 1.5 * speed,
                                          "speed [m/s]"})});
    return pictures;
}

// Taylor-Green

void measure_taylor_green(Scene& scene, const RunContext& context, RunData& data) {
    const deck::Case& c = scene.config;
    const TaylorGreen exact{c.geometry.shape->size.x, *c.initial.speed, c.blood.density, c.blood.viscosity};
    double drift = 0;
    auto &times = data.lists["times"], &energies = data.lists["energies"];
    const auto record = [&](const Scene& now, double) {
        double energy = 0, pressure = 0;
        for (std::size_t i = 0; i < now.fluid.size(); ++i) {
            energy += dot(now.fluid.velocity[i], now.fluid.velocity[i]);
            pressure += now.fluid.pressure[i];
        }
        times.push_back(now.time);
        energies.push_back(0.5 * energy / double(now.fluid.size()));
        drift = std::max(drift,
                         std::abs(pressure / double(now.fluid.size())) / (exact.density * exact.speed * exact.speed));
    };
    record(scene, 0);
    run_until(scene, context, 2 * exact.length / exact.speed, record);
    put_number(data, "exact_rate", exact.energy_decay_rate());
    put_number(data, "pressure_drift", drift);
}

void taylor_green_figures(const Results& results, FigureList& figures) {
    figures.add({"decay_rate_error_percent", "percent", Bar{2.0}}, {"l50"}, [&] {
        const RunData& r = results["l50"];
        return 100 * std::abs(decay_rate(r.list("times"), r.list("energies")) / r.number("exact_rate") - 1);
    });
    figures.add({"pressure_drift_percent", "percent", Bar{1.0}}, {"l50"},
                [&] { return 100 * results["l50"].number("pressure_drift"); });
}

}   // namespace

std::vector<VerifyCase> plane_cases() {
    return {
        {.name = "poiseuille",
         .title = "Flow between plates behind a velocity inlet, from rest and steady, at three spacings",
         .is_full = [](const std::string& run) { return is_paper(run) || run == "d50"; },
         .measure = measure_poiseuille,
         .figures = poiseuille_figures,
         .pictures = poiseuille_pictures},
        {.name = "poiseuille_pressure",
         .title = "The same between two pressures, and with a level of 10 kPa on both",
         .is_full = is_paper,
         .measure = measure_pressure_driven,
         .figures = pressure_driven_figures,
         .pictures = {}},
        {.name = "thinning",
         .title = "Shear-thinning blood between two pressures: three laws, and Carreau-Yasuda's at three spacings",
         .is_full = [](const std::string& run) { return run != "d12"; },
         .measure = measure_thinning,
         .figures = thinning_figures,
         .pictures = thinning_pictures},
        {.name = "channel",
         .title = "Channel started as a plug, driven by pressure, at the series' instants",
         .is_full = is_paper,
         .measure = measure_channel,
         .figures = channel_figures,
         .pictures = channel_pictures},
        {.name = "taylor_green",
         .title = "Decaying vortices in a periodic square",
         .is_full = {},
         .measure = measure_taylor_green,
         .figures = taylor_green_figures,
         .pictures = {}},
    };
}

}   // namespace patency
