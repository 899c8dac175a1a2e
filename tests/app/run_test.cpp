// SPDX-License-Identifier: Apache-2.0
// patency run with a stent from outside: three stages, kept and resumed, and one summary.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "patency/io/summary.h"
#include "tests/app/program.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

/// A tube with a lesion and the stent for it, opened without mechanics, on few cells. The names are not those that the
/// openings of a surface get.
class Run : public ::testing::Test {
protected:
    Run() {
        std::ofstream(folder_ / "tube.json") << R"({"unit": "mm", "blend_width_k": 0.1,
  "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.5], [8, 0, 0, 1.5], [18, 0, 0, 1.5], [28, 0, 0, 1.5]]}],
  "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.5},
           "distal": {"point": [26, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.5}}})";
        std::ofstream(deck()) << R"(version: 1
case: {name: tube}
geometry: {network: tube.json, lesion: {branch: tube, position: "13 mm", length: "5 mm", diameter_stenosis_percent: 50}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
aorta: {pressure: "93 mmHg"}
openings:
  inlet: {type: pressure, pressure: "93 mmHg"}
  distal: {type: resistance, resistance: "2e10 Pa s/m^3"}
stent: {design: paper}
deployment: {mode: geometric, diameter: "3 mm"}
numerics: {spacing: "0.32 mm", duration: "1 s"}
)";
    }
    fs::path deck() const { return folder_ / "case.yaml"; }
    fs::path out() const { return folder_ / "out"; }
    Result run(const std::string& more = "") const {
        return patency(fmt::format("run {} -o {} {}", deck().string(), out().string(), more));
    }
    std::string content(const fs::path& path) const {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    ScratchFolder folder_;
};

// A name is looked up before anything is built, and a deck with a wrong one is not called right.
TEST_F(Run, AStentThatTheLibraryLacksIsAMistakeOfTheDeck) {
    for (const std::string setting : {"stent.design=papper", "stent.alloy=tin"})
        for (const std::string command : {"check", "run", "deploy"}) {
            const std::string where = command == "check" ? "" : " -o " + out().string();
            const Result result = patency(fmt::format("{} {}{} --set {}", command, deck().string(), where, setting));
            EXPECT_EQ(result.exit_code, 3) << result.output;
            EXPECT_NE(result.output.find(setting.substr(0, setting.find('=')) + ": "), std::string::npos)
                << result.output;
            EXPECT_EQ(result.output.find("the deck is right"), std::string::npos) << result.output;
            EXPECT_FALSE(fs::exists(out()));
        }
}

TEST_F(Run, AStentThatIsTooLongIsToldBeforeTheDeckIsCalledRight) {
    const Result result = patency(fmt::format("check {} --set 'stent.length=60 mm'", deck().string()));
    EXPECT_EQ(result.exit_code, 4) << result.output;
    EXPECT_EQ(result.output.find("the deck is right"), std::string::npos) << result.output;
}

