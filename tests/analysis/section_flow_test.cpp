// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/section_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/analysis/poiseuille_tube.h"

namespace patency {
namespace {

using testing_analysis::PoiseuilleTube;
constexpr double pi = std::numbers::pi;

TEST(SectionGrid, OfATubeIsADisc) {
    const PoiseuilleTube tube;
    for (double off : {0.0, 0.4}) {   // the centre need not be on the axis
        const SectionPlane plane{tube.motion.place({4e-3, off * tube.radius, 0}), tube.axis(), tube.radius};
        const SectionGrid grid = make_section_grid(plane, tube.wall);
        EXPECT_TRUE(grid.closed);
        EXPECT_NEAR(grid.total_area() / (pi * tube.radius * tube.radius), 1, 5e-3);
        for (const Vec3& x : grid.place) {
            EXPECT_LT(tube.radial(x), tube.radius);
            EXPECT_NEAR(tube.axial(x), 4e-3, 1e-12);
        }
    }
}

TEST(SectionGrid, CutAtAnAngleIsAnEllipse) {
    const PoiseuilleTube tube;
    const Vec3 normal = tube.motion.turn({std::cos(0.5), std::sin(0.5), 0});
    const SectionGrid grid = make_section_grid({tube.motion.place({4e-3, 0, 0}), normal, tube.radius}, tube.wall);
    EXPECT_NEAR(grid.total_area() * std::cos(0.5) / (pi * tube.radius * tube.radius), 1, 1e-2);
}

TEST(SectionGrid, AlongTheVesselIsNotClosed) {
    const PoiseuilleTube tube;
    const SectionGrid grid =
        make_section_grid({tube.motion.place({4e-3, 0, 0}), tube.motion.turn({0, 1, 0}), tube.radius}, tube.wall);
    EXPECT_FALSE(grid.closed);
}

TEST(SectionGrid, DoesNotSeeAnotherVesselInItsPlane) {
    WallHint two;   // tubes of radius 1 along x at y = 0 and y = 2.5
    two.distance = [](const Vec3& x) { return std::min(std::hypot(x.y, x.z), std::hypot(x.y - 2.5, x.z)) - 1; };
    two.normal = [](const Vec3& x) { return normalized(x.y < 1.25 ? Vec3{0, x.y, x.z} : Vec3{0, x.y - 2.5, x.z}); };
    EXPECT_NEAR(make_section_grid({{0, 0, 0}, {1, 0, 0}, 1}, two).total_area() / pi, 1, 5e-3);
}

TEST(SectionFlow, OfAParabola) {
    const PoiseuilleTube tube;
    std::vector<SectionGrid> grids;
    for (double axial : {3e-3, 6e-3})
        grids.push_back(make_section_grid({tube.motion.place({axial, 0, 0}), tube.axis(), tube.radius}, tube.wall));
    const auto flows = flow_through_sections(tube.fluid, *tube.frame, grids, tube.reach(), tube.wall);
    const double area = pi * tube.radius * tube.radius;
    ASSERT_EQ(flows.size(), 2u);
    for (const SectionFlow& f : flows) {
        EXPECT_NEAR(f.flow / (area * tube.mean_speed), 1, 0.01);
        EXPECT_NEAR(f.mean_velocity / tube.mean_speed, 1, 0.01);
        EXPECT_NEAR(f.peak_velocity / (2 * tube.mean_speed), 1, 0.01);
    }
    EXPECT_NEAR(flows[0].pressure, 900 + tube.slope * 3e-3, 0.01);
    EXPECT_NEAR(flows[1].pressure, 900 + tube.slope * 6e-3, 0.01);
}

TEST(SectionFlow, OfABluntProfileLosesNothingAtTheWall) {
    PoiseuilleTube tube;
    const auto share = [&](const Vec3& x) { return tube.radial(x) / tube.radius; };
    for (std::size_t i = 0; i < tube.fluid.size(); ++i)   // its mean is 0.8 of the middle's
        tube.fluid.velocity[i] = (1 - std::pow(share(tube.fluid.position[i]), 8)) * tube.axis();
    const std::vector<SectionGrid> grid{
        make_section_grid({tube.motion.place({4.5e-3, 0, 0}), tube.axis(), tube.radius}, tube.wall)};
    const SectionFlow f = flow_through_sections(tube.fluid, *tube.frame, grid, tube.reach(), tube.wall)[0];
    EXPECT_NEAR(f.mean_velocity / 0.8, 1, 0.02);   // samples smooth the profile and would give less
}

TEST(SectionFlow, AgainstTheNormalIsNegative) {
    const PoiseuilleTube tube;
    const std::vector<SectionGrid> grid{
        make_section_grid({tube.motion.place({4e-3, 0, 0}), -1.0 * tube.axis(), tube.radius}, tube.wall)};
    EXPECT_LT(flow_through_sections(tube.fluid, *tube.frame, grid, tube.reach(), tube.wall)[0].flow, 0);
}

}   // namespace
}   // namespace patency
