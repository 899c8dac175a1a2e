// SPDX-License-Identifier: Apache-2.0
#include "patency/report/figures.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace patency {

namespace {

using Pointer = nlohmann::ordered_json::json_pointer;

constexpr std::string_view dash = "<span class=\"none\">–</span>";

struct Ending {
    std::string_view end;
    Measure measure;
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
    {"_percent", as_percent},
    {"_mpa", {"MPa", 1, 2}},
    {"_pa", {"kPa", 1e-3, 2}},
    {"_atm", {"atm", 1, 1}},
    {"_mmhg", {"mmHg", 1, 2}},
    {"_m", {"mm", 1e3, 3}},
    {"_s", {"s", 1, 4}},
    {"_j", {"mJ", 1e3, 3}},
    {"_n", {"N", 1, 3}},
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

std::string words_of(std::string_view key) {
    if (const Ending* ending = ending_of(key)) key.remove_suffix(ending->end.size());
    std::string words(key);
    for (char& c : words)
        if (c == '_') c = ' ';
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
