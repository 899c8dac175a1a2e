// SPDX-License-Identifier: Apache-2.0
#include "patency/report/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

const Json& summary() {
    static const Json json =
        Json::parse(R"({"before": {"drop_pa": 1333.22387415, "ffr": 0.8049, "text": "<b>", "none": null, "flow": -4e-6,
                                             "small": -0.0004, "openings": {"a/b~c\"": {"flow": 1e-6}}}})");
    return json;
}

TEST(Figures, TextCannotBecomeMarkup) {
    EXPECT_EQ(escaped("<a href='x' title=\"y\">&amp;</a>"),
              "&lt;a href=&#39;x&#39; title=&quot;y&quot;&gt;&amp;amp;&lt;/a&gt;");
    EXPECT_EQ(escaped("µ → é"), "µ → é");
    EXPECT_EQ(Figures(summary()).text("/before/text"), "&lt;b&gt;");
    EXPECT_EQ(Figures(summary()).text("/before/ffr"), "");
}

TEST(Figures, CarryWhereTheyComeFrom) {
    const Figures f(summary());
    EXPECT_EQ(f.number("/before/ffr", {"", 1, 2}),
              "<data value=\"0.8049\" data-path=\"/before/ffr\" data-scale=\"1\" data-digits=\"2\">0.80</data>");
    EXPECT_NE(f.with_unit("/before/drop_pa", as_mmHg).find(">10.00</data><span class=\"unit\"> mmHg</span>"),
              std::string::npos);
    EXPECT_NE(f.scientific("/before/flow", 2, -1).find("data-scale=\"-1\" data-digits=\"e2\">4.00e-06<"),
              std::string::npos);
    EXPECT_NE(f.ratio("/before/openings/a~1b~0c\"/flow", "/before/flow", {"%", -100, 1}).find(">25.0<"),
              std::string::npos);
}

TEST(Figures, WhatIsNotThereIsADash) {
    const Figures f(summary());
    for (const char* pointer : {"/before/none", "/before/text", "/after/ffr", "/before/ffr/deeper"}) {
        EXPECT_FALSE(f.has(pointer)) << pointer;
        EXPECT_EQ(f.number(pointer, as_mm), "<span class=\"none\">–</span>") << pointer;
    }
    EXPECT_EQ(f.ratio("/before/ffr", "/before/none", as_percent), "<span class=\"none\">–</span>");
}

TEST(Figures, AZeroHasNoSign) {
    EXPECT_NE(Figures(summary()).number("/before/small", {"", 1, 2}).find(">0.00<"), std::string::npos);
    EXPECT_NE(Figures(summary()).number("/before/small", {"", 1, 4}).find(">-0.0004<"), std::string::npos);
}

TEST(Figures, PointersTakeAnyKey) {
    EXPECT_EQ(step("a/b~c"), "/a~1b~0c");
    EXPECT_TRUE(Figures(summary()).has("/before/openings" + step("a/b~c\"") + "/flow"));
}

TEST(Figures, KeysSayTheirUnit) {
    EXPECT_EQ(measure_of("recoil_percent").unit, "%");
    EXPECT_EQ(measure_of("drift_percent").digits, 3) << "0.05 is much of it";
    EXPECT_EQ(words_of("drift_percent"), "Drift");
    EXPECT_EQ(measure_of("minimum_diameter_mm").unit, "mm");
    EXPECT_EQ(measure_of("flow_m3_per_s").unit, "mL/min");
    EXPECT_EQ(measure_of("velocity_m_per_s").unit, "m/s");
    EXPECT_EQ(measure_of("largest_von_mises_pa").unit, "kPa");
    EXPECT_EQ(measure_of("kinetic_to_internal").unit, "");
    EXPECT_EQ(words_of("largest_von_mises_pa"), "Largest von Mises stress");
    EXPECT_EQ(words_of("kinetic_to_internal_wall"), "Kinetic over internal energy, wall");
    EXPECT_EQ(lower_words_of("recoil_percent"), "recoil");
    EXPECT_EQ(measure_of("largest_tool_pressure_pa").unit, "atm");
    EXPECT_EQ(words_of("largest_tool_pressure_pa"), "Largest tool pressure");
    EXPECT_DOUBLE_EQ(4e-6 * measure_of("flow_m3_per_s").scale, 240);
    EXPECT_DOUBLE_EQ(2e-3 * measure_of("largest_displacement_m").scale, 2);
}

TEST(Figures, PressuresAreShownInAUnitOfTheirSize) {
    const Measure kilopascals = measure_of("contact_pressure_pa");
    EXPECT_EQ(at_size(kilopascals, 9e6).unit, "kPa");
    EXPECT_EQ(at_size(kilopascals, 9e6).digits, 0);
    EXPECT_EQ(at_size(kilopascals, 5e3).digits, 2);
    EXPECT_EQ(at_size(kilopascals, 496e6).unit, "MPa");
    EXPECT_DOUBLE_EQ(496e6 * at_size(kilopascals, 496e6).scale, 496);
    EXPECT_EQ(at_size(measure_of("young_mpa"), 243'000).unit, "GPa");
    EXPECT_DOUBLE_EQ(243'000 * at_size(measure_of("young_mpa"), 243'000).scale, 243);
    EXPECT_EQ(at_size(as_mm, 5'000).unit, "mm");
    EXPECT_EQ(at_size(as_mm, 0.0325).digits, 3);
    EXPECT_EQ(at_size(as_mm, 0).digits, 2);
    EXPECT_EQ(at_size(kilopascals, NAN).unit, "kPa");
}

}   // namespace
}   // namespace patency
