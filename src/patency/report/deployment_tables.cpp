// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "patency/report/figures.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// Every number below a part of the summary, whatever the run has found worth giving.
std::string rows_of_numbers(const Figures& f, const Json& part, const std::string& path, const std::string& of = "",
                            const Measure& inherited = as_ratio) {
    std::string rows;
    for (const auto& [key, value] : part.items()) {
        const Measure measure = says_unit(key) ? measure_of(key)   // {"spacing_mm": {"stent": 1, "wall": 2}}
                                : value.is_number_integer() ? as_count
                                                            : inherited;
        const std::string at = path + step(key), what = of.empty() ? words_of(key) : of + ", " + lower_words_of(key);
        if (value.is_number()) rows += table_row({escaped(what), f.with_unit(at, at_size(measure, f.value(at)))});
        if (value.is_object()) rows += rows_of_numbers(f, value, at, what, measure);
    }
    return rows;
}

/// Of the deployment what says how the stent sits.
std::string fit_table(const Figures& f, const Json& deploy) {
    const std::set<std::string> effort{"energies",     "stresses", "particles",   "spacing_mm",
                                       "mass_scaling", "steps",    "slowest_pace"};
    Json part;
    for (const auto& [key, value] : deploy.items())
        if (!effort.contains(key)) part[key] = value;
    return table("Deployment", {"Quantity", "Value"}, rows_of_numbers(f, part, "/deploy"));
}

/// One row for every distribution below a part: {"p50": , "p95": , "p99": , "largest": }, all of one kind of number.
std::string rows_of_stresses(const Figures& f, const Json& part, const std::string& path, const std::string& of = "",
                             const Measure& inherited = as_share) {
    std::string rows;
    for (const auto& [key, value] : part.items()) {
        const Measure measure = says_unit(key) ? measure_of(key) : inherited;
        const std::string at = path + step(key), what = of.empty() ? words_of(key) : of + ", " + lower_words_of(key);
        if (!value.is_object()) continue;
        if (!value.contains("p50")) {
            rows += rows_of_stresses(f, value, at, what, measure);
            continue;
        }
        const Measure shown = at_size(measure, f.value(at + "/largest"));
        std::vector<std::string> cells{fmt::format("{}, {}", escaped(what), shown.unit)};
        for (const char* share : {"/p50", "/p95", "/p99", "/largest"}) cells.push_back(f.number(at + share, shown));
        rows += table_row(cells);
    }
    return rows;
}

/// The bodies' energies side by side; both have the same kinds.
std::string rows_of_energies(const Figures& f, const Json& energies) {
    const Json stent = energies.value("stent", Json::object());
    std::string rows;
    for (const auto& [key, value] : stent.items())
        rows += table_row({escaped(words_of(key)), f.number("/deploy/energies/stent" + step(key), measure_of(key)),
                           f.number("/deploy/energies/wall" + step(key), measure_of(key))});
    return rows;
}

}   // namespace

std::string deployment_tables(const RunResults& results) {
    if (!results.has_deployment) return {};
    const Figures f(*results.summary);
    const Json& deploy = (*results.summary)["deploy"];
    std::string tables = fit_table(f, deploy);
    if (deploy.contains("stresses"))
        tables += table("Stresses and strains at the end of the deployment",
                        {"Where", "median", "95 % below", "99 % below", "largest"},
                        rows_of_stresses(f, deploy["stresses"], "/deploy/stresses"));
    std::string rows;
    if (deploy.contains("energies")) {
        const Json& energies = deploy["energies"];
        tables += table("Energies of the deployment, mJ", {"Energy", "Stent", "Wall"}, rows_of_energies(f, energies));
        Json shared;   // what the tool did, and what was lost between the bodies
        for (const auto& [key, value] : energies.items())
            if (value.is_number()) shared[key] = value;
        rows = rows_of_numbers(f, shared, "/deploy/energies");
    }
    for (const char* key : {"particles", "spacing_mm", "mass_scaling", "steps", "slowest_pace"})
        if (deploy.contains(key)) rows += rows_of_numbers(f, Json{{key, deploy[key]}}, "/deploy");
    if (!rows.empty()) tables += table("What the deployment took", {"Quantity", "Value"}, rows);
    return tables;
}

}   // namespace patency
