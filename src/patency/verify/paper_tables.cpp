// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/paper_tables.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "patency/report/figures.h"
#include "patency/report/results.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view printed = "paper_printed_", scheme = "paper_";

const Figure* find(const CaseReport& report, const std::string& key) {
    for (const Figure& figure : report.figures)
        if (figure.key == key) return &figure;
    return nullptr;
}

std::string cell(const Figure* figure) { return figure && figure->value ? fmt::format("{:.3g}", *figure->value) : "–"; }

/// A row of table VI. Flows there are positive into the vessel, summary.json's out of it.
struct Row {
    const char *what, *before, *after;   ///< as printed
    const char* opening;                 ///< null: of the lesion
    const char* key;
    double sign;
};
constexpr Row table_six[] = {
    {"Velocity at the inlet, m/s", "0.315", "0.315", "inlet", "/mean_velocity_m_per_s", -1},
    {"Velocity at the large outlet, m/s", "0.325", "0.310", "outlet_large", "/mean_velocity_m_per_s", 1},
    {"Velocity at the middle outlet, m/s", "0.066", "0.095", "outlet_medium", "/mean_velocity_m_per_s", 1},
    {"Velocity at the small outlet, m/s", "0.069", "0.098", "outlet_small", "/mean_velocity_m_per_s", 1},
    {"Velocity before the stenosis, m/s", "0.108", "0.115", nullptr, "/velocity_before_m_per_s", 1},
    {"Velocity behind the stenosis, m/s", "0.110", "0.122", nullptr, "/velocity_behind_m_per_s", 1},
    {"Flow at the inlet, 1e-6 m³/s", "3.92", "3.93", "inlet", "/flow_m3_per_s", -1e6},
    {"Flow at the large outlet, 1e-6 m³/s", "-3.06", "-2.76", "outlet_large", "/flow_m3_per_s", -1e6},
    {"Flow at the middle outlet, 1e-6 m³/s", "-0.475", "-0.675", "outlet_medium", "/flow_m3_per_s", -1e6},
    {"Flow at the small outlet, 1e-6 m³/s", "-0.36", "-0.518", "outlet_small", "/flow_m3_per_s", -1e6},
    {"Flow through the stenosis, 1e-6 m³/s", "0.85", "1.15", nullptr, "/flow_m3_per_s", 1e6},
    {"Ratio of gauge pressures (called FFR there)", "0.45", "0.91", nullptr, "/gauge_pressure_ratio", 1},
};

std::string shown(const Figures& figures, const std::string& pointer, double sign) {
    return figures.has(pointer) ? fmt::format("{:.3f}", sign * figures.value(pointer)) : "–";
}

}   // namespace

std::string paper_figures_table(std::span<const CaseReport> reports) {
    std::string text =
        "| Case | Figure | Unit | The paper prints | Its scheme, run here | patency |\n|---|---|---|---|---|---|\n";
    for (const CaseReport& report : reports)
        for (const Figure& figure : report.figures) {
            if (!figure.key.starts_with(printed)) continue;
            const std::string key = figure.key.substr(printed.size());
            text += fmt::format("| [{0}](#{0}) | `{1}` | {2} | {3} | {4} | {5} |\n", report.name, key, figure.unit,
                                cell(&figure), cell(find(report, std::string(scheme) + key)), cell(find(report, key)));
        }
    return text;
}

std::string paper_table_six(const Json& run) {
    const Figures figures(run);
    const auto worst = run.contains("before") ? worst_lesion(run["before"]) : std::optional<std::size_t>();
    std::string text = "| Quantity | The paper: before | after | patency: before | after |\n|---|---|---|---|---|\n";
    for (const Row& row : table_six) {
        std::string before, after;
        if (row.opening)
            before = std::string("/before/openings/") + row.opening,
            after = std::string("/after/openings/") + row.opening;
        else if (worst)
            before = "/before/lesions" + step(*worst), after = "/after/at_lesions" + step(*worst);
        text += fmt::format("| {} | {} | {} | {} | {} |\n", row.what, row.before, row.after,
                            shown(figures, before + row.key, row.sign), shown(figures, after + row.key, row.sign));
    }
    return text;
}

}   // namespace patency
