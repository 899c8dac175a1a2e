// SPDX-License-Identifier: Apache-2.0
#include "patency/base/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/text.h"

namespace patency {

namespace {

// Sources: SI brochure (9th ed.); mmHg = 13595.1 kg/m^3 * 9.80665 m/s^2 * 1 mm; atm, bar, dyn, P by definition;
// a Wood unit is 1 mmHg min/L.
constexpr double mmHg = 133.322387415;

using enum Dimension;
constexpr std::array table{
    Unit{number, "", 1, 1},
    Unit{length, "m", 1, 1},
    Unit{length, "cm", 1, 100},
    Unit{length, "mm", 1, 1e3},
    Unit{length, "um", 1, 1e6},
    Unit{area, "m^2", 1, 1},
    Unit{area, "cm^2", 1, 1e4},
    Unit{area, "mm^2", 1, 1e6},
    Unit{time, "s", 1, 1},
    Unit{time, "ms", 1, 1e3},
    Unit{time, "us", 1, 1e6},
    Unit{time, "min", 60, 1},
    Unit{time, "h", 3600, 1},
    Unit{velocity, "m/s", 1, 1},
    Unit{velocity, "cm/s", 1, 100},
    Unit{velocity, "mm/s", 1, 1e3},
    Unit{acceleration, "m/s^2", 1, 1},
    Unit{acceleration, "cm/s^2", 1, 100},
    Unit{acceleration, "mm/s^2", 1, 1e3},
    Unit{mass, "kg", 1, 1},
    Unit{mass, "g", 1, 1e3},
    Unit{density, "kg/m^3", 1, 1},
    Unit{density, "g/cm^3", 1e3, 1},
    Unit{density, "g/mL|g/ml", 1e3, 1},
    Unit{pressure, "Pa", 1, 1},
    Unit{pressure, "kPa", 1e3, 1},
    Unit{pressure, "MPa", 1e6, 1},
    Unit{pressure, "GPa", 1e9, 1},
    Unit{pressure, "mmHg|mm Hg", mmHg, 1},
    Unit{pressure, "bar", 1e5, 1},
    Unit{pressure, "atm", 101325, 1},
    Unit{pressure, "dyn/cm^2", 1, 10},
    Unit{stiffness, "Pa/m", 1, 1},
    Unit{stiffness, "kPa/mm", 1e6, 1},
    Unit{viscosity, "Pa s", 1, 1},
    Unit{viscosity, "mPa s", 1, 1e3},
    Unit{viscosity, "cP", 1, 1e3},
    Unit{viscosity, "P", 1, 10},
    Unit{consistency, "Pa s^n", 1, 1},
    Unit{consistency, "mPa s^n", 1, 1e3},
    Unit{flow, "m^3/s", 1, 1},
    Unit{flow, "mL/min|ml/min", 1, 6e7},
    Unit{flow, "mL/s|ml/s|cm^3/s", 1, 1e6},
    Unit{flow, "L/min|l/min", 1, 6e4},
    Unit{flow, "mm^3/s", 1, 1e9},
    Unit{flow, "m^2/s", 1, 1},   // planar: per metre of depth
    Unit{resistance, "Pa s/m^3", 1, 1},
    Unit{resistance, "mmHg s/mL|mmHg s/ml|mmHg/(mL/s)|mmHg/(ml/s)", mmHg * 1e6, 1},
    Unit{resistance, "mmHg min/mL|mmHg min/ml|mmHg/(mL/min)|mmHg/(ml/min)", mmHg * 6e7, 1},
    Unit{resistance, "dyn s/cm^5", 1e5, 1},
    Unit{resistance, "Wood|mmHg min/L|mmHg min/l|mmHg/(L/min)|mmHg/(l/min)", mmHg * 6e4, 1},
    Unit{compliance, "m^3/Pa", 1, 1},
    Unit{compliance, "mL/mmHg|ml/mmHg", 1, mmHg * 1e6},
    Unit{compliance, "cm^5/dyn", 1, 1e5},
    Unit{frequency, "Hz|1/s", 1, 1},
    Unit{frequency, "1/min", 1, 60},
    Unit{angle, "rad", 1, 1},
    Unit{angle, "deg", std::numbers::pi, 180},
};

struct DimensionText {
    std::string_view name, example;
};
constexpr std::array<DimensionText, 17> dimension_texts{{
    {"number", "1.5"},
    {"length", "1 mm"},
    {"area", "1 mm^2"},
    {"time", "0.1 s"},
    {"velocity", "0.1 m/s"},
    {"acceleration", "9.81 m/s^2"},
    {"mass", "1 g"},
    {"density", "1060 kg/m^3"},
    {"pressure", "100 mmHg"},
    {"stiffness", "10 kPa/mm"},
    {"viscosity", "3.5 mPa s"},
    {"consistency", "0.017 Pa s^n"},
    {"flow", "60 mL/min"},
    {"resistance", "100 mmHg s/mL"},
    {"compliance", "0.01 mL/mmHg"},
    {"frequency", "1 Hz"},
    {"angle", "30 deg"},
}};

// What people and their word processors type for the same sign.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> same_signs{{
    {"\u00b5", "u"},
    {"\u03bc", "u"},   // micro sign, Greek mu
    {"\u00b2", "^2"},
    {"\u00b3", "^3"},
    {"\u2075", "^5"},
    {"\u207f", "^n"},   // superscripts
    {"\u00b7", " "},
    {"\u22c5", " "},
    {"\u2219", " "},
    {"*", " "},   // products
    {"\u2044", "/"},
    {"\u2215", "/"},   // fraction slash, division slash
    {"\u00a0", " "},
    {"\u2009", " "},
    {"\u202f", " "},   // no-break and thin spaces
    {"\u00b0", "deg"},
}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string with_plain_signs(std::string_view text) {
    std::string plain;
    while (!text.empty()) {
        std::string_view found, sign;
        for (const auto& [typed, meant] : same_signs)
            if (text.starts_with(typed)) found = typed, sign = meant;
        if (found.empty()) found = sign = text.substr(0, 1);
        plain += sign;
        text.remove_prefix(found.size());
    }
    return plain;
}

// "cm3 / s" -> "cm^3/s": one space between factors, none elsewhere, a ^ before every power.
std::string canonical_spelling(std::string_view spelling) {
    const std::string plain = with_plain_signs(trimmed(spelling));
    std::string result;
    bool space = false;
    for (const char c : plain) {
        const char last = result.empty() ? '/' : result.back();
        if (c == ' ' || c == '\t') {
            space = true;
            continue;
        }
        if (space && is_letter(c) && last != '/' && last != '(' && last != '^')
            result += ' ';
        else if (!space && is_digit(c) && is_letter(last))
            result += '^';
        space = false;
        result += c;
    }
    return result;
}

struct Parts {
    double value;
    std::string_view unit;
};

Parts split_number(std::string_view text) {
    const std::string_view whole = trimmed(text);
    const std::string shown = double_quoted(shortened(text));
    std::string_view rest = whole;
    if (rest.starts_with('+')) rest.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error == std::errc::result_out_of_range) throw DeckError(shown + " is beyond the range of numbers");
    // from_chars reads "nan", "inf", and "-+1" is no number
    if (error != std::errc() || (rest.size() < whole.size() && rest.starts_with('-')))
        throw DeckError(shown + " does not start with a number");
    if (!std::isfinite(value)) throw DeckError(shown + " is not a finite number");
    const std::string_view unit(end, std::size_t(rest.data() + rest.size() - end));
    if (unit.size() > 1 && unit[0] == ',' && is_digit(unit[1]))
        throw DeckError(shown + " has a decimal comma; write a point");
    return {value, unit};
}

