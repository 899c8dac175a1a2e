// SPDX-License-Identifier: Apache-2.0
// patency sweep from outside: rows, failures, and what is kept.
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

class Sweep : public ::testing::Test {
protected:
    Sweep() {
        std::ofstream(folder_ / "tube.json")
            << R"({"unit": "mm", "tubes": [{"name": "tube", "points": [[0, 0, 0, 1.5], [10, 0, 0, 1.5], [20, 0, 0, 1.5], [30, 0, 0, 1.5]]}]})";
        std::ofstream(deck()) << R"(version: 1
case: {name: tube}
geometry: {network: tube.json, lesion: {branch: tube, position: "15 mm", length: "5 mm", diameter_stenosis_percent: 50}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
aorta: {pressure: "93 mmHg"}
openings:
  inlet: {type: pressure, pressure: "93 mmHg"}
  outlet_1: {type: resistance, resistance: "1e10 Pa s/m^3"}
numerics: {spacing: "0.3 mm", duration: "1 s"}
)";
    }
    fs::path deck() const { return folder_ / "case.yaml"; }
    fs::path out() const { return folder_ / "out"; }
    Result sweep(const std::string& more) const {
        return patency(fmt::format("sweep {} -o {} --command estimate {}", deck().string(), out().string(), more));
    }

    ScratchFolder folder_;
    const std::string stenoses_ = "--set geometry.lesion.diameter_stenosis_percent=";
};

TEST_F(Sweep, ATighterLesionHasALowerFfr) {
    const Result done = sweep(stenoses_ + "40,60 --set 'blood.viscosity=3 mPa s,4 mPa s' --set case.name=a,b --jobs 2");
    ASSERT_EQ(done.exit_code, 0) << done.output;
    const auto ffr = [&](const std::string& name) {
        return read_summary(out() / name / "summary.json")["ffr"]["lesion"].get<double>();
    };
    for (const char* rest : {"viscosity=3_mPa_s,name=a", "viscosity=4_mPa_s,name=b"})
        EXPECT_LT(ffr(fmt::format("diameter_stenosis_percent=60,{}", rest)),
                  ffr(fmt::format("diameter_stenosis_percent=40,{}", rest)));
    EXPECT_EQ(read_summary(out() / "sweep.json")["runs"].size(), 8u);
    EXPECT_TRUE(fs::exists(out() / "sweep.csv"));
    EXPECT_TRUE(fs::exists(out() / "report.html"));
    const Result again = patency(fmt::format("report {}", out().string()));
    EXPECT_EQ(again.exit_code, 0) << again.output;
}

TEST_F(Sweep, GrowsAndDoesNothingTwice) {
    ASSERT_EQ(sweep(stenoses_ + "40,60").exit_code, 0);
    const auto then = fs::last_write_time(out() / "diameter_stenosis_percent=40/summary.json");
    const Result more = sweep(stenoses_ + "30,40,60");
    ASSERT_EQ(more.exit_code, 0) << more.output;
    EXPECT_NE(more.output.find("3 runs, 2 of them done before"), std::string::npos) << more.output;
    EXPECT_EQ(fs::last_write_time(out() / "diameter_stenosis_percent=40/summary.json"), then);
    const Result other =
        sweep(stenoses_ + "40,60 --set 'blood.density=1050 kg/m^3'");   // other decks under the same names
    EXPECT_NE(other.output.find("2 runs, 0 of them done before"), std::string::npos) << other.output;
}

TEST_F(Sweep, ARunThatFailsIsARowThatSaysWhyAndIs6) {
    fs::copy(folder_ / "tube.json", folder_ / "good.json");
    std::ofstream(folder_ / "bad.json") << R"({"unit": "mm", "tubes": []})";
    const Result done = sweep("--set geometry.network=good.json,bad.json");
    EXPECT_EQ(done.exit_code, 6) << done.output;
    const auto runs = read_summary(out() / "sweep.json")["runs"];
    EXPECT_EQ(runs[0]["exit_code"], 0);
    EXPECT_EQ(runs[1]["exit_code"], 4);
    EXPECT_NE(runs[1]["reason"].get<std::string>(), "");
    EXPECT_NE(done.output.find(runs[1]["reason"].get<std::string>().substr(0, 30)), std::string::npos) << done.output;
}

TEST_F(Sweep, AMistakeInAnyDeckStopsItBeforeItBegins) {
    const Result wrong = sweep("--set 'blood.viscosity=3 mPa s,4 mm'");
    EXPECT_EQ(wrong.exit_code, 3) << wrong.output;
    EXPECT_FALSE(fs::exists(out()));
    EXPECT_EQ(sweep("--set 'blood.viscosity=3 mPa s'").exit_code, 2);   // nothing varies
    EXPECT_EQ(sweep("--set blood.viscosity").exit_code, 2);
}

TEST_F(Sweep, AStopIsHandedOnAndTheRestIsDoneLater) {
    const std::string command = fmt::format("sweep {} -o {} --command flow --jobs 1 --threads 1 {}30,40",
                                            deck().string(), out().string(), stenoses_);
    const Result stopped = patency(command + fmt::format(" & sleep 2; touch {}/stop; wait $!", out().string()));
    EXPECT_EQ(stopped.exit_code, 130) << stopped.output;
    EXPECT_TRUE(read_summary(out() / "sweep.json")["runs"][1]["exit_code"].is_null());
    const Result on = patency(command);
    EXPECT_EQ(on.exit_code, 0) << on.output;
}

}   // namespace
}   // namespace patency
