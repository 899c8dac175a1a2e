// SPDX-License-Identifier: Apache-2.0
// Several runs of a deck, side by side: one table and a page that compares them. Each run's numbers are in its own folder; here
// stands which runs there are and how they ended.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patency {

struct SweepRow {
    std::string name;                  ///< of the run and of its folder
    std::vector<std::string> values;   ///< of the sweep's keys, as they were written
    std::optional<int> exit_code{};    ///< absent: has not ended yet
    std::string reason{};              ///< of a run that failed
    std::shared_ptr<const nlohmann::ordered_json>
        made_from{};   ///< deck, inputs and program (origin_summary); may be null
    std::shared_ptr<const nlohmann::ordered_json> summary{};   ///< its summary.json; null where it has none

    bool has_results() const { return summary != nullptr; }
};

struct Sweep {
    std::string name, command;       ///< of the case; "run", "flow"...
    std::vector<std::string> keys;   ///< those that vary
    std::vector<SweepRow> rows;
};

/// Every number of the runs' summaries outside of lists, by its path ("before.ffr.lesion"), and the page's quantities; a cell is
/// empty where a run has no such number. First columns: run, the keys, exit_code, reason.
std::string sweep_csv(const Sweep& sweep);
/// The page's table for a terminal.
std::string sweep_text(const Sweep& sweep);
/// One self-contained page without a script: table, and a plot of every quantity against the first key that has numbers.
std::string sweep_page(const Sweep& sweep, std::string_view version);

/// sweep.json, sweep.csv and report.html into a folder. Throws FileError.
void write_sweep(const std::filesystem::path& folder, const Sweep& sweep, std::string_view version);
/// From sweep.json and the runs' summaries; `is_sweep`: whether there is one. Throws FileError.
bool is_sweep(const std::filesystem::path& folder);
Sweep read_sweep(const std::filesystem::path& folder);

}   // namespace patency