TEST_F(Run, AStentOpensTheLesionAndStagesThatEndedAreKept) {
    const Result first = run("--stages before");
    ASSERT_EQ(first.exit_code, 0) << first.output;
    EXPECT_FALSE(read_summary(out() / "summary.json").contains("deploy"));
    const auto flow_then = fs::last_write_time(out() / "before/summary.json");

    const Result all = run();
    ASSERT_EQ(all.exit_code, 0) << all.output;
    EXPECT_NE(all.output.find("before: done before"), std::string::npos) << all.output;
    EXPECT_EQ(fs::last_write_time(out() / "before/summary.json"), flow_then);
    const auto summary = read_summary(out() / "summary.json");
    const double before = summary["before"]["ffr"]["lesion"], after = summary["after"]["at_lesions"][0]["ffr"];
    EXPECT_LT(before, 1);
    EXPECT_GT(after, before + 0.5 * (1 - before));
    EXPECT_EQ(summary["after"]["ffr"]["lesion"], after);
    EXPECT_GT(summary["after"]["openings"]["distal"]["flow_m3_per_s"].get<double>(),   // under the name that it had
              summary["before"]["openings"]["distal"]["flow_m3_per_s"].get<double>());
    EXPECT_EQ(summary["after"]["branches"][0]["name"], "tube");
    EXPECT_EQ(summary["deploy"]["mode"], "geometric");
    // The estimate's bands, before and where the lesion was; without mechanics only the blood is made of something.
    const auto band = summary["estimate"]["lesions"][0]["ffr_band"],
               band_after = summary["estimate_after"]["at_lesions"][0]["ffr_band"];
    const double estimated = summary["estimate_after"]["at_lesions"][0]["ffr"];
    EXPECT_LT(band[0], band[1]);
    EXPECT_LE(band_after[0].get<double>(), estimated);
    EXPECT_GE(band_after[1].get<double>(), estimated);
    EXPECT_GT(band_after[0], band[0]);
    ASSERT_EQ(summary["materials"].size(), 1u);
    EXPECT_EQ(summary["materials"][0]["viscosity_pa_s"], 3.5e-3);
    EXPECT_TRUE(fs::exists(out() / "report.html"));

    // What check says of the disk is right within a factor of 1.5.
    const Result check = patency(fmt::format("check {}", deck().string()));
    const std::size_t said = check.output.find(" MB on the disk");
    ASSERT_NE(said, std::string::npos) << check.output;
    const double forecast = 1e6 * std::stod(check.output.substr(check.output.rfind(' ', said - 1)));
    double bytes = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out()))
        if (entry.is_regular_file()) bytes += double(entry.file_size());
    EXPECT_LT(forecast, 1.5 * bytes);
    EXPECT_GT(1.5 * forecast, bytes);

    // A run in two goes says what a run in one says.
    const std::string in_two = content(out() / "summary.json");
    ASSERT_EQ(run("--fresh").exit_code, 0);
    EXPECT_EQ(content(out() / "summary.json"), in_two);
}

TEST_F(Run, AStentThatCannotGoThereIsRefusedBeforeTheFlow) {
    const Result refused = run("--set 'stent.placement={branch: tube, arc_length: 2 mm}'");
    EXPECT_EQ(refused.exit_code, 4) << refused.output;
    EXPECT_NE(refused.output.find("reaches past opening inlet"), std::string::npos) << refused.output;
    EXPECT_FALSE(fs::exists(out() / "before/summary.json"));
}

TEST_F(Run, CheckRefusesAMaterialThatNobodyKnows) {
    const auto check = [&](const std::string& layer, const std::string& metal) {
        return patency(
            fmt::format("check {} --set deployment.mode=balloon --set stent.material.name={} --set wall.plaque=fills "
                        "--set 'wall.layers.plaque.name={}'",
                        deck().string(), metal, layer));
    };
    const Result right = check("fibrous_plaque", "L605");
    EXPECT_EQ(right.exit_code, 0) << right.output;
    EXPECT_NE(right.output.find("particles of stent"), std::string::npos) << right.output;
    for (const Result& wrong : {check("fibrous_plaqe", "L605"), check("fibrous_plaque", "L650")}) {
        EXPECT_EQ(wrong.exit_code, 3) << wrong.output;
        EXPECT_NE(wrong.output.find("Did you mean"), std::string::npos) << wrong.output;
    }
}

TEST_F(Run, AnotherDeckInTheFolderIs8AndWrongStagesAre2) {
    EXPECT_EQ(run("--stages befor").exit_code, 2);
    EXPECT_EQ(run("--stages after").exit_code, 2);   // there is no deployment yet
    ASSERT_EQ(run("--stages before").exit_code, 0);
    const Result other = run("--set 'blood.viscosity=4 mPa s'");
    EXPECT_EQ(other.exit_code, 8) << other.output;
    EXPECT_TRUE(fs::exists(out() / "before/summary.json"));   // and nothing is lost
    EXPECT_EQ(run("--stages deploy --set stent=null").exit_code, 2);
}

}   // namespace
}   // namespace patency