double to_si(double value, const Unit& unit) { return value * unit.numerator / unit.denominator; }

const Unit& known_unit(std::string_view name) {
    const Unit* unit = find_unit(name);
    if (!unit) throw DeckError("there is no unit " + double_quoted(name));
    return *unit;
}

const Unit& si_unit(Dimension dimension) {
    for (const Unit& unit : table)
        if (unit.dimension == dimension) return unit;
    return table[0];
}

double round_digits(double value, int digits) {
    char text[64];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1);
    double rounded = 0;
    std::from_chars(text, end, rounded);
    return rounded;
}

}   // namespace

std::span<const Unit> units() { return table; }

std::vector<std::string> unit_names(Dimension dimension) {
    std::vector<std::string> names;
    for (const Unit& unit : table)
        if (unit.dimension == dimension) names.emplace_back(unit.name());
    return names;
}

std::string_view dimension_name(Dimension dimension) { return dimension_texts[std::size_t(dimension)].name; }

std::string dimension_phrase(Dimension dimension) {
    const std::string name(dimension_name(dimension));
    return (name[0] == 'a' ? "an " : "a ") + name;
}

std::string_view dimension_example(Dimension dimension) { return dimension_texts[std::size_t(dimension)].example; }

std::optional<Dimension> find_dimension(std::string_view name) {
    for (std::size_t i = 0; i < dimension_texts.size(); ++i)
        if (dimension_texts[i].name == name) return Dimension(i);
    return {};
}

