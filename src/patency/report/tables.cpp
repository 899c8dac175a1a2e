// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "patency/report/figures.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// A heading over each flow's columns, when there are several.
std::vector<std::string> with_flows(const RunResults& results, std::vector<std::string> head,
                                    const std::vector<std::string>& columns) {
    for (const FlowPart& flow : results.flows)
        for (const std::string& column : columns)
            head.push_back(results.flows.size() > 1
                               ? fmt::format("{}<br><span class=\"{}\">{}</span>", column, flow.key, flow.title)
                               : column);
    return head;
}

/// A row whose cells are the same numbers of every flow.
std::vector<std::string> cells_of(const RunResults& results, std::vector<std::string> cells,
                                  const std::vector<std::function<std::string(const std::string& path)>>& columns) {
    for (const FlowPart& flow : results.flows)
        for (const auto& column : columns) cells.push_back(column(flow.path));
    return cells;
}

const Json& first_part(const RunResults& results) { return results.part(results.flows.front()); }
bool is_planar(const RunResults& results) { return first_part(results).value("planar", false); }

std::string split_table(const RunResults& results) {
    const Figures f(*results.summary);
    const Measure flow = is_planar(results) ? Measure{"m²/s", 1, 6} : as_mL_per_min;
    std::string rows;
    if (!first_part(results).contains("openings")) return {};
    for (const auto& [name, opening] : first_part(results)["openings"].items()) {
        const std::string at = "/openings" + step(name);
        const double share = name == "inlet" ? 100.0 : -100.0;   // percent, out is positive
        rows += table_row(cells_of(
            results, {escaped(name)},
            {[&](const std::string& path) { return f.number(path + at + "/flow_m3_per_s", flow); },
             [&](const std::string& path) {
                 return f.ratio(path + at + "/flow_m3_per_s", path + "/openings/inlet/flow_m3_per_s", {"%", share, 1});
             },
             [&](const std::string& path) { return f.number(path + at + "/mean_pressure_pa", as_mmHg); },
             [&](const std::string& path) { return f.number(path + at + "/mean_velocity_m_per_s", as_m_per_s); }}));
    }
    return table("Openings (out is positive)",
                 with_flows(results, {"Opening"},
                            {fmt::format("Flow, {}", flow.unit), "Share, %", "Pressure, mmHg", "Velocity, m/s"}),
                 rows);
}

std::vector<std::string> branch_names(const Json& part) {
    std::vector<std::string> names;
    if (part.contains("branches"))
        for (const Json& branch : part["branches"]) names.push_back(branch.value("name", ""));
    return names;
}

/// Its pointer in the flow at `path`; one to nothing where the flow has no such branch.
std::string branch_called(const RunResults& results, const std::string& path, const std::string& name) {
    const auto names = branch_names(results.summary->at(Json::json_pointer(path)));
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? "/none" : path + "/branches" + step(std::size_t(at - names.begin()));
}

std::string branch_table(const RunResults& results) {
    const Figures f(*results.summary);
    std::vector<std::string> names;   // of all flows: a branch may be found in one of them only
    for (const FlowPart& flow : results.flows)
        for (const std::string& name : branch_names(results.part(flow)))
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    if (names.empty()) return {};
    std::string rows;
    for (const std::string& name : names) {
        std::string length = "/none";
        for (const FlowPart& flow : results.flows)
            if (const std::string here = branch_called(results, flow.path, name) + "/length_mm"; !f.has(length))
                length = here;
        const auto at = [&](const std::string& path, const char* key) {
            return branch_called(results, path, name) + key;
        };
        rows += table_row(
            cells_of(results, {escaped(name), f.number(length, as_mm)},
                     {[&](const std::string& path) { return f.number(at(path, "/flow_m3_per_s"), as_mL_per_min); },
                      [&](const std::string& path) { return f.number(at(path, "/pressure_end_pa"), as_mmHg); },
                      [&](const std::string& path) { return f.number(at(path, "/ffr_end"), as_ratio); },
                      [&](const std::string& path) {
                          const Json::json_pointer place(at(path, "/is_under_resolved"));
                          const bool is_coarse = results.summary->contains(place) && results.summary->at(place) == true;
                          return f.number(at(path, "/particles_across"), as_across) +
                                 (is_coarse ? " <span class=\"verdict look\">few</span>" : "");
                      }}));
    }
    return table("Branches",
                 with_flows(results, {"Branch", "Length, mm"},
                            {"Flow, mL/min", "Pressure at its end, mmHg", "FFR at its end", "Particles across"}),
                 rows);
}

