// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/materials_summary.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "patency/config/deck.h"

namespace patency {
namespace {

nlohmann::ordered_json materials(const deck::Settings& settings) {
    return materials_summary(
        deck::read_case(std::filesystem::path(PATENCY_SOURCE_DIR) / "cases/coronary_bifurcation.yaml", settings));
}

TEST(MaterialsSummary, OfAFlowIsTheBloods) {
    const auto blood = materials({});
    ASSERT_EQ(blood.size(), 1u);
    EXPECT_EQ(blood[0]["what"], "newtonian");
    EXPECT_EQ(blood[0]["source"], "the deck");
    EXPECT_EQ(blood[0]["density_kg_per_m3"], 1060);
    EXPECT_EQ(blood[0]["viscosity_pa_s"], 3.5e-3);
    const auto casson =
        materials({"blood={density: 1050 kg/m^3, law: casson, yield_stress: 0.005 Pa, plastic_viscosity: 3.5 mPa s, "
                   "max_viscosity: 100 mPa s}"});
    EXPECT_NEAR(casson[0]["yield_stress_mpa"].get<double>(), 5e-9, 1e-20);
}

TEST(MaterialsSummary, OfADeploymentNamesTheSourcesOfTheTable) {
    const auto all = materials({"stent={design: paper, alloy: 316L}"});
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[1]["part"], "wall");
    EXPECT_NE(all[1]["source"].get<std::string>().find("arXiv 2511.08745"), std::string::npos);
    EXPECT_NEAR(all[1]["young_mpa"].get<double>(), 1, 1e-9);
    EXPECT_NEAR(all[1]["poisson"].get<double>(), 0.45, 1e-9);
    EXPECT_EQ(all[2]["part"], "stent");
    EXPECT_NE(all[2]["source"].get<std::string>().find("ASTM F138"), std::string::npos);
    EXPECT_NEAR(all[2]["yield_stress_mpa"].get<double>(), 172, 1e-9);
    EXPECT_EQ(materials({"stent={design: paper}", "deployment={mode: geometric}"}).size(), 1u);   // no mechanics
}

TEST(MaterialsSummary, SaysWhatTheDeckChanged) {
    const auto all = materials({"stent={design: paper, alloy: 316L, material: {name: 316L, yield_stress: 300 MPa}}",
                                "wall={layers: {adventitia_share: 0.3, adventitia: {law: neo_hookean, density: 1100 "
                                "kg/m^3, young: 2 MPa, poisson: 0.4}}}"});
    ASSERT_EQ(all.size(), 4u);
    EXPECT_EQ(all[1]["part"], "media");
    EXPECT_EQ(all[2]["part"], "adventitia");
    EXPECT_EQ(all[2]["what"], "neo_hookean");
    EXPECT_EQ(all[2]["source"], "the deck");
    EXPECT_TRUE(all[3]["source"].get<std::string>().ends_with("; with numbers of the deck"));
    EXPECT_NEAR(all[3]["yield_stress_mpa"].get<double>(), 300, 1e-9);
}

}   // namespace
}   // namespace patency
