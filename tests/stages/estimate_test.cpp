// SPDX-License-Identifier: Apache-2.0
// The estimate of the bifurcation that comes with the program: its network, a lesion of 39 % in the branch to two outlets.
#include "patency/stages/estimate.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/stages/estimate_results.h"

namespace patency {
namespace {

deck::Case deck_of(const deck::Settings& settings = {}) {
    return deck::read_case(std::filesystem::path(PATENCY_SOURCE_DIR) / "cases/coronary_bifurcation.yaml", settings);
}

/// With an aortic pressure at the inlet and beds behind all outlets.
deck::Case hyperaemic() {
    deck::Case config = deck_of();
    config.aorta.pressure = 12400;
    config.openings["inlet"] = {};
    config.openings["inlet"].pressure = 12400;
    for (const char* name : {"outlet_large", "outlet_medium", "outlet_small"}) {
        config.openings[name] = {};
        config.openings[name].type = deck::OpeningType::resistance;
    }
    return config;
}

const Vessel& bifurcation() {
    static const Vessel vessel = read_vessel(deck_of());
    return vessel;
}
const Vessel& severe() {
    static const Vessel vessel = [] {
        deck::Case config = deck_of();
        config.geometry.lesion->diameter_stenosis_percent = 70;
        return read_vessel(config);
    }();
    return vessel;
}

TEST(Estimate, KnowsTheNetworksBranchesOpeningsAndLesion) {
    const Vessel& v = bifurcation();
    ASSERT_EQ(v.openings.size(), 4u);
    EXPECT_EQ(v.openings[0].opening.name, "inlet");
    ASSERT_EQ(v.along->lines.branches.size(), 5u);
    EXPECT_EQ(v.along->lines.branches[0].name, "left_main");
    ASSERT_EQ(v.along->assessment.lesions.size(), 1u);
    EXPECT_NEAR(100 * v.along->assessment.lesions[0].diameter_stenosis, 39.4, 1);
}

TEST(Estimate, FlowsAddUpAndPressureFallsToTheOutlets) {
    const Estimate e = estimate_flow(deck_of(), bifurcation());
    EXPECT_NEAR(std::accumulate(e.opening_flows.begin(), e.opening_flows.end(), 0.0), 0, 1e-14);
    EXPECT_NEAR(e.opening_flows[0], -0.315 * bifurcation().openings[0].opening.area, 1e-15);
    for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_GT(e.opening_flows[k], 0);
        EXPECT_LT(e.opening_pressures[k], e.opening_pressures[0]);
    }
    EXPECT_FALSE(e.lesions[0].ffr);   // no aortic pressure, no FFR
    EXPECT_GT(e.lesions[0].drop, 0);
}

TEST(Estimate, ASevererLesionTakesFlowAndFfr) {
    const Estimate mild = estimate_flow(hyperaemic(), bifurcation()), bad = estimate_flow(hyperaemic(), severe());
    EXPECT_NEAR(mild.opening_pressures[0], 12400, 1e-6);
    EXPECT_GT(*mild.lesions[0].ffr, 0.95);   // a 39 % stenosis limits nothing
    EXPECT_LT(*bad.lesions[0].ffr, *mild.lesions[0].ffr - 0.02);
    EXPECT_LT(bad.lesions[0].flow, mild.lesions[0].flow);
    EXPECT_GT(bad.opening_flows[1], 0.99 * mild.opening_flows[1]);   // the other side keeps its own
}

TEST(Estimate, AnAorticPressureIsALevelOnly) {
    deck::Case config = deck_of();
    config.aorta.pressure = 12400;
    const Estimate with = estimate_flow(config, bifurcation()), without = estimate_flow(deck_of(), bifurcation());
    EXPECT_DOUBLE_EQ(with.opening_pressures[0], without.opening_pressures[0]);
    EXPECT_NEAR(*with.ffr(0, 0), 1, 1e-12);
    EXPECT_NEAR(*with.lesions[0].ffr, 1 - (with.opening_pressures[0] - with.flow.pressure[2].back()) / 12400, 0.01);
}

TEST(Estimate, TheBandHoldsTheEstimateAndTheNarrowerLumenIsWorse) {
    const deck::Case config = hyperaemic();
    const Estimate e = estimate_flow(config, severe());
    const EstimateBand band = estimate_band(config, severe());
    ASSERT_EQ(band.lesion_ffr.size(), 1u);
    EXPECT_LT(band.lesion_ffr[0].low, *e.lesions[0].ffr);
    EXPECT_GT(band.lesion_ffr[0].high, *e.lesions[0].ffr);
    EXPECT_LT(*estimate_flow(config, severe(), {1, -0.1e-3, 0}).lesions[0].ffr, *e.lesions[0].ffr);
    EXPECT_LT(*estimate_flow(config, severe(), {1.1, 0, 0}).lesions[0].ffr, *e.lesions[0].ffr);
}

/// What stands beside the project, if it does.
std::optional<nlohmann::json> finite_volumes(const char* name) {
    std::ifstream file(std::filesystem::path(PATENCY_SOURCE_DIR) / "../shared/reference" / name);
    return file ? std::optional(nlohmann::json::parse(file)) : std::nullopt;
}

TEST(Estimate, TheBifurcationsFlowsAndPressureAreNearFiniteVolumes) {
    const auto reference = finite_volumes("coronary_bifurcation/finite_volume_before.json");
    if (!reference) GTEST_SKIP() << "../shared is not here";
    const Estimate e = estimate_flow(deck_of(), bifurcation());
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string name = bifurcation().openings[k].opening.name;
        EXPECT_NEAR(e.opening_flows[k] / double((*reference)["openings"][name]["flow_out_m3_per_s"]), 1, 0.06) << name;
    }
    EXPECT_NEAR(e.opening_pressures[0] / double((*reference)["openings"]["inlet"]["mean_pressure_pa"]), 1, 0.03);
    const double before = (*reference)["sections"]["anterior_descending"][4]["mean_pressure_pa"],
                 behind = (*reference)["sections"]["anterior_descending"][14]["mean_pressure_pa"];
    EXPECT_NEAR(e.lesions[0].drop / (before - behind), 1, 0.1);
}

