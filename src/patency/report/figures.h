// SPDX-License-Identifier: Apache-2.0
// Numbers of summary.json as the page shows them. Each carries where it comes from and how it was scaled, so that a test, or a
// reader's script, can hold the page against the file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace patency {

/// Text for HTML: what a deck says can never become markup.
std::string escaped(std::string_view text);

/// What is added to a pointer of JSON for a key, whatever is in the key (RFC 6901): "/before" + step("a/b").
std::string step(std::string_view key);
std::string step(std::size_t index);

/// How numbers of one kind are shown: number * scale, with so many digits behind the point.
struct Measure {
    std::string_view unit;
    double scale = 1;
    int digits = 2;
};
inline constexpr Measure as_mmHg{"mmHg", 1 / 133.322387415, 2};
inline constexpr Measure as_mL_per_min{"mL/min", 6e7, 1};
inline constexpr Measure as_mm{"mm", 1, 2};
inline constexpr Measure as_percent{"%", 1, 1};
inline constexpr Measure as_share{"%", 100, 1};
inline constexpr Measure as_m_per_s{"m/s", 1, 3};
inline constexpr Measure as_ratio{"", 1, 3};
inline constexpr Measure as_count{"", 1, 0};
inline constexpr Measure as_across{"", 1, 1};

/// By the end of its key, as all keys of summary.json carry their unit: "recoil_percent", "minimum_diameter_mm".
Measure measure_of(std::string_view key);
bool says_unit(std::string_view key);
/// The measure that shows a number of this size best: Pa from kPa to GPa, no decimals where there are
/// hundreds, three where there are hundredths.
Measure at_size(Measure measure, double value);
/// The key without its unit, in words: "recoil_percent" -> "Recoil", "young_mpa" -> "Young's modulus".
std::string words_of(std::string_view key);
std::string lower_words_of(std::string_view key);   ///< to go on with: "recoil"

class Figures {
public:
    explicit Figures(const nlohmann::ordered_json& summary) : summary_(summary) {}

    /// The number at a pointer, or a dash when there is none. `with_unit`: the unit behind it.
    std::string number(const std::string& pointer, const Measure& measure) const;
    std::string with_unit(const std::string& pointer, const Measure& measure) const;
    /// One number over another.
    std::string ratio(const std::string& pointer, const std::string& over, const Measure& measure) const;
    /// "1.2e-06", for tables in SI.
    std::string scientific(const std::string& pointer, int digits = 2, double sign = 1) const;

    bool has(const std::string& pointer) const;       ///< a number is there
    double value(const std::string& pointer) const;   ///< NaN without one
    /// The text at a pointer, escaped; empty without one.
    std::string text(const std::string& pointer) const;

private:
    const nlohmann::ordered_json& summary_;
};

}   // namespace patency
