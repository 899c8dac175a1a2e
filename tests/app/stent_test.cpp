// SPDX-License-Identifier: Apache-2.0
// patency stent from outside: exit codes, what it says and writes, and a stent that others published.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "patency/shape/stent_library.h"
#include "tests/app/program.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

TEST(StentCommand, ListsAndShowsEveryDesign) {
    const Result list = patency("stent list");
    EXPECT_EQ(list.exit_code, 0);
    for (const StentDesign& design : stent_library()) EXPECT_TRUE(has(list.output, design.name));
    const Result shown = patency("stent show closed_cell");
    EXPECT_EQ(shown.exit_code, 0) << shown.output;
    EXPECT_TRUE(has(shown.output, "48"));   // cells: eight gaps of six connectors
    const Result unknown = patency("stent show closed_cel");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_TRUE(has(unknown.output, "did you mean closed_cell?"));
    EXPECT_EQ(patency("stent").exit_code, 2);
}

constexpr const char* deck_text = R"(version: 1
geometry: {shape: {type: tube, diameter: "4 mm", length: "20 mm"}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
numerics: {spacing: "0.25 mm", duration: "0.2 s"}
stent:
  pattern: {rings: 2, crowns: 6, length: "2.4 mm", diameter: "2 mm", crimped_diameter: "1.2 mm", nominal_diameter: "3 mm",
    strut_width: "0.1 mm", strut_thickness: "0.1 mm", crown_radius: "0.15 mm", gap: "0.2 mm", connectors: 3}
  placement: PLACEMENT
)";

std::string deck_with(const std::string& placement) {
    std::string text = deck_text;
    return text.replace(text.find("PLACEMENT"), 9, placement);
}

TEST(StentCommand, WritesADecksStentWhereItIs) {
    ScratchFolder folder;
    put(folder / "case.yaml", deck_with("{translation: [\"10 mm\", \"0 mm\", \"0 mm\"], direction: [0, 0, 1]}"));
    const fs::path out = folder / "out";
    const Result result = patency(fmt::format("stent show {} -o {}", (folder / "case.yaml").string(), out.string()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const auto json = read_summary(out / "stent.json");
    EXPECT_NEAR(json["particles"]["volume_mm3"].get<double>(), json["metal_volume_mm3"].get<double>(), 1e-9);
    const Surface surface = read_surface(out / "surface.vtp", "mm");
    EXPECT_NEAR(1e9 * volume(surface), json["metal_volume_mm3"].get<double>(), 0.005);
    const Bounds box = bounds(surface);
    EXPECT_NEAR(box.high.z, 1.2e-3, 2e-6);
    EXPECT_NEAR(0.5 * (box.low.x + box.high.x), 10e-3, 5e-6);
    EXPECT_TRUE(fs::exists(out / "particles.vtp"));
    for (const char* picture : {"stent.svg", "open.svg"}) {
        const std::string svg = contents_of(out / picture);
        EXPECT_TRUE(has(svg, "</svg>"));
        EXPECT_EQ(svg.find("nan"), svg.npos);
    }
}

TEST(StentCommand, LiesAlongALine) {
    ScratchFolder folder;
    put(folder / "case.yaml", deck_with("{arc_length: \"10 mm\"}"));
    std::string line = "x_mm,y_mm,z_mm\n";
    for (int k = 0; k <= 20; ++k) line += fmt::format("{},{},0\n", k, 0.01 * k * k);
    put(folder / "line.csv", line);
    put(folder / "other.csv", "x,y,z\n0,0,0\n1,0,0\n");
    const std::string shown = "stent show " + (folder / "case.yaml").string();
    EXPECT_EQ(patency(shown + " --line " + (folder / "line.csv").string()).exit_code, 0);
    EXPECT_EQ(patency(shown).exit_code, 3);   // the line is not known
    EXPECT_EQ(patency(shown + " --line " + (folder / "other.csv").string()).exit_code, 3);
    EXPECT_EQ(patency(shown + " --at \"0.5 mm\" --line " + (folder / "line.csv").string()).exit_code,
              4);   // past the end
    EXPECT_EQ(patency(shown + " --line " + (folder / "none.csv").string()).exit_code, 7);
}

TEST(StentCommand, ThePublishedStentIsRead) {
    const fs::path file = fs::path(PATENCY_SOURCE_DIR) / "../shared/data/stents/coronary_stent_A.stl";
    if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
    ScratchFolder folder;
    const Result result = patency(
        fmt::format("stent import {} --unit mm --spacing \"40 um\" -o {}", file.string(), (folder / "out").string()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const auto json = read_summary(folder / "out/stent.json");
    EXPECT_NEAR(json["outer_diameter_mm"].get<double>(), 3.16, 0.001);
    EXPECT_NEAR(json["length_mm"].get<double>(), 15, 0.001);
    EXPECT_NEAR(json["metal_volume_mm3"].get<double>(), 3.007, 0.0005);
    EXPECT_NEAR(json["metal_surface_mm2"].get<double>(), 97.96, 0.005);
    EXPECT_NEAR(json["strut_thickness_um"].get<double>(), 80, 1);
    EXPECT_NEAR(json["axis"][1].get<double>(), 1, 1e-6);
    EXPECT_NEAR(json["particles"]["volume_mm3"].get<double>(), 3.007, 0.0005);
    EXPECT_EQ(patency(fmt::format("stent import {} --unit m", file.string())).exit_code, 4);
    EXPECT_EQ(patency(fmt::format("stent import {}", file.string())).exit_code, 2);
}

}   // namespace
}   // namespace patency
