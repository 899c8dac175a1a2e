// SPDX-License-Identifier: Apache-2.0
// A figure is one number with the bar it must meet; a report is the figures of one verification case, as they stand in
// NAME.json. Knows nothing of how they are computed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace patency {

enum class Sense { at_most, at_least };

struct Bar {
    double limit;
    Sense sense = Sense::at_most;
};

struct Figure {
    std::string key;
    std::optional<double> value;   ///< none: its run failed
    std::string unit;              ///< "percent", "deg", "1", ..
    std::optional<Bar> bar;        ///< none: printed for comparison only
    std::string reason;            ///< why there is no value

    /// A figure without a bar passes if it has a value.
    bool passes() const;
};

enum class Level { quick, full };

struct CaseReport {
    std::string name;
    Level level = Level::quick;
    std::int64_t particles = 0;   ///< of blood, in the largest run
    std::vector<Figure> figures;

    bool passes() const;
};

std::string word_of(Level level);
std::string word_of(Sense sense);   ///< "<=" or ">="

/// {"name", "level", "particles", "figures": [{"key", "value", "unit", "bar", "sense", "pass"}]}; value null if there is
/// none (then "reason" says why), bar and sense null if there is none. @throws Error if a value is not finite.
std::string format_report(const CaseReport& report);
/// Reads what format_report wrote. @throws FileError with `source` if it is something else.
CaseReport parse_report(const std::string& text, const std::string& source);

}   // namespace patency
