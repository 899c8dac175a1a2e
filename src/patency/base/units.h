// SPDX-License-Identifier: Apache-2.0
// Quantities as text, "93 mmHg", to SI numbers and back, with the dimension checked. The list of units is
// closed on purpose: a unit that is not on it is a mistake with a suggestion, never a guess.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patency {

enum class Dimension {
    number,         ///< no unit
    length,         ///< m
    area,           ///< m^2
    time,           ///< s
    velocity,       ///< m/s
    acceleration,   ///< m/s^2
    mass,           ///< kg
    density,        ///< kg/m^3
    pressure,       ///< Pa; stresses too
    stiffness,      ///< Pa/m, of a bedding
    viscosity,      ///< Pa s
    consistency,    ///< Pa s^n, of a power law
    flow,           ///< m^3/s; m^2/s in planar cases, per metre of depth
    resistance,     ///< Pa s/m^3
    compliance,     ///< m^3/Pa
    frequency,      ///< Hz
    angle,          ///< rad
};

/// A unit: SI = number * numerator / denominator. Two factors, because both are exact decimals while
/// their ratio (1/60000 for L/min) is not.
struct Unit {
    Dimension dimension;
    std::string_view spellings;   ///< "|" between them; the first is the one we write
    double numerator, denominator;

    std::string_view name() const { return spellings.substr(0, spellings.find('|')); }
};

/// All units; the first of each dimension is SI.
std::span<const Unit> units();
std::vector<std::string> unit_names(Dimension dimension);

std::string_view dimension_name(Dimension dimension);      ///< "pressure"
std::string dimension_phrase(Dimension dimension);         ///< "a pressure", "an acceleration"
std::string_view dimension_example(Dimension dimension);   ///< "100 mmHg"
std::optional<Dimension> find_dimension(std::string_view name);

/// The unit of that spelling, or nullptr. "cm³/s", "cm3/s", "cm^3 / s" are one; so are "mPa·s", "mPa*s"
/// and "mPa s". Upper and lower case differ (mPa, MPa), except the litre's l.
const Unit* find_unit(std::string_view spelling);

/// A number without a unit; throws DeckError if the text is anything else, or not finite.
double parse_number(std::string_view text);

/// The SI value of a text like "93 mmHg". Throws DeckError with a sentence: not a number, no unit, an
/// unknown unit (with the nearest), another dimension (with `example`, else the dimension's own example).
double parse_quantity(std::string_view text, Dimension dimension, std::string_view example = {});

/// The shortest text in that unit from which parse_quantity gives the same double; in SI if there is none
/// in that unit. The unit must be one of units(), or empty for a number: throws DeckError else.
std::string format_quantity(double si, std::string_view unit);

/// The shortest decimal text of a number that reads back to the same double.
std::string format_number(double value);

/// An SI value in a unit of units(), for reports.
double in_unit(double si, std::string_view unit);

/// A regular expression (ECMAScript) for the texts parse_quantity accepts for this dimension.
std::string quantity_pattern(Dimension dimension);

}   // namespace patency
