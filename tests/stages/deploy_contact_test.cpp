// SPDX-License-Identifier: Apache-2.0
// A stent that is crimped, opened in a vessel and let go with mechanics: wherever it is stopped, and for any number of threads, it goes on
// with the same bits. In so few steps that its numbers mean nothing.
#include <gtest/gtest.h>
#include <omp.h>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/stages/deploy.h"
#include "tests/stages/results_folder.h"

namespace patency {
namespace {

class DeploymentByContact : public ::testing::Test {
protected:
    DeploymentByContact() {
        std::filesystem::create_directories(folder_.path);
        std::ofstream(folder_.path / "tube.json") << R"({"unit": "mm", "blend_width_k": 0.1,
  "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.2], [4, 0, 0, 1.2], [8, 0, 0, 1.2], [14, 0, 0, 1.2]]}],
  "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.2},
           "distal": {"point": [12, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.2}}})";
        std::ofstream(folder_.path / "case.yaml") << R"(version: 1
case: {name: ring}
geometry: {network: tube.json, lesion: {branch: tube, position: "6 mm", length: "3 mm", diameter_stenosis_percent: 20}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlet: {type: pressure, pressure: "93 mmHg"}
  distal: {type: resistance, resistance: "2e10 Pa s/m^3"}
stent:
  pattern: {layout: rings, rings: 1, crowns: 6, length: 1.075 mm, diameter: 1.8 mm, crimped_diameter: 1.7 mm, nominal_diameter: 2.6 mm,
            strut_width: 100 um, strut_thickness: 100 um, crown_radius: 100 um, gap: 200 um, connectors: 3}
wall: {spacing: "0.3 mm"}
deployment: {diameter: "2.2 mm", steps: 400, region: 1.5, frames: 4}
numerics: {scheme: cells, across: 8, duration: "1 s"}
)";
    }

    /// Stopped after each of these numbers of looks at whether it is (then to the end); where the deployment was each time.
    std::vector<std::string> run(const std::string& name, const std::vector<int>& stops, int threads) {
        omp_set_num_threads(threads);
        const deck::Case config = deck::read_case(folder_.path / "case.yaml");
        std::vector<std::string> said;
        for (std::size_t k = 0; k <= stops.size(); ++k) {
            const OutputFolder out(folder_.path / name);
            int asked = 0;
            const bool is_done = run_deploy(config, {.folder = out,
                                                     .interrupted = [&] { return k < stops.size() && ++asked >= stops[k]; },
                                                     .log = [&](LogLevel, const std::string& line) { said.push_back(line); }});
            EXPECT_EQ(is_done, k == stops.size());
        }
        omp_set_num_threads(1);
        return said;
    }

    Folder folder_;
};

}   // namespace

TEST_F(DeploymentByContact, GoesOnWithTheSameBits) {
    run("straight", {}, 1);
    // In the crimp, when it is let go, twice while it opens and the wall is met, and while the balloon goes.
    const std::vector<std::string> said = run("stopped", {20, 50, 100, 100, 80}, 2);
    std::size_t resumed = 0;
    for (const std::string& line : said) resumed += line.starts_with("goes on at");
    EXPECT_EQ(resumed, 5u);
    for (const char* file : {"summary.json", "deployment.csv", "stent.csv", "lumen_after.stl"})
        EXPECT_EQ(text_of(folder_.path / "stopped" / file), text_of(folder_.path / "straight" / file)) << file;
    EXPECT_NE(text_of(folder_.path / "straight" / "summary.json").find("recoil_percent"), std::string::npos);
    std::size_t frames = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path / "straight" / "frames")) {
        EXPECT_EQ(text_of(folder_.path / "stopped" / "frames" / entry.path().filename()), text_of(entry.path())) << entry.path();
        ++frames;
    }
    EXPECT_GE(frames, 8u);
}

}   // namespace patency
