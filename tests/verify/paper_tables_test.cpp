// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/paper_tables.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace patency {
namespace {

TEST(PaperTables, StandBesideOursAndThePapersSchemeRunHere) {
    const auto figure = [](const char* key, double value) {
        return Figure{.key = key, .value = value, .unit = "percent", .bar = {}, .reason = ""};
    };
    const CaseReport plates{
        .name = "plates",
        .level = Level::full,
        .particles = 1,
        .figures = {figure("e", 0.1), figure("paper_e", 3.0), figure("paper_printed_e", 6.31), figure("other", 1)}};
    const CaseReport vessel{
        .name = "vessel", .level = Level::full, .particles = 1, .figures = {figure("paper_printed_v", 0.325)}};
    const CaseReport reports[] = {plates, vessel};
    const std::string table = paper_figures_table(reports);
    EXPECT_NE(table.find("| [plates](#plates) | `e` | percent | 6.31 | 3 | 0.1 |\n"), std::string::npos) << table;
    EXPECT_NE(table.find("| [vessel](#vessel) | `v` | percent | 0.325 | – | – |\n"), std::string::npos) << table;
    EXPECT_EQ(table.find("other"), std::string::npos);
}

TEST(PaperTables, TableSixHasThePapersSignsAndTheWorstLesion) {
    const auto run = nlohmann::ordered_json::parse(R"({
        "before": {"openings": {"inlet": {"flow_m3_per_s": -3.9e-6, "mean_velocity_m_per_s": -0.315}, "outlet_small": {"flow_m3_per_s": 0.4e-6}},
                   "lesions": [{"ffr": 0.9, "flow_m3_per_s": 9e-6}, {"ffr": 0.5, "flow_m3_per_s": 0.8e-6, "gauge_pressure_ratio": 0.47}]},
        "after": {"at_lesions": [{}, {"flow_m3_per_s": 1.1e-6}]}})");
    const std::string table = paper_table_six(run);
    EXPECT_NE(table.find("| 0.315 | 0.315 | 0.315 | – |\n"), std::string::npos) << table;
    EXPECT_NE(table.find("| 3.92 | 3.93 | 3.900 | – |\n"), std::string::npos) << table;
    EXPECT_NE(table.find("| -0.36 | -0.518 | -0.400 | – |\n"), std::string::npos) << table;
    EXPECT_NE(table.find("| 0.85 | 1.15 | 0.800 | 1.100 |\n"), std::string::npos) << table;
    EXPECT_NE(table.find("| 0.45 | 0.91 | 0.470 | – |\n"), std::string::npos) << table;
}

}   // namespace
}   // namespace patency
