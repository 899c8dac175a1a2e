// SPDX-License-Identifier: Apache-2.0
#include "patency/report/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/io/atomic_file.h"
#include "patency/io/summary.h"
#include "patency/report/sweep_quantities.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// Quotes where a reader of CSV needs them (RFC 4180).
std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == text.npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string csv_line(const std::vector<std::string>& cells) {
    std::vector<std::string> quoted;
    for (const std::string& cell : cells) quoted.push_back(csv_cell(cell));
    return join(quoted, ",") + "\n";
}

/// Pointers of all numbers that are in no list, in their order.
void collect_numbers(const Json& value, const std::string& pointer, std::vector<std::string>& pointers) {
    if (value.is_number() && std::find(pointers.begin(), pointers.end(), pointer) == pointers.end())
        pointers.push_back(pointer);
    if (value.is_object())
        for (const auto& [key, member] : value.items()) collect_numbers(member, pointer + step(key), pointers);
}

/// "/before/ffr/lesion" -> "before.ffr.lesion"
std::string column_name(std::string pointer) {
    pointer.erase(0, 1);
    std::replace(pointer.begin(), pointer.end(), '/', '.');
    return pointer;
}

std::string state_of(const SweepRow& row) {
    if (!row.exit_code) return "has not run yet";
    return *row.exit_code == 0 ? "done" : row.reason;
}

}   // namespace

std::string sweep_csv(const Sweep& sweep) {
    std::vector<std::string> pointers;
    for (const SweepRow& row : sweep.rows)
        if (row.summary) collect_numbers(*row.summary, "", pointers);
    const std::vector<SweepQuantity> quantities = sweep_quantities(sweep);
    std::vector<std::string> head{"run"};
    head.insert(head.end(), sweep.keys.begin(), sweep.keys.end());
    head.insert(head.end(), {"exit_code", "reason"});
    for (const SweepQuantity& q : quantities) head.push_back(q.column);
    for (const std::string& pointer : pointers) head.push_back(column_name(pointer));
    std::string text = csv_line(head);
    for (const SweepRow& row : sweep.rows) {
        std::vector<std::string> cells{row.name};
        cells.insert(cells.end(), row.values.begin(), row.values.end());
        cells.push_back(row.exit_code ? fmt::format("{}", *row.exit_code) : "");
        cells.push_back(row.reason);
        const auto number = [&](const std::string& pointer) {
            if (!row.summary || pointer.empty()) return std::string();
            const Figures figures(*row.summary);
            return figures.has(pointer) ? fmt::format("{}", figures.value(pointer)) : std::string();
        };
        for (const SweepQuantity& q : quantities) cells.push_back(row.summary ? number(q.pointer(*row.summary)) : "");
        for (const std::string& pointer : pointers) cells.push_back(number(pointer));
        text += csv_line(cells);
    }
    return text;
}

std::string sweep_text(const Sweep& sweep) {
    std::vector<std::vector<std::string>> lines{sweep.keys};
    const std::vector<SweepQuantity> quantities = sweep_quantities(sweep);
    for (const SweepQuantity& q : quantities)
        lines[0].push_back(q.measure.unit.empty() ? q.label : fmt::format("{}, {}", q.label, q.measure.unit));
    lines[0].push_back("state");
    for (const SweepRow& row : sweep.rows) {
        lines.push_back(row.values);
        for (const SweepQuantity& q : quantities) {
            const auto value = value_of(row, q);
            lines.back().push_back(value ? fmt::format("{:.{}f}", *value, q.measure.digits) : "-");
        }
        lines.back().push_back(state_of(row));
    }
    std::string text;
    for (const auto& line : lines) {
        for (std::size_t c = 0; c + 1 < line.size(); ++c) {   // the state, which may be long, is as long as it is
            std::size_t width = 0;
            for (const auto& other : lines) width = std::max(width, other[c].size());
            const bool is_key = c < sweep.keys.size();
            text += is_key ? fmt::format("{:<{}}  ", line[c], width) : fmt::format("{:>{}}  ", line[c], width);
        }
        text += line.back() + "\n";
    }
    return text;
}

void write_sweep(const std::filesystem::path& folder, const Sweep& sweep, std::string_view version) {
    Json record{{"name", sweep.name}, {"command", sweep.command}, {"keys", sweep.keys}, {"runs", Json::array()}};
    for (const SweepRow& row : sweep.rows)
        record["runs"].push_back({{"name", row.name},
                                  {"values", row.values},
                                  {"exit_code", row.exit_code ? Json(*row.exit_code) : Json(nullptr)},
                                  {"reason", row.reason},
                                  {"made_from", row.made_from ? *row.made_from : Json(nullptr)}});
    write_file(folder / "sweep.csv", sweep_csv(sweep));
    write_file(folder / "report.html", sweep_page(sweep, version));
    write_summary(folder / "sweep.json", record);
}

bool is_sweep(const std::filesystem::path& folder) { return std::filesystem::exists(folder / "sweep.json"); }

Sweep read_sweep(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "sweep.json";
    const Json record = read_summary(path);
    try {
        Sweep sweep{record.at("name"), record.at("command"), record.at("keys"), {}};
        for (const Json& run : record.at("runs")) {
            SweepRow row{.name = run.at("name"), .values = run.at("values"), .reason = run.at("reason")};
            if (row.values.size() != sweep.keys.size())
                throw FileError(fmt::format("'{}' is damaged: a run has {} values of {} keys.", path.string(),
                                            row.values.size(), sweep.keys.size()));
            if (!run.at("exit_code").is_null()) row.exit_code = run.at("exit_code").get<int>();
            if (!run.at("made_from").is_null()) row.made_from = std::make_shared<const Json>(run.at("made_from"));
            const std::filesystem::path summary = folder / row.name / "summary.json";
            const bool has_ended = row.exit_code == int(ExitCode::ok) || row.exit_code == int(ExitCode::bar_missed);
            if (has_ended && std::filesystem::exists(summary))
                row.summary = std::make_shared<const Json>(read_summary(summary));
            sweep.rows.push_back(std::move(row));
        }
        return sweep;
    } catch (const Json::exception& error) {
        throw FileError(fmt::format("'{}' is no record of a sweep: {}", path.string(), error.what()));
    }
}

}   // namespace patency