std::string lesion_table(const RunResults& results) {
    const Figures f(*results.summary);
    std::string rows;
    for (const FlowPart& flow : results.flows) {
        const Json& part = results.part(flow);
        if (!part.contains("lesions")) continue;
        for (std::size_t k = 0; k < part["lesions"].size(); ++k) {
            const std::string at = flow.path + "/lesions" + step(k);
            const std::string when =
                results.flows.size() > 1 ? fmt::format("<span class=\"{}\">{}</span> ", flow.key, flow.title) : "";
            rows += table_row({when + f.text(at + "/branch"), f.number(at + "/throat_arc_mm", as_mm),
                               f.number(at + "/length_mm", as_mm), f.number(at + "/minimum_diameter_mm", as_mm),
                               f.number(at + "/diameter_stenosis_percent", as_percent),
                               f.number(at + "/area_stenosis_percent", as_percent),
                               f.number(at + "/flow_m3_per_s", as_mL_per_min), f.number(at + "/drop_pa", as_mmHg),
                               f.number(at + "/ffr", as_ratio), f.number(at + "/read_arc_mm", as_mm),
                               f.number(at + "/gauge_pressure_ratio", as_ratio)});
        }
    }
    if (rows.empty()) return {};
    return table("Lesions",
                 {"Lesion in", "Throat at, mm", "Length, mm", "Minimum lumen, mm", "Diameter stenosis, %",
                  "Area stenosis, %", "Flow, mL/min", "Drop, mmHg", "FFR", "read at, mm", "Gauge ratio"},
                 rows);
}

/// The reference paper's table VI, row by row, its signs and units.
std::string paper_table(const RunResults& results) {
    const Figures f(*results.summary);
    const Focus focus = focus_of(results);
    if (focus.lesion.empty()) return {};
    std::string rows;
    const auto add = [&](const std::string& name, const std::function<std::string(std::size_t)>& cell) {
        std::vector<std::string> cells{name};
        for (std::size_t k = 0; k < results.flows.size(); ++k) cells.push_back(cell(k));
        rows += table_row(cells);
    };
    const auto opening_at = [&](std::size_t k, const std::string& name, const char* key) {
        return results.flows[k].path + "/openings" + step(name) + key;
    };
    const auto lesion_at = [&](std::size_t k, const char* key) { return focus.in_flow[k].value_or("/none") + key; };
    std::vector<std::string> names{"inlet"};
    for (const std::string& outlet : outlet_names(first_part(results))) names.push_back(outlet);
    for (const std::string& name : names)
        add("Velocity at " + escaped(name) + ", m/s", [&](std::size_t k) {
            return f.number(opening_at(k, name, "/mean_velocity_m_per_s"), {"", name == "inlet" ? -1.0 : 1.0, 3});
        });
    add("Velocity before the stenosis, m/s",
        [&](std::size_t k) { return f.number(lesion_at(k, "/velocity_before_m_per_s"), as_m_per_s); });
    add("Velocity behind the stenosis, m/s",
        [&](std::size_t k) { return f.number(lesion_at(k, "/velocity_behind_m_per_s"), as_m_per_s); });
    for (const std::string& name : names)
        add("Flow at " + escaped(name) + ", m³/s (in is positive)",
            [&](std::size_t k) { return f.scientific(opening_at(k, name, "/flow_m3_per_s"), 2, -1); });
    add("Flow through the stenosis, m³/s", [&](std::size_t k) { return f.scientific(lesion_at(k, "/flow_m3_per_s")); });
    add("Gauge pressure ratio (called FFR there)",
        [&](std::size_t k) { return f.number(lesion_at(k, "/gauge_pressure_ratio"), as_ratio); });
    std::vector<std::string> head{"Quantity"};
    for (const FlowPart& flow : results.flows) head.push_back(flow.title);
    return table("In the form of the reference paper's table VI", head, rows);
}

std::string outlet_table(const RunResults& results) {
    const Figures f(*results.summary);
    const std::string path = results.flows.front().path + "/openings";
    if (!first_part(results).contains("openings")) return {};
    const Json& openings = first_part(results)["openings"];
    std::vector<std::pair<std::string, std::string>> columns{
        {"Resistance, Pa s/m³", "/resistance_pa_s_per_m3"},
        {"Compliance, m³/Pa", "/compliance_m3_per_pa"},
        {"of the heart muscle's vessels, m³/Pa", "/myocardial_compliance_m3_per_pa"}};
    std::erase_if(columns, [&](const auto& column) {
        return std::none_of(openings.begin(), openings.end(),
                            [&](const Json& opening) { return opening.contains(column.second.substr(1)); });
    });
    std::vector<std::string> head{"Opening", "Area, mm²"};
    for (const auto& [title, key] : columns) head.push_back(title);
    head.push_back("Pressure behind it, mmHg");
    std::string rows;
    for (const auto& [name, opening] : openings.items()) {
        const std::string of = path + step(name);
        std::vector<std::string> row{escaped(name), f.number(of + "/area_m2", {"mm²", 1e6, 2})};
        for (const auto& [title, key] : columns) row.push_back(f.scientific(of + key, 3));
        row.push_back(f.number(of + "/distal_pressure_pa", as_mmHg));
        rows += table_row(row);
    }
    return table("What lies behind the openings", head, rows);
}

