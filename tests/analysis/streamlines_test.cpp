// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/streamlines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/poiseuille_tube.h"

namespace patency {
namespace {

using testing_analysis::PoiseuilleTube;

StreamlineRule rule_of(const PoiseuilleTube& tube) {
    return {.step = tube.spacing,
            .longest = 0.1,
            .slowest = 1e-3,
            .reach = tube.reach(),
            .is_inside = [&tube](const Vec3& x) {
                return tube.radial(x) < tube.radius && tube.axial(x) < tube.length - 1e-3;
            }};
}

TEST(Streamlines, OfAParabolaAreParallelToTheAxis) {
    const PoiseuilleTube tube;
    std::vector<Vec3> seeds;
    for (double r : {0.0, 0.5e-3, 1.2e-3}) seeds.push_back(tube.motion.place({1e-3, r, 0}));
    const auto lines = trace_streamlines(tube.fluid, *tube.frame, seeds, rule_of(tube), tube.wall);
    ASSERT_EQ(lines.size(), 3u);
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const Streamline& line = lines[k];
        ASSERT_GT(line.points.size(), 20u);
        EXPECT_EQ(line.points.front(), seeds[k]);
        EXPECT_EQ(line.velocity.size(), line.points.size());
        EXPECT_NEAR(tube.radial(line.points.back()), tube.radial(seeds[k]), 1e-3 * tube.radius);
        EXPECT_GT(tube.axial(line.points.back()),
                  tube.length - 1e-3 - 1.5 * tube.spacing);   // to the end of the domain
        for (std::size_t n = 0; n < line.points.size(); ++n) {
            EXPECT_NEAR(norm(line.velocity[n] - tube.velocity(line.points[n])), 0, 0.01 * tube.mean_speed);
            EXPECT_NEAR(line.pressure[n], tube.pressure(line.points[n]), 1e-6);
        }
        for (std::size_t n = 1; n < line.points.size(); ++n)
            EXPECT_NEAR(norm(line.points[n] - line.points[n - 1]), tube.spacing, 1e-12);
    }
}

TEST(Streamlines, EndWhereTheBloodStandsOrThereIsNone) {
    PoiseuilleTube tube;
    StreamlineRule rule = rule_of(tube);
    rule.slowest = 10;
    const std::vector<Vec3> seeds{tube.motion.place({1e-3, 0, 0}), tube.motion.place({1, 0, 0})};
    const auto lines = trace_streamlines(tube.fluid, *tube.frame, seeds, rule, tube.wall);
    EXPECT_EQ(lines[0].points.size(), 1u);
    EXPECT_TRUE(lines[1].points.empty());
}

}   // namespace
}   // namespace patency