TEST(Estimate, APatientsTreeLosesWhatFiniteVolumesSayToEveryOutlet) {
    const auto reference = finite_volumes("left_coronary_tree/finite_volume.json");
    if (!reference) GTEST_SKIP() << "../shared is not here";
    const deck::Case config =
        deck::read_case(std::filesystem::path(PATENCY_SOURCE_DIR) / "cases/verify/cells_left_coronary_tree.yaml", {});
    const Vessel vessel = read_vessel(config);
    const Estimate e = estimate_flow(config, vessel);
    int compared = 0;
    for (std::size_t k = 1; k < vessel.openings.size(); ++k)
        for (const auto& [cap, o] : (*reference)["openings"].items())
            if (norm(vessel.openings[k].opening.centre -
                     1e-3 * Vec3{o["centre_mm"][0], o["centre_mm"][1], o["centre_mm"][2]}) < 0.5e-3) {
                EXPECT_NEAR((e.opening_pressures[0] - e.opening_pressures[k]) / double(o["drop_from_inlet_pa"]), 1,
                            0.08)
                    << cap;
                ++compared;
            }
    EXPECT_EQ(compared, 6);
}

TEST(Estimate, SaysWhichOpeningTheDeckForgot) {
    deck::Case config = deck_of();
    config.openings.erase("outlet_small");
    try {
        estimate_flow(config, bifurcation());
        ADD_FAILURE();
    } catch (const DeckError& error) {
        EXPECT_NE(std::string(error.what()).find("outlet_small"), std::string::npos) << error.what();
    }
}

TEST(Estimate, ItsNumbersStandInTheSummaryAndThePullbacks) {
    const deck::Case config = hyperaemic();
    const Estimate e = estimate_flow(config, bifurcation());
    const auto summary = estimate_summary(config, bifurcation(), e, estimate_band(config, bifurcation()));
    EXPECT_EQ(summary["openings"]["outlet_small"]["flow_m3_per_s"], e.opening_flows[3]);
    EXPECT_EQ(summary["ffr"]["lesion"], *e.lesions[0].ffr);
    EXPECT_EQ(summary["lesions"][0]["ffr_band"].size(), 2u);
    const Pullback p = estimate_pullback(bifurcation(), e);
    EXPECT_EQ(p.columns.back(), "ffr");
    int outlets = 0;
    for (std::size_t k = 0; k < p.rows.size(); ++k) {
        if (k > 0 && p.rows[k][1] == p.rows[k - 1][1]) {
            EXPECT_GT(p.rows[k][0], p.rows[k - 1][0]);
            continue;
        }
        EXPECT_EQ(p.rows[k][1], ++outlets);
        EXPECT_NEAR(p.rows[k].back(), 1, 1e-6);   // every line begins at the aorta
    }
    EXPECT_EQ(outlets, 3);
}

}   // namespace
}   // namespace patency
