// SPDX-License-Identifier: Apache-2.0
// The reference paper's bifurcation against finite volumes: flows, section pressures, peaks, wall shear stress.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/stages/flow.h"
#include "patency/stages/flow_window.h"
#include "patency/verify/measures.h"
#include "patency/verify/sampling_of_scene.h"
#include "patency/verify/vessel_sections.h"

namespace patency {

namespace {

constexpr double mm = 1e-3;
constexpr int instants = 5;       // of the last window
constexpr double least_wss = 1;   // Pa: below, the absolute error counts

/// None where the file is not there: then no run was measured either.
std::vector<VesselSection> known_sections(const Results& results) {
    for (const char* run : {"d20", "d30", "d40"})
        if (results.has(run)) return read_bifurcation_sections(results.reference());
    return {};
}

void measure_bifurcation(Scene& scene, const RunContext& context, RunData& data) {
    SectionsMeasure sections(scene, read_bifurcation_sections(context.reference));
    FlowWindow window(scene);
    FlowRun run{.until = scene.config.numerics.duration, .exact_times = window.exact_times()};
    run.observe = [&](const Scene& now, const FlowStep&) {
        if (context.watch) context.watch(now);
        window.observe(now);
        if (!window.begin()) return;
        const double begin = window.begin()->time, share = (now.time - begin) / (window.end() - begin);
        if (double(sections.count()) < std::floor(share * instants + 1e-9)) sections.sample(now);
    };
    run.interrupted = [&] { return scene.time >= window.end(); };
    advance(scene, run);

    sections.write(data);
    const FlowMark to = mark_flow(scene);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        const OpeningMean mean = mean_between(*window.begin(), to, k, scene.ends[k].area);
        put_number(data, "flow_" + scene.ends[k].name, mean.flow);
        put_number(data, "pressure_" + scene.ends[k].name, mean.pressure);
        put_number(data, "velocity_" + scene.ends[k].name, mean.velocity);
    }
    put_number(data, "imbalance", mass_imbalance_percent(*window.begin(), to));
    put_number(data, "acoustic_steps", double(scene.acoustic_steps));
    put_number(data, "settled", window.is_settled());
    put_number(data, "time", scene.time);
}

double number(const RunData& data, const std::string& name) { return data.list(name).at(0); }

/// The section of a branch nearest to an arc of the network.
std::size_t section_at(const std::vector<VesselSection>& sections, const std::string& branch, double arc) {
    std::size_t found = sections.size();
    for (std::size_t k = 0; k < sections.size(); ++k)
        if (sections[k].branch == branch &&
            (found == sections.size() || std::abs(sections[k].arc - arc) < std::abs(sections[found].arc - arc)))
            found = k;
    return found;
}

struct OutletReference {
    const char *name, *key;
    double flow;             // finite volumes [m^3/s]
    double paper_velocity;   // printed in the paper's table VI [m/s]
};
constexpr OutletReference outlets[] = {{"outlet_large", "large", 3.03084489e-6, 0.325},
                                       {"outlet_medium", "medium", 5.63052032e-7, 0.066},
                                       {"outlet_small", "small", 3.66060709e-7, 0.069}};
constexpr double inflow = 3.95995756e-6, inlet_pressure = 176.49;   // finite volumes [m^3/s], [Pa]
constexpr double proximal_arc = 13.989 * mm, throat_arc = 24 * mm, distal_arc = 33.998 * mm;
const std::string stenosed = "anterior_descending";

/// Root mean square over flows and section pressures, relative to the inlet's.
double combined_error(const RunData& data, const std::vector<VesselSection>& sections) {
    double squares = 0, count = 0;
    for (std::size_t k = 0; k < sections.size(); ++k) {
        const double e = (data.list("pressure")[k] - sections[k].pressure) / inlet_pressure;
        squares += e * e, count += 1;
    }
    for (const OutletReference& o : outlets) {
        const double e = (number(data, std::string("flow_") + o.name) - o.flow) / inflow;
        squares += e * e, count += 1;
    }
    return 100 * std::sqrt(squares / count);
}

void bifurcation_figures(const Results& results, FigureList& figures) {
    const auto sections = known_sections(results);
    const auto at = [&](double arc) { return section_at(sections, stenosed, arc); };
    const auto drop = [&](const RunData& data) {
        return data.list("pressure")[at(proximal_arc)] - data.list("pressure")[at(distal_arc)];
    };
    for (const auto& [run, suffix, judged] :
         {std::tuple{"d20", "", true}, {"d30", "_d30", false}, {"d40", "_d40", false}}) {
        const auto bar = [&, judged = judged](double value) {
            return judged ? std::optional(Bar{value}) : std::nullopt;
        };
        const auto add = [&, run = run, suffix = suffix](const std::string& key, const std::string& unit,
                                                         std::optional<Bar> limit,
                                                         const std::function<double(const RunData&)>& value) {
            figures.add({key + suffix, unit, limit}, {run}, [&, value] { return value(results[run]); });
        };
        for (const OutletReference& o : outlets) {
            const std::string name = std::string("flow_") + o.name;
            add(fmt::format("flow_error_percent_{}", o.key), "percent", bar(5),
                [=](const RunData& d) { return 100 * std::abs(number(d, name) / o.flow - 1); });
            add(fmt::format("flow_error_of_inlet_percent_{}", o.key), "percent", bar(1),
                [=](const RunData& d) { return 100 * std::abs(number(d, name) - o.flow) / inflow; });
        }
        add("section_pressure_error_percent", "percent", bar(4), [&](const RunData& d) {
            double worst = 0;
            for (std::size_t k = 0; k < sections.size(); ++k)
                worst = std::max(worst, 100 * std::abs(d.list("pressure")[k] - sections[k].pressure) / inlet_pressure);
            return worst;
        });
        add("drop_error_percent", "percent", bar(5), [&](const RunData& d) {
            const double exact = sections[at(proximal_arc)].pressure - sections[at(distal_arc)].pressure;
            return 100 * std::abs(drop(d) / exact - 1);
        });
        add("throat_peak_error_percent", "percent", bar(5), [&](const RunData& d) {
            return 100 * std::abs(d.list("peak")[at(throat_arc)] / sections[at(throat_arc)].peak - 1);
        });
        add("gauge_pressure_ratio_error", "1", bar(0.02), [&](const RunData& d) {
            return std::abs(d.list("pressure")[at(distal_arc)] / d.list("pressure")[at(proximal_arc)] - 0.4559);
        });
        add("mass_imbalance_percent", "percent", bar(0.2), [](const RunData& d) { return number(d, "imbalance"); });
        add("wss_error_percent", "percent", bar(8), [&](const RunData& d) {
            double worst = 0;
            for (std::size_t k = 0; k < sections.size(); ++k)
                if (sections[k].wss >= least_wss)
                    worst = std::max(worst, 100 * std::abs(d.list("wss")[k] / sections[k].wss - 1));
            return worst;
        });
        add("wss_error_pa", "Pa", bar(0.15), [&](const RunData& d) {
            double worst = 0;
            for (std::size_t k = 0; k < sections.size(); ++k)
                if (sections[k].wss < least_wss) worst = std::max(worst, std::abs(d.list("wss")[k] - sections[k].wss));
            return worst;
        });
        add("combined_error_percent", "percent", std::nullopt,
            [&](const RunData& d) { return combined_error(d, sections); });
    }
    // Falling errors: the worst ratio of one spacing's to the next coarser one's.
    figures.add({"combined_error_growth", "1", Bar{1.0}}, {"d20", "d30", "d40"}, [&] {
        const double a = combined_error(results["d40"], sections), b = combined_error(results["d30"], sections),
                     c = combined_error(results["d20"], sections);
        return std::max(b / a, c / b);
    });
    const auto study = [&results](const auto& value) {
        return SpacingStudy{{0.4 * mm, 0.3 * mm, 0.2 * mm},
                            {value(results["d40"]), value(results["d30"]), value(results["d20"])}};
    };
    const auto extrapolate = [&](const std::string& key, const std::string& unit,
                                 const std::function<double(const RunData&)>& value) {
        figures.add({key + "_extrapolated", unit, {}}, {"d20", "d30", "d40"},
                    [=] { return study(value).extrapolated(); });
        figures.add({key + "_grid_convergence_index_percent", "percent", {}}, {"d20", "d30", "d40"},
                    [=] { return study(value).convergence_index_percent(); });
    };
    extrapolate("drop", "Pa", drop);
    for (const OutletReference& o : outlets)
        extrapolate(fmt::format("flow_{}", o.key), "m^3/s",
                    [name = std::string("flow_") + o.name](const RunData& d) { return number(d, name); });
    figures.add({"offset_change_percent", "percent", Bar{0.1}}, {"d40", "d40_level"}, [&] {
        double worst = 0;
        for (const char* list : {"flow", "peak", "wss"}) {
            const auto &a = results["d40"].list(list), &b = results["d40_level"].list(list);
            const double largest = *std::max_element(a.begin(), a.end());
            for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, 100 * std::abs(a[k] - b[k]) / largest);
        }
        return worst;
    });
    for (const auto& [start, run] : {std::pair{"cells", "d40"}, std::pair{"estimate", "d40_estimate"}})
        figures.add({fmt::format("steps_from_{}_over_rest", start), "1", Bar{0.5}}, {run, "d40_rest"}, [&, run] {
            return number(results[run], "acoustic_steps") / number(results["d40_rest"], "acoustic_steps");
        });
    for (const OutletReference& o : outlets) {
        const std::string name = std::string("velocity_") + o.name;
        figures.add({fmt::format("velocity_{}", o.key), "m/s", {}}, {"d20"},
                    [&results, name] { return number(results["d20"], name); });
        figures.add({fmt::format("paper_printed_velocity_{}", o.key), "m/s", {}}, {"d20"},
                    [&o] { return o.paper_velocity; });
        figures.add({fmt::format("velocity_{}_re600", o.key), "m/s", {}}, {"d40_re600"},
                    [&results, name] { return number(results["d40_re600"], name); });
    }
    figures.add({"gauge_pressure_ratio", "1", {}}, {"d20"}, [&, at] {
        return results["d20"].list("pressure")[at(distal_arc)] / results["d20"].list("pressure")[at(proximal_arc)];
    });
    figures.add({"paper_printed_gauge_pressure_ratio", "1", {}}, {"d20"}, [] { return 0.45; });
}

