// SPDX-License-Identifier: Apache-2.0
// What a run of a verification case leaves behind: named lists of numbers, kept in a file so that a run that is done
// is not computed again. What they mean is between a case's measure and its figures.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace patency {

struct RunData {
    std::string key;       ///< of deck and program: the run is valid for these only
    std::string failure;   ///< why it ended early; empty: it did not
    std::int64_t particles = 0, acoustic_steps = 0;
    double particle_steps = 0, cpu_s = 0, wall_s = 0;
    std::map<std::string, std::vector<double>> lists;

    const std::vector<double>& list(const std::string& name) const;   ///< @throws Error, naming it, if there is none
    double number(const std::string& name) const { return list(name).at(0); }
};

std::string format_run(const RunData& run);
/// None if the text is not of a run (cut off, of another version): then the run is done again.
std::optional<RunData> parse_run(const std::string& text);

}   // namespace patency
