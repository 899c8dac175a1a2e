// SPDX-License-Identifier: Apache-2.0
// What is expected of a vessel before it is computed: its narrowest place, and what that makes of speeds and losses.
#include "patency/stages/speeds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "patency/config/deck.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/stages/build.h"
#include "tests/stages/vessels.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radius = 1.5e-3, length = 30e-3, stenosis = 0.5, mu = 3.5e-3, rho = 1060;
constexpr double area = pi * radius * radius;

const Vessel& tube() {
    static const Vessel vessel = followed(make_stenosed_tube(radius, length, 0));
    return vessel;
}
const Vessel& throat() {
    static const Vessel vessel = followed(make_stenosed_tube(radius, length, stenosis));
    return vessel;
}

std::unique_ptr<Scene> frame(const Vessel& vessel, const std::string& openings, const std::string& more = "") {
    return build_frame(
        deck::parse_case(fmt::format("version: 1\ngeometry: {{surface: t.stl, unit: mm}}\n"
                                     "blood: {{density: \"1060 kg/m^3\", viscosity: \"3.5 mPa s\"}}\n"
                                     "openings: {}\nnumerics: {{spacing: \"0.3 mm\", duration: \"1 s\"}}\n{}",
                                     openings, more)),
        &vessel);
}
const char* driven_by_flow =
    "{inlet: {type: flow, flow: \"2 mL/s\", profile: parabola}, outlet_1: {type: pressure, pressure: \"0 Pa\"}}";
const char* before_a_bed = "{inlet: {type: pressure, pressure: \"93 mmHg\"}, outlet_1: {type: resistance}}";
const char* with_a_bed = "aorta: {pressure: \"93 mmHg\"}\nbed: {flow: \"2 mL/s\"}\n";

TEST(Passage, OfATubeIsItsAreaAndItsLength) {
    const Passage p = passage_of(*tube().along, {2 * radius});
    EXPECT_NEAR(p.tightest_area, area, 0.005 * area);
    EXPECT_NEAR(p.drag, length / (area * area), 0.01 * length / (area * area));
    EXPECT_NEAR(narrowest_diameter(*tube().along), 2 * radius, 0.01 * radius);
}

TEST(Passage, OutletsShareTheFlowAndSoTheNeed) {
    const Vessel y = followed(make_y_surface());
    const auto shares = murray_shares({2.6e-3, 2.2e-3}, 3);
    const double trunk = pi * 1.5e-3 * 1.5e-3, left = pi * 1.3e-3 * 1.3e-3 / shares[0],
                 right = pi * 1.1e-3 * 1.1e-3 / shares[1];
    // Where the branches part no sphere of 3 mm fits, but one of 2.96 mm.
    EXPECT_NEAR(passage_of(*y.along, {2.6e-3, 2.2e-3}).tightest_area, std::min({trunk, left, right}), 0.03 * trunk);
}

TEST(Passage, OfNetworksHasTheClosedFormOfACone) {
    const Network cone{.tubes = {{.name = "a",
                                  .points = {{}, {0.02, 0, 0}},
                                  .radii = {2e-3, 1e-3},
                                  .start = TubeOpening{"inlet", {-1, 0, 0}},
                                  .end = TubeOpening{"outlet", {1, 0, 0}}}}};
    const Passage p = passage_of(cone);
    double sum = 0;   // of slices
    constexpr int slices = 20000;
    for (int k = 0; k < slices; ++k)
        sum += 0.02 / slices / std::pow(pi * std::pow(2e-3 - 1e-3 * (k + 0.5) / slices, 2), 2);
    EXPECT_NEAR(p.drag, sum, 1e-6 * sum);
    EXPECT_NEAR(p.tightest_area, pi * 1e-6, 1e-15);
}

TEST(Expected, AThroatBetweenTheOpeningsIsTheNarrowestAndTheFastest) {
    const auto wide = frame(tube(), driven_by_flow), narrow = frame(throat(), driven_by_flow);
    EXPECT_NEAR(wide->lumen.narrowest, 2 * radius, 0.02 * radius);
    EXPECT_NEAR(narrow->lumen.narrowest, (1 - stenosis) * 2 * radius, 0.02 * radius);
    EXPECT_NEAR(wide->numerics.reference_speed, 2 * 2e-6 / area, 0.01 * 2 * 2e-6 / area);
    // Continuity: between a jet with a flat profile and a parabola, four times the mean.
    EXPECT_GT(narrow->numerics.reference_speed / wide->numerics.reference_speed, 2);
    EXPECT_LT(narrow->numerics.reference_speed / wide->numerics.reference_speed, 4);
    EXPECT_NEAR(narrow->material.sound_speed, 10 * narrow->numerics.reference_speed, 1e-9);
}

TEST(Expected, ABedThrottlesWhatThePressureWouldDrive) {
    const double speed = 2 * 2e-6 / area;
    const auto wide = frame(tube(), before_a_bed, with_a_bed);
    EXPECT_NEAR(wide->numerics.reference_speed, speed, 0.02 * speed);
    EXPECT_NEAR(wide->material.sound_speed, 10 * speed, 0.2 * speed);   // not that of 88 mmHg, 33 m/s
    const auto narrow = frame(throat(), before_a_bed, with_a_bed);
    EXPECT_LT(narrow->numerics.reference_speed, 4 * speed);
    EXPECT_GT(narrow->numerics.reference_speed, 2 * speed);
}

TEST(Expected, NoThroatIsFasterThanThePressureBears) {
    const Vessel severe = followed(make_stenosed_tube(radius, length, 0.85));
    const double bernoulli = std::sqrt(2 * (93 - 5) * 133.322387415 / rho);
    const double fastest = frame(severe, before_a_bed, with_a_bed)->numerics.reference_speed;
    EXPECT_LE(fastest, 1.02 * bernoulli);   // what it brings from the inlet comes on top
    EXPECT_GT(fastest, 0.5 * bernoulli);
}

TEST(Expected, WithoutABedItIsPoiseuillesLessTheEntrance) {
    constexpr double drop = 20;
    const auto scene =
        frame(tube(), "{inlet: {type: pressure, pressure: \"20 Pa\"}, outlet_1: {type: pressure, pressure: \"0 Pa\"}}");
    const double peak = drop / length * radius * radius / (4 * mu);
    EXPECT_LT(scene->numerics.reference_speed, peak);
    EXPECT_GT(scene->numerics.reference_speed, 0.85 * peak);
}

}   // namespace
}   // namespace patency
