// SPDX-License-Identifier: Apache-2.0
#include "patency/report/same_places.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "patency/report/results.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// A column of the line to one outlet, linear between its stations, the ends' beyond; nothing without the column.
std::optional<double> value_at(const CsvTable& table, double outlet, double arc, const char* column) {
    const auto *arcs = table.find("arc_m"), *lines = table.find("outlet"), *values = table.find(column);
    if (!arcs || !lines || !values) return {};
    std::optional<std::size_t> before;
    for (std::size_t k = 0; k < arcs->size(); ++k) {
        if ((*lines)[k] != outlet) continue;
        if ((*arcs)[k] >= arc) {
            if (!before || (*arcs)[k] == (*arcs)[*before]) return (*values)[k];
            const double share = (arc - (*arcs)[*before]) / ((*arcs)[k] - (*arcs)[*before]);
            return (*values)[*before] + share * ((*values)[k] - (*values)[*before]);
        }
        before = k;
    }
    if (!before) return {};
    return (*values)[*before];
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

double lowest_outlet(const Json& flow) {
    double lowest = INFINITY;
    for (const auto& [name, opening] : flow["openings"].items())
        if (name != "inlet") lowest = std::min(lowest, opening.value("mean_pressure_pa", double(INFINITY)));
    return lowest;
}

Json at_lesion(const Json& lesion, double outlet, const Json& after, const CsvTable& pullback) {
    const double throat = 1e-3 * lesion.value("throat_arc_mm", 0.0), length = 1e-3 * lesion.value("length_mm", 0.0),
                 read = 1e-3 * lesion.value("read_arc_mm", 0.0);
    const auto at = [&](double arc, const char* column) { return value_at(pullback, outlet, arc, column); };
    const auto first = at(1e-3 * start_arc_mm(lesion), "pressure_pa"), last = at(read, "pressure_pa");
    const auto proximal = at(throat - length, "pressure_pa"), distal = at(throat + length, "pressure_pa");
    const double level = lowest_outlet(after);
    const bool has_ratio = proximal && distal && std::isfinite(level) && *proximal > level;
    return {{"branch", lesion.value("branch", "")},
            {"throat_arc_mm", 1e3 * throat},
            {"length_mm", 1e3 * length},
            {"flow_m3_per_s", or_null(at(throat, "flow_m3_per_s"))},
            {"velocity_before_m_per_s", or_null(at(throat - length, "mean_velocity_m_per_s"))},
            {"velocity_behind_m_per_s", or_null(at(throat + length, "mean_velocity_m_per_s"))},
            {"drop_pa", first && last ? Json(*first - *last) : Json(nullptr)},
            {"read_arc_mm", 1e3 * read},
            {"gauge_pressure_ratio", has_ratio ? Json((*distal - level) / (*proximal - level)) : Json(nullptr)},
            {"ffr", or_null(at(read, "ffr"))}};
}

}   // namespace

double start_arc_mm(const Json& lesion) {
    return lesion.value("start_arc_mm", lesion.value("throat_arc_mm", 0.0) - 0.5 * lesion.value("length_mm", 0.0));
}

double outlet_of_other(const Json& flow, const Json& other, double outlet) {
    const std::vector<std::string> own = outlet_names(flow), names = outlet_names(other);
    const auto number = std::size_t(outlet);
    const auto found =
        number < 1 || number > own.size() ? names.end() : std::find(names.begin(), names.end(), own[number - 1]);
    return found == names.end() ? outlet : double(found - names.begin() + 1);
}

double outlet_through(const CsvTable& pullback, const Json& lesion) {
    const auto *arc = pullback.find("arc_m"), *line = pullback.find("outlet"), *flow = pullback.find("flow_m3_per_s");
    if (!arc || !line || !flow) return 1;
    const double throat = 1e-3 * lesion.value("throat_arc_mm", 0.0), wanted = lesion.value("flow_m3_per_s", 0.0);
    constexpr double nearby = 1e-3, tenth = 0.1;   // a millimetre off the throat counts as a tenth of the flow
    double best = 1, least = INFINITY;
    for (std::size_t k = 0; k < arc->size(); ++k) {
        const double badness = std::abs((*arc)[k] - throat) / nearby +
                               std::abs((*flow)[k] - wanted) / (tenth * std::max(std::abs(wanted), 1e-12));
        if (badness < least - 1e-12) least = badness, best = (*line)[k];
    }
    return best;
}

Json at_lesions_of(const Json& before, const CsvTable& pullback_before, const Json& after,
                   const CsvTable& pullback_after) {
    Json places = Json::array();
    for (const Json& lesion : before["lesions"]) {
        const double outlet = outlet_of_other(before, after, outlet_through(pullback_before, lesion));
        places.push_back(at_lesion(lesion, outlet, after, pullback_after));
    }
    return places;
}

void add_at_lesions(Json& after, const Json& places) {
    after["at_lesions"] = places;
    const auto lacks = [&](const char* key) { return !after.contains(key) || after[key].empty(); };
    if (places.empty() || !lacks("lesions")) return;
    after["gauge_pressure_ratio"] = places[0]["gauge_pressure_ratio"];
    Json worst;
    for (const Json& place : places)
        if (place["ffr"].is_number() && (worst.is_null() || place["ffr"] < worst)) worst = place["ffr"];
    if (worst.is_number()) after["ffr"] = {{"lesion", worst}, {"read_at", "where the lesion was"}};
}

}   // namespace patency