/// What everything is made of, and who says so.
std::string material_table(const RunResults& results) {
    const Json& summary = *results.summary;
    if (!summary.contains("materials") || !summary["materials"].is_array()) return {};
    const Figures f(summary);
    std::string rows;
    for (std::size_t k = 0; k < summary["materials"].size(); ++k) {
        const std::string at = "/materials" + step(k);
        std::string numbers;
        for (const auto& [key, value] : summary["materials"][k].items())
            if (value.is_number())
                numbers +=
                    fmt::format("{}<span class=\"whole\">{} {}</span>", numbers.empty() ? "" : ", ",
                                escaped(words_of(key)), f.with_unit(at + step(key), at_size(measure_of(key), value)));
        rows += table_row({f.text(at + "/part"), f.text(at + "/what"), numbers,
                           "<span class=\"source\">" + f.text(at + "/source") + "</span>"});
    }
    return table("Materials", {"Part", "What", "Numbers", "Source"}, rows, "words");
}

std::string run_numbers(const RunResults& results) {
    const Figures f(*results.summary);
    std::string rows;
    const auto add = [&](const std::string& name, const char* key, const Measure& measure) {
        std::vector<std::string> cells{name};
        bool is_there = false;
        for (const FlowPart& flow : results.flows) {
            cells.push_back(f.with_unit(flow.path + key, measure));
            is_there = is_there || f.has(flow.path + key);
        }
        if (is_there) rows += table_row(cells);
    };
    add("Particles of blood", "/particles/fluid", as_count);
    add("Particles of wall", "/particles/wall", as_count);
    add("Across the narrowest place", "/particles/across_narrowest", as_across);
    add("Finest spacing", "/spacing_m", {"mm", 1e3, 3});
    add("Coarsest spacing", "/largest_spacing_m", {"mm", 1e3, 3});
    add("Largest speed", "/largest_speed_m_per_s", as_m_per_s);
    add("Mean speed", "/mean_speed_m_per_s", as_m_per_s);
    add("Mass imbalance", "/mass_imbalance_percent", {"%", 1, 4});
    add("Acoustic steps", "/acoustic_steps", as_count);
    add("Iterations", "/iterations", as_count);
    add("Simulated time", "/time_s", {"s", 1, 3});
    add("Means from", "/averaged_from_s", {"s", 1, 3});
    add("Aortic pressure", "/aortic_pressure_pa", as_mmHg);
    add("Added to pressures for FFR", "/pressure_level_pa", as_mmHg);
    std::vector<std::string> head{"Quantity"};
    for (const FlowPart& flow : results.flows) head.push_back(flow.title);
    return table("Computation", head, rows);
}

}   // namespace

std::string table_row(const std::vector<std::string>& cells) {
    std::string row = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k)
        row += fmt::format("<{0}>{1}</{2}>", k == 0 ? "th scope=\"row\"" : "td", cells[k], k == 0 ? "th" : "td");
    return row + "</tr>\n";
}

std::string table(const std::string& caption, const std::vector<std::string>& head, const std::string& rows,
                  const std::string& kind) {
    std::string cells;
    for (const std::string& text : head) cells += "<th scope=\"col\">" + text + "</th>";
    return fmt::format(
        "<div class=\"table {}\" "
        "tabindex=\"0\"><table><caption>{}</caption><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
        kind, caption, cells, rows);
}

std::string tables_section(const RunResults& results) {
    std::string tables;
    if (!results.flows.empty()) tables += lesion_table(results) + split_table(results) + branch_table(results);
    tables += material_table(results);
    tables += "<div class=\"small-tables\">\n" + deployment_tables(results);
    if (!results.flows.empty()) tables += paper_table(results) + outlet_table(results) + run_numbers(results);
    tables += "</div>\n";
    return "<section id=\"tables\">\n<h2>Numbers</h2>\n" + tables + "</section>\n";
}

}   // namespace patency
