// SPDX-License-Identifier: Apache-2.0
// patency init from outside: its deck goes through check and estimate as it is; what it refuses; and the vessels that
// others published.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/io/csv.h"
#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "tests/app/program.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

class Init : public ::testing::Test {
protected:
    std::string tube(const char* name = "vessel.vtp") {
        write_surface(folder_ / name,
                      make_tube_mesh({.radius = 1.5e-3, .length = 12e-3, .start_cap = true, .end_cap = true}));
        return (folder_ / name).string();
    }
    std::string deck() const { return (folder_ / "case.yaml").string(); }
    ScratchFolder folder_;
};

TEST_F(Init, ItsDeckGoesThroughCheckAndEstimate) {
    const Result result =
        patency(fmt::format("init '{}' --unit mm --budget 1min -o {}", tube("my vessel #1.vtp"), deck()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    for (const char* word : {"outlet_1", "Lesions: none", "for a budget of 60 s", "Written: "})
        EXPECT_TRUE(has(result.output, word)) << word;
    const Result check = patency("check " + deck());
    EXPECT_EQ(check.exit_code, 0) << check.output;
    const Result estimate = patency(fmt::format("estimate {} -o {}", deck(), (folder_ / "out").string()));
    EXPECT_EQ(estimate.exit_code, 0) << estimate.output;
    // From another folder too: the path is relative to the deck.
    EXPECT_TRUE(has(contents_of(deck()), "surface: \"my vessel #1.vtp\""));
    // The bed takes 0.279 m/s through 3 mm.
    EXPECT_NEAR(read_summary(folder_ / "out/summary.json")["openings"]["outlet_1"]["flow_m3_per_s"].get<double>(),
                0.279 * M_PI * 2.25e-6, 2e-8);
}

TEST_F(Init, OfAHeartThatBeatsPulsesAndRepeatsSoon) {
    ASSERT_EQ(patency(fmt::format("init {} --unit mm --heart-rate 75 -o {}", tube(), deck())).exit_code, 0);
    const std::string text = contents_of(deck());
    for (const char* line : {"mode: periodic", "period: \"0.8 s\"", "outlet_1: {type: coronary}", "pulse: \"40 mmHg\""})
        EXPECT_TRUE(has(text, line)) << line;
    const Result check = patency("check " + deck());
    EXPECT_EQ(check.exit_code, 0) << check.output;
    const Result flow = patency(fmt::format("flow {} --set numerics.across=5 --set numerics.steps_per_period=80 -o {}",
                                            deck(), (folder_ / "out").string()));
    ASSERT_EQ(flow.exit_code, 0) << flow.output;
    const auto summary = read_summary(folder_ / "out/summary.json");
    // A linear bed takes at the mean pressure what it was tuned to, and begins in the beat that it repeats.
    EXPECT_NEAR(summary["openings"]["outlet_1"]["flow_m3_per_s"].get<double>() / (0.279 * M_PI * 2.25e-6), 1, 0.02);
    EXPECT_LT(summary["time_s"].get<double>(), 2.5);   // three beats
    EXPECT_GT(summary["openings"]["outlet_1"]["myocardial_compliance_m3_per_pa"].get<double>(), 0);
    // Systole is the first 0.335 s of a beat; a left coronary artery flows mostly after it.
    const CsvTable waves = read_csv(folder_ / "out/waveforms.csv");
    const auto column = [&](const std::string& name) {
        const auto at = std::find(waves.names.begin(), waves.names.end(), name);
        EXPECT_NE(at, waves.names.end()) << name;
        return waves.columns.at(std::size_t(at - waves.names.begin()));
    };
    const std::vector<double> times = column("time_s"), flows = column("outlet_1_flow_m3_per_s");
    double sums[2]{}, counts[2]{};
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (times[k] < times.back() - 0.8) continue;
        const bool is_diastole = std::fmod(times[k], 0.8) > 0.335;
        sums[is_diastole] += flows[k], ++counts[is_diastole];
    }
    EXPECT_GT(sums[1] / counts[1], 1.3 * sums[0] / counts[0]);
}

TEST_F(Init, NeverReplacesADeckUnlessTold) {
    put(deck(), "mine");
    const std::string command = fmt::format("init {} --unit mm --budget 10s -o {}", tube(), deck());
    EXPECT_EQ(patency(command).exit_code, 7);
    EXPECT_EQ(contents_of(deck()), "mine");
    EXPECT_EQ(patency(command + " --force").exit_code, 0);
    EXPECT_TRUE(has(contents_of(deck()), "version: 1"));
    EXPECT_EQ(patency(fmt::format("init {} --unit mm -o {}/no/case.yaml", tube(), folder_.path().string())).exit_code,
              7);
}

TEST_F(Init, RefusesWhatInspectRefuses) {
    const std::string out = " -o " + deck();
    EXPECT_EQ(patency("init " + tube() + out).exit_code, 2);   // no unit
    const Result metres = patency("init --unit m " + tube() + out);
    EXPECT_EQ(metres.exit_code, 4);
    EXPECT_TRUE(has(metres.output, "Did you mean"));
    EXPECT_EQ(patency("init --unit mm --budget 5 " + tube() + out).exit_code, 2);
    EXPECT_EQ(patency("init --unit mm --budget '-5 s' " + tube() + out).exit_code, 2);
    EXPECT_EQ(patency("init --unit mm --inlet 7 " + tube() + out).exit_code, 2);
    EXPECT_EQ(patency("init --unit mm " + (folder_ / "none.stl").string() + out).exit_code, 7);
    Surface holed = make_tube_mesh({});
    holed.triangles.erase(holed.triangles.begin() + 1000);
    holed.face_ids.clear();
    write_surface(folder_ / "holed.vtp", holed);
    const Result refused = patency("init --unit mm " + (folder_ / "holed.vtp").string() + out);
    EXPECT_EQ(refused.exit_code, 4);
    EXPECT_TRUE(has(refused.output, "hole"));
    EXPECT_FALSE(fs::exists(deck()));
}

TEST_F(Init, OfOneLabelOfSeveral) {
    std::string voxels;   // a vessel of 3 mm, label 2, in a wall, label 1
    for (int k = 0; k < 24; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 0; i < 48; ++i) {
                const double away = std::hypot(j - 11.3, k - 11.6);
                voxels += char(away < 6 ? 2 : away < 9 ? 1 : 0);
            }
    put(folder_ / "tube.mha",
        "ObjectType = Image\nNDims = 3\nDimSize = 48 24 24\nElementSpacing = 0.25 0.25 0.25\n"
        "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
            voxels);
    const std::string image = (folder_ / "tube.mha").string();
    const Result unsaid = patency(fmt::format("init {} -o {}", image, deck()));
    EXPECT_EQ(unsaid.exit_code, 4);
    EXPECT_TRUE(has(unsaid.output, "--label"));
    const Result result = patency(fmt::format("init {} --label 2 --budget 1min -o {}", image, deck()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    EXPECT_TRUE(has(contents_of(deck()), "  label: 2 "));
    const Result check = patency("check " + deck());
    EXPECT_EQ(check.exit_code, 0) << check.output;
    const Result estimate = patency(fmt::format("estimate {} -o {}", deck(), (folder_ / "out").string()));
    EXPECT_EQ(estimate.exit_code, 0) << estimate.output;
    // The bed takes 0.279 m/s through 3 mm; the surface of a label is right to 1 % of its area.
    EXPECT_NEAR(read_summary(folder_ / "out/summary.json")["openings"]["outlet_1"]["flow_m3_per_s"].get<double>(),
                0.279 * M_PI * 2.25e-6, 6e-8);
    const Result none = patency(fmt::format("estimate {} --set geometry.label=7", deck()));
    EXPECT_EQ(none.exit_code, 4);
    EXPECT_TRUE(has(none.output, "has no label 7")) << none.output;
    const Result surface = patency(fmt::format("init {} --unit mm --label 2 --force -o {}", tube(), deck()));
    EXPECT_EQ(surface.exit_code, 2);
    EXPECT_TRUE(has(surface.output, "is no label map")) << surface.output;
}

TEST_F(Init, OfTheNetworkThatComesWithTheProgram) {
    const Result result =
        patency(fmt::format("init {}/cases/coronary_bifurcation.json --budget 5min -o {}", PATENCY_SOURCE_DIR, deck()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    EXPECT_TRUE(has(contents_of(deck()), "outlet_large: {type: resistance}"));
    const Result estimate = patency("estimate " + deck());
    EXPECT_EQ(estimate.exit_code, 0) << estimate.output;
    EXPECT_EQ(patency("check " + deck()).exit_code, 0);
}

TEST_F(Init, OfVesselsThatOthersPublished) {
    const fs::path data = fs::path(PATENCY_SOURCE_DIR) / "../shared/data/vessels";
    if (!fs::exists(data)) GTEST_SKIP() << "no ../shared beside the project";
    for (const auto& [name, unit, code] : {std::tuple("internal_carotid_C0015mod.vtp", "mm", 0),
                                           {"aortoiliac_vmtk_open_ends.stl", "mm", 0},
                                           {"aortoiliac_simvascular_capped.vtp", "cm", 0},
                                           {"ideal_Y_bifurcation.stl", "mm", 0},
                                           {"coronary_LCA_stenosed_m1.stl", "mm", 0},
                                           {"coronary_phantom_7openings.stl", "mm", 0},
                                           {"DIRTY_cerebral_aneurysm_small_holes.stl", "m", 4}}) {
        const Result result =
            patency(fmt::format("init {} --unit {} -o {} --force", (data / name).string(), unit, deck()));
        EXPECT_EQ(result.exit_code, code) << name << ": " << result.output;
        if (code != 0) continue;
        const Result check = patency("check " + deck());
        EXPECT_EQ(check.exit_code, 0) << name << ": " << check.output;
    }
}

}   // namespace
}   // namespace patency
