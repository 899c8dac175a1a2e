// SPDX-License-Identifier: Apache-2.0
#include "patency/io/flow_table.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

Json opening(double flow, double pressure) {
    return {{"flow_m3_per_s", flow}, {"mean_pressure_pa", pressure}, {"mean_velocity_m_per_s", 0.315}};
}

TEST(FlowTable, SpeaksInClinicalUnits) {
    Json summary{{"openings", {{"inlet", opening(-1e-6, 13332.2387415)}}}, {"mass_imbalance_percent", 0.0123}};
    const std::string text = flow_table(summary);
    EXPECT_NE(text.find("-60.00"), std::string::npos) << text;    // mL/min
    EXPECT_NE(text.find("100.000"), std::string::npos) << text;   // mmHg
    EXPECT_NE(text.find("0.3150"), std::string::npos) << text;
    EXPECT_NE(text.find("0.012 %"), std::string::npos) << text;
    EXPECT_EQ(text.find("lesion"), std::string::npos) << text;
}

TEST(FlowTable, MarksWhatIsUnderResolvedAndLeavesOutWhatIsNotThere) {
    const Json lesion{{"branch", "lad"},          {"throat_arc_mm", 24.0},         {"diameter_stenosis_percent", 39.4},
                      {"flow_m3_per_s", 1e-6},    {"drop_pa", 133.322387415},      {"estimated_drop_pa", 266.64477483},
                      {"ffr", nullptr},           {"gauge_pressure_ratio", 0.456}, {"particles_across", 5.0},
                      {"is_under_resolved", true}};
    const std::string text = flow_table({{"lesions", {lesion}}, {"branches", {{{"name", "side"}}}}});
    EXPECT_NE(text.find("lad"), std::string::npos) << text;
    EXPECT_NE(text.find("drop 1.000 mmHg (estimate 2.000)"), std::string::npos) << text;
    EXPECT_NE(text.find("FFR -,"), std::string::npos) << text;
    EXPECT_NE(text.find("under-resolved"), std::string::npos) << text;
    EXPECT_EQ(text.find("side"), std::string::npos) << text;   // a branch without a section has no row
    EXPECT_TRUE(flow_table(Json::object()).empty());
}

}   // namespace
}   // namespace patency