const Unit* find_unit(std::string_view spelling) {
    const std::string wanted = canonical_spelling(spelling);
    for (const Unit& unit : table)
        for (const std::string& known : split(unit.spellings, '|'))
            if (known == wanted) return &unit;
    return nullptr;
}

double parse_number(std::string_view text) {
    const Parts parts = split_number(text);
    if (!trimmed(parts.unit).empty())
        throw DeckError(double_quoted(shortened(text)) + " is not a plain number; none but the number is needed here");
    return parts.value;
}

double parse_quantity(std::string_view text, Dimension dimension, std::string_view example) {
    if (dimension == number) return parse_number(text);
    const std::string needed = dimension_phrase(dimension) + " is needed, for example " +
                               double_quoted(example.empty() ? dimension_example(dimension) : example);
    const Parts parts = [&] {
        try {
            return split_number(text);
        } catch (const DeckError& e) {
            throw DeckError(std::string(e.what()) + "; " + needed);
        }
    }();
    const std::string_view spelling = trimmed(parts.unit);
    const std::string shown = shortened(trimmed(text));
    if (spelling.empty()) throw DeckError(shown + " has no unit; " + needed);
    const Unit* unit = find_unit(spelling);
    if (!unit) {
        const std::string near = nearest_name(spelling, unit_names(dimension));
        throw DeckError("there is no unit " + double_quoted(shortened(spelling)) +
                        (near.empty() ? "" : ". Did you mean " + double_quoted(near) + "?") + "; " + needed);
    }
    if (unit->dimension != dimension)
        throw DeckError(shown + " is " + dimension_phrase(unit->dimension) + "; " + needed);
    const double si = to_si(parts.value, *unit);
    if (!std::isfinite(si)) throw DeckError(shown + " is beyond the range of numbers; " + needed);
    return si;
}

double in_unit(double si, std::string_view unit) {
    const Unit& known = known_unit(unit);
    return si * known.denominator / known.numerator;
}

std::string format_number(double value) {
    char text[64];
    const double size = std::abs(value);
    const bool is_short = size == 0 || (size >= 1e-4 && size < 1e9);   // 100000 reads better than 1e+05
    const auto [end, error] = is_short ? std::to_chars(text, text + sizeof text, value, std::chars_format::fixed)
                                       : std::to_chars(text, text + sizeof text, value);
    return std::string(text, end);
}

std::string format_quantity(double si, std::string_view unit) {
    const Unit& known = known_unit(unit);
    if (known.dimension == number) return format_number(si);
    const double value = in_unit(si, unit);
    // Fewest digits first: 93 mmHg may be 92.999999999999986 after two roundings, and "93" gives the same double.
    for (int digits = 1; std::isfinite(value) && digits <= std::numeric_limits<double>::max_digits10; ++digits)
        if (const double rounded = round_digits(value, digits); to_si(rounded, known) == si)
            return format_number(rounded) + " " + std::string(known.name());
    return format_number(si) + " " + std::string(si_unit(known.dimension).name());
}

std::string quantity_pattern(Dimension dimension) {
    std::string alternatives;
    for (const Unit& unit : table) {
        if (unit.dimension != dimension) continue;
        for (const std::string& spelling : split(unit.spellings, '|')) {
            if (!alternatives.empty()) alternatives += '|';
            for (std::size_t i = 0; i < spelling.size(); ++i) {
                const char c = spelling[i];
                if (c == '^') {   // a power: with or without ^, or as a superscript
                    const char power = spelling[++i];
                    alternatives.append("(\\^?").append(1, power);
                    for (const auto& [typed, meant] : same_signs)
                        if (meant.size() == 2 && meant[0] == '^' && meant[1] == power)
                            alternatives.append("|").append(typed);
                    alternatives += ')';
                } else if (c == 'u' && spelling == "um") {
                    alternatives += "(u|\u00b5|\u03bc)";
                } else if (c == ' ') {
                    alternatives += "( |\\*|\u00b7|\u22c5)";
                } else if (c == '/') {
                    alternatives += "\\s*(/|\u2044|\u2215)\\s*";
                } else if (c == '(' || c == ')') {
                    alternatives += std::string("\\") + c;
                } else {
                    alternatives += c;
                }
            }
        }
    }
    if (dimension == angle) alternatives += "|\u00b0";
    return "^\\s*[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?\\s*(" + alternatives + ")\\s*$";
}

}   // namespace patency
