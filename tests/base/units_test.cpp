// SPDX-License-Identifier: Apache-2.0
#include "patency/base/units.h"

#include <cmath>
#include <numbers>
#include <random>
#include <regex>

#include <gtest/gtest.h>

#include "patency/base/errors.h"

namespace patency {
namespace {

constexpr int dimension_count = int(Dimension::angle) + 1;

std::string refusal(std::string_view text, Dimension dimension) {
    try {
        parse_quantity(text, dimension);
    } catch (const DeckError& e) {
        return e.what();
    }
    return "accepted";
}

TEST(Units, TheFirstOfEachDimensionIsSI) {
    for (int d = 0; d < dimension_count; ++d) {
        const std::vector<std::string> names = unit_names(Dimension(d));
        ASSERT_FALSE(names.empty());
        const Unit* unit = find_unit(names[0]);
        EXPECT_EQ(unit->numerator, 1);
        EXPECT_EQ(unit->denominator, 1);
    }
}

// Each dimension's example is one of its quantities; so names, examples and units stand in the same order.
TEST(Units, EveryDimensionKnowsItsExampleAndName) {
    for (int d = 1; d < dimension_count; ++d) {
        EXPECT_NO_THROW(parse_quantity(dimension_example(Dimension(d)), Dimension(d))) << d;
        EXPECT_EQ(find_dimension(dimension_name(Dimension(d))), Dimension(d));
    }
    EXPECT_FALSE(find_dimension("rcr"));
}

TEST(Units, ASpellingNamesOneUnit) {
    for (const Unit& unit : units()) EXPECT_EQ(find_unit(unit.name()), &unit) << unit.name();
}

// Every pair is worked out by hand from the definitions: mL = 1e-6 m^3, min = 60 s, dyn = 1e-5 N, P = 0.1 Pa s,
// mmHg = 133.322387415 Pa, Wood = 1 mmHg min/L.
TEST(Units, ConversionsFollowTheDefinitions) {
    const auto si = [](std::string_view text, Dimension d) { return parse_quantity(text, d); };
    EXPECT_DOUBLE_EQ(si("93 mmHg", Dimension::pressure), 93 * 133.322387415);
    EXPECT_DOUBLE_EQ(si("760 mmHg", Dimension::pressure) / si("1 atm", Dimension::pressure),
                     760 * 133.322387415 / 101325);
    EXPECT_DOUBLE_EQ(si("10 dyn/cm^2", Dimension::pressure), 1);
    EXPECT_DOUBLE_EQ(si("1 bar", Dimension::pressure), 1e5);
    EXPECT_DOUBLE_EQ(si("2 um", Dimension::length), 2e-6);
    EXPECT_DOUBLE_EQ(si("0.2 mm", Dimension::length), 0.0002);
    EXPECT_DOUBLE_EQ(si("1 g/mL", Dimension::density), 1000);
    EXPECT_DOUBLE_EQ(si("3.5 cP", Dimension::viscosity), 0.0035);
    EXPECT_DOUBLE_EQ(si("1 P", Dimension::viscosity), 0.1);
    EXPECT_DOUBLE_EQ(si("60 mL/min", Dimension::flow), 1e-6);
    EXPECT_DOUBLE_EQ(si("0.06 L/min", Dimension::flow), 1e-6);
    EXPECT_DOUBLE_EQ(si("1000 mm^3/s", Dimension::flow), 1e-6);
    EXPECT_DOUBLE_EQ(si("3 m^2/s", Dimension::flow), 3);
    EXPECT_DOUBLE_EQ(si("1 mmHg s/mL", Dimension::resistance), 133.322387415e6);
    EXPECT_DOUBLE_EQ(si("1 mmHg min/mL", Dimension::resistance), 133.322387415e6 * 60);
    EXPECT_DOUBLE_EQ(si("1 Wood", Dimension::resistance), 133.322387415 * 60 / 1e-3);
    EXPECT_DOUBLE_EQ(si("1 dyn s/cm^5", Dimension::resistance), 1e-5 / 1e-10);
    EXPECT_DOUBLE_EQ(si("1 mL/mmHg", Dimension::compliance), 1e-6 / 133.322387415);
    EXPECT_DOUBLE_EQ(si("1 cm^5/dyn", Dimension::compliance), 1e-10 / 1e-5);
    EXPECT_DOUBLE_EQ(si("72 1/min", Dimension::frequency), 1.2);
    EXPECT_DOUBLE_EQ(si("180 deg", Dimension::angle), std::numbers::pi);
    EXPECT_DOUBLE_EQ(si("0.5 min", Dimension::time), 30);
}

TEST(Units, SpellingsOfOneUnitAreOne) {
    for (const char* text :
         {"7 cm^3/s", "7 cm³/s", "7 cm3/s", "7cm^3 / s", "7 cm ^3/s", " 7 mL/s ", "7 ml/s", "+7 cm³∕s"})
        EXPECT_DOUBLE_EQ(parse_quantity(text, Dimension::flow), 7e-6) << text;
    for (const char* text :
         {"4 mPa s", "4 mPa·s", "4 mPa⋅s", "4 mPa*s", "4 mPa * s", "4\u00a0mPa\u00a0s", "4e0 mPa  s"})
        EXPECT_DOUBLE_EQ(parse_quantity(text, Dimension::viscosity), 0.004) << text;
    for (const char* text : {"5 um", "5 µm", "5 μm", "5μm"})
        EXPECT_DOUBLE_EQ(parse_quantity(text, Dimension::length), 5e-6) << text;
    EXPECT_DOUBLE_EQ(parse_quantity("30°", Dimension::angle), std::numbers::pi / 6);
    EXPECT_DOUBLE_EQ(parse_quantity("1 mmHg/(mL/s)", Dimension::resistance), 133322387.415);
}

TEST(Units, LettersOfDifferentSizeDiffer) {
    EXPECT_DOUBLE_EQ(parse_quantity("1 MPa", Dimension::pressure), 1e6);
    EXPECT_EQ(find_unit("mPa"), nullptr);
    EXPECT_EQ(refusal("1 mmhg", Dimension::pressure),
              "there is no unit \"mmhg\". Did you mean \"mmHg\"?; a pressure is needed, for example \"100 mmHg\"");
}

TEST(Units, ARefusalSaysWhatIsNeeded) {
    EXPECT_EQ(refusal("100 mm", Dimension::pressure),
              "100 mm is a length; a pressure is needed, for example \"100 mmHg\"");
    EXPECT_EQ(refusal("9.81 m/s^2", Dimension::time),
              "9.81 m/s^2 is an acceleration; a time is needed, for example \"0.1 s\"");
    EXPECT_EQ(refusal("5", Dimension::length), "5 has no unit; a length is needed, for example \"1 mm\"");
    EXPECT_EQ(refusal("0", Dimension::length), "0 has no unit; a length is needed, for example \"1 mm\"");
    for (const char* text :
         {"", " ", "mm", "- 5 mm", "+-5 mm", "--5 mm", "five mm", "0x1F mm", "1..2 mm", "1e mm", "1e5e5 mm", "1 2 mm"})
        EXPECT_NE(refusal(text, Dimension::length), "accepted") << text;
    for (const char* text : {"nan mm", "inf mm", "-inf mm", "1e999 mm"})
        EXPECT_NE(refusal(text, Dimension::length), "accepted") << text;
    EXPECT_NE(refusal("1e308 g/cm^3", Dimension::density), "accepted") << "overflows in SI";
    EXPECT_NE(refusal("1,5 mm", Dimension::length).find("decimal comma"), std::string::npos);
    EXPECT_NE(refusal(std::string(100000, '9') + " furlongs", Dimension::length), "accepted");
}

TEST(Units, NumbersHaveNoUnit) {
    EXPECT_EQ(parse_number("-1.5e3"), -1500);
    EXPECT_THROW(parse_number("1 mm"), DeckError);
    EXPECT_THROW(parse_number("nan"), DeckError);
}

// The law of a resolved deck: text in any unit gives back the same bits.
TEST(Units, FormatAndParseAreInverseInEveryUnit) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> exponent(-12, 12), sign(-1, 1);
    for (const Unit& unit : units()) {
        for (int i = 0; i < 500; ++i) {
            const double value = std::copysign(std::pow(10, exponent(random)), sign(random));
            const std::string text = format_quantity(value, unit.name());
            ASSERT_EQ(parse_quantity(text, unit.dimension), value) << text;
        }
    }
}

TEST(Units, FormatGivesTheShortText) {
    EXPECT_EQ(format_quantity(parse_quantity("93 mmHg", Dimension::pressure), "mmHg"), "93 mmHg");
    EXPECT_EQ(format_quantity(0.0002, "mm"), "0.2 mm");
    EXPECT_EQ(format_quantity(1060, "kg/m^3"), "1060 kg/m^3");
    EXPECT_EQ(format_quantity(10, "mm"), "10000 mm");
    EXPECT_EQ(format_quantity(0, "Wood"), "0 Wood");
    EXPECT_EQ(format_quantity(1.25, ""), "1.25");
    EXPECT_EQ(format_number(100000), "100000");
    EXPECT_EQ(format_number(1e-9), "1e-09");
    EXPECT_DOUBLE_EQ(in_unit(1e-6, "mL/min"), 60);
    EXPECT_THROW(format_quantity(1, "furlong"), DeckError);
}

// The schema's pattern and the parser agree, on spellings and on what is neither.
TEST(Units, PatternsAcceptWhatIsParsed) {
    for (int d = 1; d < dimension_count; ++d) {
        const std::regex pattern(quantity_pattern(Dimension(d)));
        for (const Unit& unit : units()) {
            for (const std::string number : {"1 ", "-2.5e-3 ", " .5  ", "+3. "}) {
                const std::string text = number + std::string(unit.name());
                const bool is_parsed = refusal(text, Dimension(d)) == "accepted";
                EXPECT_EQ(std::regex_match(text, pattern), is_parsed) << text << " as " << dimension_name(Dimension(d));
                EXPECT_EQ(is_parsed, unit.dimension == Dimension(d)) << text;
            }
        }
    }
    EXPECT_TRUE(std::regex_match("7 cm³/s", std::regex(quantity_pattern(Dimension::flow))));
    EXPECT_TRUE(std::regex_match("7 mPa·s", std::regex(quantity_pattern(Dimension::viscosity))));
    EXPECT_TRUE(std::regex_match("30°", std::regex(quantity_pattern(Dimension::angle))));
    EXPECT_TRUE(std::regex_match("7 µm", std::regex(quantity_pattern(Dimension::length))));
}

}   // namespace
}   // namespace patency
