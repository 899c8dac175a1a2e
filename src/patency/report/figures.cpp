// SPDX-License-Identifier: Apache-2.0
#include "patency/report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

namespace patency {

namespace {

using Pointer = nlohmann::ordered_json::json_pointer;

constexpr std::string_view dash = "<span class=\"none\">–</span>";

struct Ending {
    std::string_view end;
    Measure measure;
    std::size_t unit_length = end.size();   ///< what is no word of it
};
// The longest first, where one ends another.
constexpr Ending endings[] = {
    {"_pa_s_per_m3", {"Pa s/m³", 1, 0}},
    {"_pa_s", {"mPa s", 1e3, 2}},
    {"_kg_per_m3", {"kg/m³", 1, 0}},
    {"_m3_per_s", as_mL_per_min},
    {"_m_per_s", as_m_per_s},
    {"_mm2", {"mm²", 1, 2}},
    {"_mm", as_mm},
    {"_um", {"µm", 1, 1}},
    {"drift_percent", {"%", 1, 3}, 8},   // its bar is 0.05
    {"_percent", as_percent},
    {"_mpa", {"MPa", 1, 2}},
    {"tool_pressure_pa", {"atm", 1 / 101'325.0, 1}, 3},
    {"_pa", {"kPa", 1e-3, 2}},
    {"_atm", {"atm", 1, 1}},
    {"_mmhg", {"mmHg", 1, 2}},
    {"_m", {"mm", 1e3, 3}},
    {"_s", {"s", 1, 4}},
    {"_j", {"mJ", 1e3, 3}},
    {"_n", {"N", 1, 3}},
};

/// What keys cannot say as one would.
struct Phrase {
    std::string_view in_keys, said;
};
constexpr Phrase phrases[] = {
    {"von mises", "von Mises stress"},
    {"kinetic to internal", "kinetic over internal energy"},
    {"internal energy stent", "internal energy, stent"},
    {"internal energy wall", "internal energy, wall"},
    {"drag loss to internal stent", "drag over internal energy, stent"},
    {"penetration over spacing", "overlap over the struts' spacing"},
    {"imbalance", "imbalance of energy"},
    {"malapposed", "struts off the wall"},
    {"young", "Young's modulus"},
    {"poisson", "Poisson's ratio"},
};

/// Without the sign of a zero.
std::string rounded(double value, int digits) {
    std::string text = fmt::format("{:.{}f}", value, digits);
    return text.starts_with('-') && text.find_first_not_of("-0.") == text.npos ? text.substr(1) : text;
}

const Ending* ending_of(std::string_view key) {
    for (const Ending& e : endings)
        if (key.ends_with(e.end)) return &e;
    return nullptr;
}

}   // namespace

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) switch (c) {
            case '&': result += "&amp;"; break;
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '"': result += "&quot;"; break;
            case '\'': result += "&#39;"; break;
            default: result += c;
        }
    return result;
}

std::string step(std::string_view key) {
    std::string result = "/";
    for (const char c : key) result += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return result;
}

std::string step(std::size_t index) { return fmt::format("/{}", index); }

Measure measure_of(std::string_view key) {
    const Ending* ending = ending_of(key);
    return ending ? ending->measure : as_ratio;
}

bool says_unit(std::string_view key) { return ending_of(key) != nullptr; }

Measure at_size(Measure measure, double value) {
    if (!std::isfinite(value)) return measure;
    constexpr std::string_view pressures[] = {"kPa", "MPa", "GPa"};
    for (std::size_t k = 0; k + 1 < std::size(pressures); ++k)
        if (measure.unit == pressures[k] && std::abs(value * measure.scale) >= 10'000)
            measure.unit = pressures[k + 1], measure.scale *= 1e-3;
    const double shown = std::abs(value * measure.scale);
    if (shown >= 100) measure.digits = 0;
    if (shown > 0 && shown < 0.1) measure.digits = std::max(measure.digits, 3);
    return measure;
}

std::string lower_words_of(std::string_view key) {
    if (const Ending* ending = ending_of(key)) key.remove_suffix(ending->unit_length);
    std::string words(key);
    std::replace(words.begin(), words.end(), '_', ' ');
    for (const Phrase& phrase : phrases)
        if (const std::size_t at = words.find(phrase.in_keys); at != words.npos)
            words.replace(at, phrase.in_keys.size(), phrase.said);
    return words;
}

std::string words_of(std::string_view key) {
    std::string words = lower_words_of(key);
    if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = char(words[0] - 'a' + 'A');
    return words;
}

bool Figures::has(const std::string& pointer) const { return !std::isnan(value(pointer)); }

double Figures::value(const std::string& pointer) const {
    const Pointer place(pointer);
    if (!summary_.contains(place) || !summary_.at(place).is_number()) return std::numeric_limits<double>::quiet_NaN();
    return summary_.at(place).get<double>();
}

std::string Figures::text(const std::string& pointer) const {
    const Pointer place(pointer);
    return summary_.contains(place) && summary_.at(place).is_string() ? escaped(summary_.at(place).get<std::string>())
                                                                      : std::string();
}

std::string Figures::number(const std::string& pointer, const Measure& m) const {
    if (!has(pointer)) return std::string(dash);
    return fmt::format("<data value=\"{}\" data-path=\"{}\" data-scale=\"{}\" data-digits=\"{}\">{}</data>",
                       value(pointer), escaped(pointer), m.scale, m.digits,
                       rounded(value(pointer) * m.scale, m.digits));
}

std::string Figures::with_unit(const std::string& pointer, const Measure& m) const {
    if (!has(pointer) || m.unit.empty()) return number(pointer, m);
    return fmt::format("{}<span class=\"unit\"> {}</span>", number(pointer, m), m.unit);
}

std::string Figures::ratio(const std::string& pointer, const std::string& over, const Measure& m) const {
    if (!has(pointer) || !has(over) || value(over) == 0) return std::string(dash);
    const double ratio = value(pointer) / value(over);
    return fmt::format(
        "<data value=\"{}\" data-path=\"{}\" data-over=\"{}\" data-scale=\"{}\" data-digits=\"{}\">{}</data>", ratio,
        escaped(pointer), escaped(over), m.scale, m.digits, rounded(ratio * m.scale, m.digits));
}

std::string Figures::scientific(const std::string& pointer, int digits, double sign) const {
    if (!has(pointer)) return std::string(dash);
    return fmt::format("<data value=\"{}\" data-path=\"{}\" data-scale=\"{}\" data-digits=\"e{}\">{:.{}e}</data>",
                       value(pointer), escaped(pointer), sign, digits, sign * value(pointer), digits);
}

}   // namespace patency
