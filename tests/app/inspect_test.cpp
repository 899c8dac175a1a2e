// SPDX-License-Identifier: Apache-2.0
// patency inspect from outside: exit codes, what it says and writes; and the vessels that others published.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "tests/app/program.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

class Inspect : public ::testing::Test {
protected:
    std::string write(const Surface& surface, const char* name = "vessel.vtp") {
        write_surface(folder_ / name, surface);
        return (folder_ / name).string();
    }
    std::string out() const { return (folder_ / "out").string(); }
    nlohmann::ordered_json figures() const { return read_summary(folder_ / "out/inspect.json"); }
    ScratchFolder folder_;
};

TEST_F(Inspect, ASoundTubeIs0) {
    const Result result = patency(
        fmt::format("inspect {} --unit mm -o {}", write(make_tube_mesh({.start_cap = true, .end_cap = true})), out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    for (const char* word : {"inlet", "outlet_1", "wall area", "volume", "Findings: none"})
        EXPECT_TRUE(has(result.output, word));
    const auto json = figures();
    EXPECT_NEAR(json["volume_mm3"].get<double>(), 6 * M_PI, 0.01 * 6 * M_PI);
    EXPECT_NEAR(json["wall_area_mm2"].get<double>(), 12 * M_PI, 0.01 * 12 * M_PI);
    EXPECT_NEAR(json["openings"]["inlet"]["diameter_mm"].get<double>(), 2, 0.02);
    EXPECT_NEAR(json["openings"]["inlet"]["off_square_deg"].get<double>(), 0, 0.1);
    EXPECT_EQ(json["usable"], true);
    EXPECT_NEAR(json["centrelines"]["outlet_1"]["length_mm"].get<double>(), 6, 1e-3);
    EXPECT_NEAR(json["branches"]["branch_1"]["minimum_diameter_mm"].get<double>(), 2, 0.02);
    EXPECT_EQ(json["lesions"].size(), 0u);
    EXPECT_TRUE(fs::exists(folder_ / "out/centerline.vtp"));
    EXPECT_TRUE(has(result.output, "Lesions: none"));
    const std::string svg = contents_of(folder_ / "out/inspect.svg");
    EXPECT_TRUE(has(svg, "outlet_1  2.00 mm"));
    EXPECT_TRUE(has(svg, "</svg>"));
    EXPECT_EQ(svg.find("nan"), svg.npos);
    EXPECT_NEAR(volume(read_surface(folder_ / "out/surface.vtp", "mm")), 6e-9 * M_PI, 0.06e-9 * M_PI);
}

TEST_F(Inspect, DefectsAre4AndAreWritten) {
    Surface tube = make_tube_mesh({});
    tube.triangles.erase(tube.triangles.begin() + 1000);
    tube.face_ids.clear();
    const Result result = patency(fmt::format("inspect {} --unit mm -o {}", write(tube), out()));
    EXPECT_EQ(result.exit_code, 4) << result.output;
    EXPECT_TRUE(has(result.output, "refused   holes"));
    EXPECT_TRUE(fs::exists(folder_ / "out/finding_holes.vtp"));
    EXPECT_EQ(figures()["usable"], false);
    EXPECT_EQ(patency(fmt::format("inspect {} --unit mm -o {}", write(make_tube_mesh({})), out())).exit_code, 0);
    EXPECT_FALSE(fs::exists(folder_ / "out/finding_holes.vtp"));   // of the earlier surface
    EXPECT_EQ(patency("inspect --unit mm " + write(make_tube_mesh({.start_cap = true, .round_end = true}))).exit_code,
              4);
}

TEST_F(Inspect, AWrongUnitIs4WithAQuestion) {
    const Result result = patency("inspect --unit m " + write(make_tube_mesh({})));
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_TRUE(has(result.output, "Did you mean"));
    EXPECT_TRUE(has(result.output, "--unit mm (2 mm)"));
    EXPECT_EQ(patency("inspect --unit inch " + write(make_tube_mesh({}))).exit_code, 2);
    EXPECT_EQ(patency("inspect " + write(make_tube_mesh({}))).exit_code, 2);
}

TEST_F(Inspect, TheInletIsTheUsers) {
    Surface cone = make_tube_mesh({});
    for (Vec3& x : cone.points) x.y *= 1 - 50 * x.x, x.z *= 1 - 50 * x.x;
    const std::string file = write(cone);
    EXPECT_EQ(patency(fmt::format("inspect {} --unit mm -o {} --inlet outlet_1", file, out())).exit_code, 0);
    EXPECT_NEAR(figures()["openings"]["inlet"]["diameter_mm"].get<double>(), 1.4, 0.014);
    EXPECT_EQ(patency(fmt::format("inspect {} --unit mm --inlet 2", file)).exit_code, 0);
    EXPECT_EQ(patency(fmt::format("inspect {} --unit mm --inlet 3", file)).exit_code, 2);
}

TEST_F(Inspect, ANetworkIsASurfaceWithItsOwnNames) {
    const std::string file = std::string(PATENCY_SOURCE_DIR) + "/cases/coronary_bifurcation.json";
    const Result result = patency(fmt::format("inspect {} -o {}", file, out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const auto openings = figures()["openings"];
    ASSERT_EQ(openings.size(), 4u);
    for (const auto& [name, diameter] :
         {std::pair("inlet", 4.0), {"outlet_large", 3.5}, {"outlet_medium", 3.0}, {"outlet_small", 2.5}})
        EXPECT_NEAR(openings[name]["diameter_mm"].get<double>(), diameter, 0.01 * diameter) << name;
    EXPECT_EQ(figures()["usable"], true);
    EXPECT_EQ(patency(fmt::format("inspect {} --unit cm", file)).exit_code, 2);
}

TEST_F(Inspect, ALabelMapIsASurface) {
    std::string voxels;
    for (int k = 0; k < 20; ++k)
        for (int j = 0; j < 20; ++j)
            for (int i = 0; i < 24; ++i) voxels += char(std::hypot(j - 9.3, k - 9.6) < 6 ? 1 : 0);
    put(folder_ / "tube.mha",
        "ObjectType = Image\nNDims = 3\nDimSize = 24 20 20\nElementSpacing = 0.25 0.25 0.25\n"
        "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
            voxels);
    const Result result = patency(fmt::format("inspect {} -o {}", (folder_ / "tube.mha").string(), out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NEAR(figures()["openings"]["inlet"]["diameter_mm"].get<double>(), 3, 0.06);
    EXPECT_EQ(figures()["space"], "LPS");
    EXPECT_EQ(patency("inspect --label 4 " + (folder_ / "tube.mha").string()).exit_code, 4);
}

TEST_F(Inspect, AMarkOfAxesIsCarried) {
    const std::string file = write(make_tube_mesh({}));
    EXPECT_EQ(patency(fmt::format("inspect {} --unit mm --space LPS -o {}", file, out())).exit_code, 0);
    EXPECT_EQ(read_surface(folder_ / "out/surface.vtp", "mm").space, "LPS");
    EXPECT_EQ(patency("inspect --unit mm --space XYZ " + file).exit_code, 2);
}

TEST_F(Inspect, FilesThatCannotBeReadAre7) {
    EXPECT_EQ(patency("inspect --unit mm " + (folder_ / "none.stl").string()).exit_code, 7);
    put(folder_ / "bad.vtp", "<VTKFile type=\"PolyData\"><Poly");
    const Result result = patency("inspect --unit mm " + (folder_ / "bad.vtp").string());
    EXPECT_EQ(result.exit_code, 7);
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1)
        << result.output;   // ours and nothing of VTK's
}

/// Published vessels: not in the project (../shared/data/INDEX.md says why), diameters as measured there.
struct Vessel {
    const char *file, *unit;
    std::vector<double> diameters;   ///< mm, falling
};
void PrintTo(const Vessel& vessel, std::ostream* out) { *out << vessel.file; }

fs::path vessels() { return fs::path(PATENCY_SOURCE_DIR) / "../shared/data/vessels"; }

class Vessels : public Inspect, public ::testing::WithParamInterface<Vessel> {};
TEST_P(Vessels, HaveTheOpeningsThatWereMeasured) {
    const Vessel& vessel = GetParam();
    if (!fs::exists(vessels())) GTEST_SKIP() << "no " << vessels();
    const Result result =
        patency(fmt::format("inspect {} --unit {} -o {}", (vessels() / vessel.file).string(), vessel.unit, out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const auto openings = figures()["openings"];
    ASSERT_EQ(openings.size(), vessel.diameters.size()) << result.output;
    std::size_t next = 0;
    for (const auto& [name, opening] : openings.items()) {
        EXPECT_EQ(name, next == 0 ? "inlet" : fmt::format("outlet_{}", next));
        EXPECT_NEAR(opening["diameter_mm"].get<double>(), vessel.diameters[next], 0.03 * vessel.diameters[next]);
        ++next;
    }
}
INSTANTIATE_TEST_SUITE_P(
    Published, Vessels,
    ::testing::Values(Vessel{"coronary_LCA_stenosed_m1.stl", "mm", {4.562, 1.361, 1.205, 1.140, 1.140, 0.867, 0.717}},
                      Vessel{"coronary_phantom_7openings.stl", "mm", {6.194, 3.932, 3.932, 3.932, 3.932, 3.932, 3.932}},
                      Vessel{"internal_carotid_C0015mod.vtp", "mm", {3.119, 2.592, 1.800}},
                      Vessel{"aortoiliac_vmtk_open_ends.stl", "mm", {15.37, 8.821, 8.737}},
                      Vessel{"aortoiliac_simvascular_capped.vtp", "cm", {24.25, 11.13, 10.01}},
                      Vessel{"ideal_Y_bifurcation.stl", "mm", {1.994, 1.994, 1.994}}));

TEST_F(Inspect, TheFocalStenosisOfTheCoronaryTreeIsFound) {
    if (!fs::exists(vessels())) GTEST_SKIP() << "no " << vessels();
    const Result result = patency(
        fmt::format("inspect {} --unit mm -o {}", (vessels() / "coronary_LCA_stenosed_m1.stl").string(), out()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto worst = figures()["lesions"][0];
    const double place[] = {33.0, -19.1, 98.9};
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(worst["place_mm"][axis].get<double>(), place[axis], 0.3);
    EXPECT_NEAR(worst["minimum_diameter_mm"].get<double>(), 0.58, 0.03);
    EXPECT_GT(worst["diameter_stenosis_percent"].get<double>(), 80);
    EXPECT_TRUE(has(contents_of(folder_ / "out/inspect.svg"), "L1  84 %"));
}

TEST_F(Inspect, TheStenosisOfTheReferenceBifurcationIs39Percent) {
    const fs::path lumen = fs::path(PATENCY_SOURCE_DIR) / "../shared/reference/coronary_bifurcation/lumen.stl";
    if (!fs::exists(lumen)) GTEST_SKIP() << "no " << lumen;
    const Result result = patency(fmt::format("inspect {} --unit mm -o {}", lumen.string(), out()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto json = figures();
    ASSERT_EQ(json["lesions"].size(), 1u) << result.output;
    EXPECT_NEAR(json["lesions"][0]["diameter_stenosis_percent"].get<double>(), 39, 1);
    const double place[] = {28.1283, 9.0408, 3.0255};
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(json["lesions"][0]["place_mm"][axis].get<double>(), place[axis], 0.6);
    EXPECT_EQ(json["branches"].size(), 5u);
}

TEST_F(Inspect, ANetworksBranchesHaveTheNamesThatDecksUse) {
    const Result result =
        patency(fmt::format("inspect {}/cases/coronary_bifurcation.json -o {}", PATENCY_SOURCE_DIR, out()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    for (const char* name : {"left_main", "circumflex", "anterior_descending"})
        EXPECT_TRUE(has(result.output, name)) << name;
    EXPECT_FALSE(has(result.output, "branch_1"));
}

TEST_F(Inspect, TheDirtyVesselIsRefusedWithItsDefects) {
    if (!fs::exists(vessels())) GTEST_SKIP() << "no " << vessels();
    const Result result = patency(fmt::format("inspect {} --unit m -o {}",
                                              (vessels() / "DIRTY_cerebral_aneurysm_small_holes.stl").string(), out()));
    EXPECT_EQ(result.exit_code, 4) << result.output;
    EXPECT_TRUE(has(result.output, "refused   holes"));
    EXPECT_TRUE(has(result.output, "edges belong to more than two triangles"));
}

TEST_F(Inspect, AHundredAndFortyThousandTrianglesTakeLessThanTenSeconds) {
    const std::string file = write(make_torus_mesh(4e-3, 1e-3, 500, 140));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(patency(fmt::format("inspect {} --unit mm -o {}", file, out())).exit_code, 4);   // a ring has no opening
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 10);
}

}   // namespace
}   // namespace patency
