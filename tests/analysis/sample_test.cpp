// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/sample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/poiseuille_tube.h"

namespace patency {
namespace {

using testing_analysis::PoiseuilleTube;

// A parabola and a linear pressure are what the fit knows, however far it looks: here near and far by turns.
TEST(SampleFlow, MayLookFarHereAndNearThere) {
    const PoiseuilleTube tube;
    const auto reach = [&](const Vec3& x) { return tube.reach() * (1 + 2 * tube.axial(x) / tube.length); };
    std::vector<Vec3> places;
    for (double x = 2e-3; x < 7e-3; x += 0.31e-3) places.push_back(tube.motion.place({x, 0.4e-3, -0.3e-3}));
    const auto far = sample_flow(tube.fluid, *tube.frame, places, reach, false, &tube.wall);
    const auto near = sample_flow(tube.fluid, *tube.frame, places, tube.reach(), false, &tube.wall);
    for (std::size_t k = 0; k < places.size(); ++k) {
        EXPECT_NEAR(norm(far[k].velocity - tube.velocity(places[k])), 0, 1e-8 * tube.mean_speed);
        EXPECT_NEAR(far[k].pressure, tube.pressure(places[k]), 1e-8);
        const double share = std::pow(reach(places[k]) / tube.reach(), 3);
        EXPECT_GT(far[k].neighbours, (share > 2 ? 1.5 : 1.0) * near[k].neighbours);
        if (k > 0) {
            EXPECT_GE(far[k].neighbours, 0.9 * far[k - 1].neighbours);
        }
    }
}

TEST(SampleFlow, SeesNothingOfNoPlaces) {
    const PoiseuilleTube tube;
    EXPECT_TRUE(sample_flow(tube.fluid, *tube.frame, {}, tube.reach(), false).empty());
}

}   // namespace
}   // namespace patency
