// SPDX-License-Identifier: Apache-2.0
// The page's sections as HTML: one function for each. Numbers come from summary.json by figures.h alone.
#pragma once

#include <string>

#include "patency/report/results.h"

namespace patency {

std::string glance_section(const RunResults& results);    ///< vessel, lesion, before -> after, how the stent sits
std::string quality_section(const RunResults& results);   ///< what speaks for and against these numbers
std::string quality_strip(const RunResults& results);     ///< the same in a line of marks, for the first screen
std::string static_section(const RunResults& results);    ///< pictures and curves that need no script
std::string beat_section(const RunResults& results);      ///< of periodic flows: what the openings do in time
std::string tables_section(
    const RunResults& results);   ///< lesions, flow split, the paper's table VI, stent, outlets, resolution
std::string deployment_tables(const RunResults& results);   ///< how the stent sits, stresses, energies, what it took
std::string run_section(const RunResults& results);         ///< deck, versions, input hashes, times, downloads

/// The lesion that the page is about: in the first flow, and where later flows find it again.
struct Focus {
    std::string lesion;   ///< its pointer in the first flow: "/before/lesions/0"; empty without one
    std::vector<std::optional<std::string>> in_flow;   ///< its pointer in every flow
};
Focus focus_of(const RunResults& results);

/// The pointer's number in every flow where there is one, "0.45 → 0.91", with its unit.
std::string change(const RunResults& results, const std::vector<std::optional<std::string>>& pointers,
                   const struct Measure& measure);

/// One row of a table: cells are HTML.
std::string table_row(const std::vector<std::string>& cells);
std::string table(const std::string& caption, const std::vector<std::string>& head, const std::string& rows,
                  const std::string& kind = "");

}   // namespace patency
