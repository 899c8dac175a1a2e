// SPDX-License-Identifier: Apache-2.0
// Vessels on cells against finite volumes: the reference paper's bifurcation and a real left coronary tree.
#include <algorithm>
#include <cmath>

#include "patency/stages/cell_scene.h"
#include "patency/stages/cell_vessel.h"
#include "patency/verify/cpu_time.h"
#include "patency/verify/measures.h"
#include "patency/verify/verify_case.h"
#include "patency/verify/vessel_sections.h"

namespace patency {

namespace {

constexpr double mm = 1e-3;

struct OutletReference {
    const char* name;
    double flow, drop;   // [m^3/s]; from the inlet's mean pressure [Pa]
};

void put_number(RunData& data, const std::string& name, double value) { data.lists[name] = {value}; }

/// The deck's flow; sections and openings, and what it cost from the vessel to the fields.
void measure_vessel(const deck::Case& config, std::vector<VesselSection> sections,
                    const std::function<bool()>& interrupted, RunData& data) {
    const double before = cpu_seconds();
    const auto cells = make_solved_scene(config, [&](const CellScene&) { return interrupted && interrupted(); });
    put_number(data, "cpu_s", cpu_seconds() - before);
    data.particles = std::int64_t(cells->mesh.size());
    if (!cells->solution.is_converged) return;
    const auto scene = scene_of_cells(*cells);
    SectionsMeasure measure(*scene, std::move(sections));
    measure.sample(*scene);
    measure.write(data);
    const auto ends = cells->balance->end_states();
    double sum = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        put_number(data, "flow_" + cells->lumen.openings[k].name, ends[k].flow);
        put_number(data, "pressure_" + cells->lumen.openings[k].name, ends[k].pressure);
        sum += ends[k].flow;
    }
    put_number(data, "imbalance", std::abs(sum / ends[0].flow));
    double finest = INFINITY;
    for (const Vec3& x : cells->mesh.point) finest = std::min(finest, cells->spacing_at(x));
    put_number(data, "across_narrowest", cells->lumen.narrowest / finest);
    put_number(data, "steps", double(cells->solution.history.size()));
}

// --- the bifurcation ---

constexpr OutletReference bifurcation_outlets[] = {
    {"outlet_large", 3.03084489e-6, 0}, {"outlet_medium", 5.63052032e-7, 0}, {"outlet_small", 3.66060709e-7, 0}};
constexpr double bifurcation_inflow = 3.95995756e-6, inlet_pressure = 176.49;   // [m^3/s], [Pa]
constexpr double proximal_arc = 13.989 * mm, distal_arc = 33.998 * mm;
constexpr double least_wss = 0.5;   // Pa: below it, in separated blood, a mean says little

void measure_bifurcation(const deck::Case& config, const std::string&, const std::filesystem::path& reference,
                         const std::function<bool()>& interrupted, RunData& data) {
    measure_vessel(config, read_bifurcation_sections(reference), interrupted, data);
}

double pressure_at(const RunData& run, const std::vector<VesselSection>& sections, double arc) {
    std::size_t found = sections.size();
    for (std::size_t k = 0; k < sections.size(); ++k)
        if (sections[k].branch == "anterior_descending" &&
            (found == sections.size() || std::abs(sections[k].arc - arc) < std::abs(sections[found].arc - arc)))
            found = k;
    return run.list("pressure").at(found);
}

void bifurcation_figures(const Results& results, FigureList& figures) {
    std::vector<VesselSection> sections;
    for (const char* run : {"n12", "n16", "n20"})
        if (results.has(run) && sections.empty()) sections = read_bifurcation_sections(results.reference());
    const auto drop = [sections](const RunData& run) {
        return pressure_at(run, sections, proximal_arc) - pressure_at(run, sections, distal_arc);
    };
    for (const std::string run : {"n12", "n16", "n20"}) {
        const auto add = [&](const std::string& key, const std::string& unit, std::optional<Bar> bar,
                             const std::function<double(const RunData&)>& value) {
            figures.add({key + "_" + run, unit, bar}, {run}, [&results, run, value] { return value(results[run]); });
        };
        const auto worst = [](auto count, auto error) {
            double most = 0;
            for (std::size_t k = 0; k < count; ++k) most = std::max(most, error(k));
            return most;
        };
        add("flow_error_percent", "percent", Bar{2}, [=](const RunData& d) {
            return worst(std::size(bifurcation_outlets), [&](std::size_t k) {
                const OutletReference& o = bifurcation_outlets[k];
                return 100 * std::abs(d.number(std::string("flow_") + o.name) / o.flow - 1);
            });
        });
        add("flow_error_of_inlet_percent", "percent", Bar{1}, [=](const RunData& d) {
            return worst(std::size(bifurcation_outlets), [&](std::size_t k) {
                const OutletReference& o = bifurcation_outlets[k];
                return 100 * std::abs(d.number(std::string("flow_") + o.name) - o.flow) / bifurcation_inflow;
            });
        });
        add("drop_error_percent", "percent", Bar{2}, [=](const RunData& d) {
            RunData exact;
            for (const VesselSection& s : sections) exact.lists["pressure"].push_back(s.pressure);
            return 100 * std::abs(drop(d) / drop(exact) - 1);
        });
        add("section_pressure_error_percent", "percent", Bar{1.5}, [=](const RunData& d) {
            return worst(sections.size(), [&](std::size_t k) {
                return 100 * std::abs(d.list("pressure")[k] - sections[k].pressure) / inlet_pressure;
            });
        });
        add("mean_wss_error_percent", "percent", Bar{5}, [=](const RunData& d) {
            double sum = 0, count = 0;
            for (std::size_t k = 0; k < sections.size(); ++k)
                if (sections[k].wss >= least_wss) sum += std::abs(d.list("wss")[k] / sections[k].wss - 1), count += 1;
            return 100 * sum / count;
        });
        add("worst_wss_error_percent", "percent", {}, [=](const RunData& d) {
            return worst(sections.size(), [&](std::size_t k) {
                return sections[k].wss >= least_wss ? 100 * std::abs(d.list("wss")[k] / sections[k].wss - 1) : 0.0;
            });
        });
        add("flow_imbalance", "1", Bar{1e-6}, [](const RunData& d) { return d.number("imbalance"); });
        add("cpu_s", "s", {}, [](const RunData& d) { return d.number("cpu_s"); });
    }
    const auto study = [&results, drop] {
        return SpacingStudy{{1.0 / 12, 1.0 / 16, 1.0 / 20},
                            {drop(results["n12"]), drop(results["n16"]), drop(results["n20"])}};
    };
    figures.add({"drop_extrapolated", "Pa", {}}, {"n12", "n16", "n20"}, [study] { return study().extrapolated(); });
    figures.add({"drop_grid_convergence_index_percent", "percent", {}}, {"n12", "n16", "n20"},
                [study] { return study().convergence_index_percent(); });
}

// --- the left coronary tree ---

constexpr OutletReference tree_outlets[] = {{"outlet_1", 4.5679046e-7, 489.34}, {"outlet_2", 3.177946e-7, 434.64},
                                            {"outlet_3", 2.694612e-7, 422.75},  {"outlet_4", 2.694407e-7, 1676.81},
                                            {"outlet_5", 1.182966e-7, 345.63},  {"outlet_6", 6.6995682e-8, 1506.97}};
constexpr double lesion_drop = 1402.4, lesion_from = -8 * mm, lesion_to = 4 * mm;   // [Pa]; arcs from the throat

void measure_tree(const deck::Case& config, const std::string&, const std::filesystem::path& reference,
                  const std::function<bool()>& interrupted, RunData& data) {
    measure_vessel(config, read_tree_sections(reference), interrupted, data);
}

void tree_figures(const Results& results, FigureList& figures) {
    for (const OutletReference& o : tree_outlets) {
        const auto error = [&results, o] {   // 5 Pa are enough where that is more than 4 %
            const RunData& run = results["n12"];
            const double drop = run.number("pressure_inlet") - run.number(std::string("pressure_") + o.name);
            return std::abs(drop - o.drop) < 5 ? 0.0 : 100 * std::abs(drop / o.drop - 1);
        };
        figures.add({std::string("drop_error_percent_") + o.name, "percent", Bar{4}}, {"n12"}, error);
    }
    figures.add({"lesion_drop_error_percent", "percent", Bar{5}}, {"n12"}, [&results] {
        const auto sections = read_tree_sections(results.reference());
        const auto at = [&](double arc) {
            for (std::size_t k = 0; k < sections.size(); ++k)
                if (std::abs(sections[k].arc - arc) < 1e-6) return results["n12"].list("pressure")[k];
            return std::nan("");
        };
        return 100 * std::abs((at(lesion_from) - at(lesion_to)) / lesion_drop - 1);
    });
    figures.add({"across_narrowest", "1", Bar{10, Sense::at_least}}, {"n12"},
                [&results] { return results["n12"].number("across_narrowest"); });
    figures.add({"flow_imbalance", "1", Bar{1e-6}}, {"n12"}, [&results] { return results["n12"].number("imbalance"); });
    figures.add({"cpu_s", "s", {}}, {"n12"}, [&results] { return results["n12"].number("cpu_s"); });
}

}   // namespace

std::vector<VerifyCase> vessel_cell_cases() {
    return {{.name = "cells_bifurcation",
             .title = "The reference paper's bifurcation on cells that follow the vessel, against finite volumes",
             .level = Level::full,
             .is_full = {},
             .measure = {},
             .measure_cells = measure_bifurcation,
             .figures = bifurcation_figures,
             .pictures = {}},
            {.name = "cells_left_coronary_tree",
             .title = "A real left coronary tree with a lesion of 84 %, on cells, against finite volumes",
             .level = Level::full,
             .is_full = {},
             .measure = {},
             .measure_cells = measure_tree,
             .figures = tree_figures,
             .pictures = {}}};
}

}   // namespace patency
