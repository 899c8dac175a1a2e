// SPDX-License-Identifier: Apache-2.0
#include "patency/report/sweep_quantities.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/report/results.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// A flow alone, or a run's first one.
std::string first_flow(const Json& summary) { return summary.contains("before") ? "/before" : ""; }

std::string at_worst_lesion(const Json& summary, const char* key) {
    const std::string flow = first_flow(summary);
    const auto worst = worst_lesion(summary.at(Json::json_pointer(flow)));
    return worst ? flow + "/lesions" + step(*worst) + key : "";
}

/// Where the first flow's worst lesion was, after the stent.
std::string where_it_was(const Json& summary, const char* key) {
    if (!summary.contains("before") || !summary.contains("after")) return {};
    const auto worst = worst_lesion(summary["before"]);
    return worst ? "/after/at_lesions" + step(*worst) + key : "";
}

std::string inlet_flow(const Json& summary, const std::string& flow) {
    const Json::json_pointer openings(flow + "/openings");
    if (!summary.contains(openings) || summary.at(openings).empty()) return {};
    const Json& all = summary.at(openings);
    return flow + "/openings" + step(all.contains("inlet") ? "inlet" : all.begin().key()) + "/flow_m3_per_s";
}

constexpr Measure inflow{"mL/min", -6e7, 1};   // summary.json counts flows outwards

const SweepQuantity known_quantities[] = {
    {"FFR", "ffr", as_ratio, [](const Json& s) { return at_worst_lesion(s, "/ffr"); }},
    {"FFR after", "ffr_after", as_ratio, [](const Json& s) { return where_it_was(s, "/ffr"); }},
    {"Pressure drop", "drop_pa", as_mmHg, [](const Json& s) { return at_worst_lesion(s, "/drop_pa"); }},
    {"Pressure drop after", "drop_after_pa", as_mmHg, [](const Json& s) { return where_it_was(s, "/drop_pa"); }},
    {"Inflow", "inlet_flow_m3_per_s", inflow, [](const Json& s) { return inlet_flow(s, first_flow(s)); }},
    {"Inflow after", "inlet_flow_after_m3_per_s", inflow,
     [](const Json& s) { return s.contains("after") ? inlet_flow(s, "/after") : std::string(); }},
    {"Minimum stent diameter", "stent_minimum_diameter_mm", as_mm,
     [](const Json&) { return std::string("/deploy/minimum_diameter_mm"); }},
    {"Recoil", "recoil_percent", as_percent, [](const Json&) { return std::string("/deploy/recoil_percent"); }},
    {"Struts off the wall", "malapposed_percent", as_percent,
     [](const Json&) { return std::string("/deploy/malapposed_percent"); }},
    {"Kinetic over internal energy",
     "kinetic_to_internal",
     {"", 1, 4},
     [](const Json& s) {
         return std::string(s.contains("deploy") ? "/deploy/kinetic_to_internal" : "/kinetic_to_internal");
     }},
};

/// "3.5 mPa s" -> 3.5, "mPa s"; quotes do not count.
std::optional<std::pair<double, std::string_view>> number_and_unit(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
        text = trimmed(text.substr(1, text.size() - 2));
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return {};
    return std::pair{value, trimmed(text.substr(std::size_t(end - text.data())))};
}

}   // namespace

std::optional<double> value_of(const SweepRow& row, const SweepQuantity& quantity) {
    if (!row.summary) return {};
    const std::string pointer = quantity.pointer(*row.summary);
    const Figures figures(*row.summary);
    if (pointer.empty() || !figures.has(pointer)) return {};
    return figures.value(pointer) * quantity.measure.scale;
}

std::vector<SweepQuantity> sweep_quantities(const Sweep& sweep) {
    std::vector<SweepQuantity> there;
    for (const SweepQuantity& quantity : known_quantities)
        if (std::any_of(sweep.rows.begin(), sweep.rows.end(),
                        [&](const SweepRow& row) { return value_of(row, quantity).has_value(); }))
            there.push_back(quantity);
    return there;
}

std::optional<SweepScale> scale_of(const Sweep& sweep, std::size_t key) {
    SweepScale scale;
    const Unit* first = nullptr;
    for (const SweepRow& row : sweep.rows) {
        const auto read = number_and_unit(row.values[key]);
        if (!read) return {};
        const Unit* unit = read->second.empty() ? nullptr : find_unit(read->second);
        if (!read->second.empty() && !unit) return {};
        if (scale.values.empty()) first = unit, scale.unit = unit ? unit->name() : "";
        if ((unit != nullptr) != (first != nullptr) || (unit && unit->dimension != first->dimension)) return {};
        scale.values.push_back(unit ? read->first * (unit->numerator / unit->denominator) /
                                          (first->numerator / first->denominator)
                                    : read->first);
    }
    return scale;
}

}   // namespace patency
