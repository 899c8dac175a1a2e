// SPDX-License-Identifier: Apache-2.0
// Solids that are stopped anywhere go on with the same bits, whatever acts on them and for any number of threads.
#include <gtest/gtest.h>
#include <omp.h>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/atomic_file.h"
#include "patency/stages/run_solids.h"

using namespace patency;

namespace {

// A metal ring that a balloon opens within a soft tube that it meets with friction, each at its own step; and a block of
// rubber that is squeezed between a held face and a plane, brought to rest.
const std::string ring = R"(version: 1
solids:
  - name: metal
    shape: {type: cylinder, from: [-0.5 mm, 0 mm, 0 mm], to: [0.5 mm, 0 mm, 0 mm], diameter: 6 mm, inner_diameter: 5 mm}
    material: {name: 316L}
    mass_scaling: 400
    spacing: 0.25 mm
  - name: wall
    shape: {type: cylinder, from: [-1 mm, 0 mm, 0 mm], to: [1 mm, 0 mm, 0 mm], diameter: 9 mm, inner_diameter: 6.05 mm}
    material: {law: neo_hookean, density: 1100 kg/m^3, young: 1 MPa, poisson: 0.4}
    spacing: 0.5 mm
    holds: [{face: outer, axes: [true, false, false]}]
contacts:
  - {solid: metal, tool: {type: balloon, from: [-4 mm, 0 mm, 0 mm], to: [4 mm, 0 mm, 0 mm], times: [0 us, 30 us], diameters: [4.98 mm, 5.4 mm]}, friction: 0.1, damping: 0.2}
  - {solid: metal, with: wall, friction: 0.2, damping: 0.2}
numerics: {spacing: 0.5 mm, duration: 30 us, precision: mixed, solid: {viscosity: 0.1}}
output: {interval: 8 us}
)";
const std::string block = R"(version: 1
solids:
  - name: block
    shape: {type: box, from: [0 mm, 0 mm, 0 mm], to: [10 mm, 6 mm, 0 mm]}
    material: {law: neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
    holds: [{face: y_high, displacement: [0.3 mm, -0.5 mm, 0 mm], ramp: 1 ms}]
contacts: [{solid: block, plane: {point: [0 mm, -0.1 mm, 0 mm], normal: [0, 1, 0]}, friction: 0.3}]
numerics: {spacing: 1 mm, duration: 2 ms, precision: double, solid: {plane_strain: true, relaxation: adaptive}}
output: {interval: 0.7 ms}
)";

class Stopped : public ::testing::TestWithParam<std::string> {
protected:
    std::filesystem::path root =
        std::filesystem::temp_directory_path() / ("patency_solid_" + std::to_string(::getpid()));
    ~Stopped() override { std::filesystem::remove_all(root); }

    /// Runs in its own folder, stopped after each of these numbers of steps (then to the end).
    std::filesystem::path run(const std::string& name, const std::vector<int>& stops, int threads) {
        omp_set_num_threads(threads);
        const deck::Case config = deck::parse_case(GetParam());
        const std::filesystem::path out = root / name;
        for (std::size_t k = 0; k <= stops.size(); ++k) {
            const OutputFolder folder(out);
            int asked = 0;
            const bool is_done = run_solids(
                config, {.folder = folder, .interrupted = [&] { return k < stops.size() && ++asked >= stops[k]; }});
            EXPECT_EQ(is_done, k == stops.size());
        }
        omp_set_num_threads(1);
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Solids, Stopped, ::testing::Values(ring, block));

}   // namespace

TEST_P(Stopped, GoOnWithTheSameBits) {
    const auto straight = run("straight", {}, 1),
               stopped = run("stopped", {1, 60, 45, 30}, 2);   // before and while things touch
    EXPECT_NE(read_file(straight / "summary.json").find("touching_vertices"), std::string::npos);
    for (const char* file : {"summary.json", "energies.csv"})
        EXPECT_EQ(read_file(stopped / file), read_file(straight / file)) << file;
    std::size_t frames = 0;
    for (const auto& entry : std::filesystem::directory_iterator(straight / "frames")) {
        EXPECT_EQ(read_file(stopped / "frames" / entry.path().filename()), read_file(entry.path())) << entry.path();
        ++frames;
    }
    EXPECT_GE(frames, 4u);
}

/// 50 ms in rows of 0.25 ms and frames every 6.25 ms: multiples of both that differ by round-off are one time.
TEST(RunSolids, NoRowAndNoFrameIsLostToRoundOff) {
    std::string text = block;
    text.replace(text.find("duration: 2 ms"), 14, "duration: 50 ms");
    text.replace(text.find("interval: 0.7 ms"), 16, "interval: 6.25 ms");
    const std::filesystem::path root =
        std::filesystem::temp_directory_path() / ("patency_rows_" + std::to_string(::getpid()));
    {
        const OutputFolder folder(root);
        EXPECT_TRUE(run_solids(deck::parse_case(text), {.folder = folder}));
    }
    const std::string rows = read_file(root / "energies.csv"), frames = read_file(root / "block.pvd");
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 201);
    std::size_t count = 0;
    for (std::size_t at = frames.find("<DataSet"); at != frames.npos; at = frames.find("<DataSet", at + 1)) ++count;
    EXPECT_EQ(count, 9u);
    std::filesystem::remove_all(root);
}

TEST_P(Stopped, AnotherDeckDoesNotGoOn) {
    run("deck", {5}, 1);
    deck::Case other = deck::parse_case(GetParam());
    other.numerics.duration *= 2;
    const OutputFolder folder(root / "deck");
    EXPECT_THROW(run_solids(other, {.folder = folder}), CheckpointError);
}