std::vector<Picture> bifurcation_pictures(const Results& results) {
    const auto sections = known_sections(results);
    if (sections.empty()) return {};
    std::vector<Curve> pressure, shear;
    const auto curve = [&](const std::string& title, bool is_line, auto value) {
        Curve c{title, {}, {}, is_line};
        for (std::size_t k = 0; k < sections.size(); ++k)
            if (sections[k].branch == stenosed) c.x.push_back(1e3 * sections[k].arc), c.y.push_back(value(k));
        return c;
    };
    pressure.push_back(curve("finite volumes", true, [&](std::size_t k) { return sections[k].pressure; }));
    shear.push_back(curve("finite volumes", true, [&](std::size_t k) { return sections[k].wss; }));
    for (const auto& [run, title] : {std::pair{"d40", "0.4 mm"}, {"d30", "0.3 mm"}, {"d20", "0.2 mm"}}) {
        if (!results.has(run)) continue;
        pressure.push_back(
            curve(title, false, [&, run = run](std::size_t k) { return results[run].list("pressure")[k]; }));
        shear.push_back(curve(title, false, [&, run = run](std::size_t k) { return results[run].list("wss")[k]; }));
    }
    return {{"coronary_pressure", "Mean pressure of sections along the stenosed branch",
             format_plot({"arc [mm]", "p [Pa]", pressure})},
            {"coronary_wss", "Mean wall shear stress of sections along the stenosed branch",
             format_plot({"arc [mm]", "WSS [Pa]", shear})}};
}

}   // namespace

std::vector<VerifyCase> coronary_cases() {
    return {{.name = "coronary_bifurcation",
             .title = "The reference paper's bifurcation against finite volumes",
             .level = Level::full,
             .is_full = {},
             .measure = measure_bifurcation,
             .figures = bifurcation_figures,
             .pictures = bifurcation_pictures}};
}

}   // namespace patency
