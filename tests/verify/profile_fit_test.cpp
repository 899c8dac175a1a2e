// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/profile_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "patency/base/errors.h"
#include "patency/verify/sampling_of_scene.h"

namespace patency {
namespace {

TEST(ProfileFit, a_parabola_comes_out_exactly_at_every_station) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(0, 1);
    ProfileFit fit(0.05, 0.1, 10);
    const auto f = [](double y) { return 3 - 2 * y + 7 * y * y; };
    for (int i = 0; i < 300; ++i) {
        const double y = place(random);
        fit.add(y, f(y), 0.1 + place(random));
    }
    // The normal equations lose about the condition of three monomials on -2.5..2.5, some hundreds, of 1e-16.
    for (std::size_t k = 0; k < 10; ++k) EXPECT_NEAR(fit.values()[k], f(fit.stations()[k]), 1e-12);
}

TEST(ProfileFit, rows_of_a_lattice_are_enough_also_at_the_edge) {
    ProfileFit fit(0.5, 1, 8);
    for (int k = 0; k < 8; ++k) fit.add(k + 0.5, k * k, 1);
    EXPECT_NEAR(fit.values().front(), 0, 1e-12);
    EXPECT_NEAR(fit.values()[4], 16, 1e-12);
}

TEST(ProfileFit, says_where_particles_are_missing) {
    ProfileFit fit(0.5, 1, 8);
    for (int k = 0; k < 4; ++k) fit.add(k + 0.5, 1, 1);
    EXPECT_THROW(fit.values(), GeometryError);
}

TEST(WallFit, slope_of_a_parabola_through_zero) {
    WallFit fit;
    for (const double s : {0.4, 1.1, 1.7, 2.6}) fit.add(s, 5 * s - 2 * s * s, 1 + s);
    EXPECT_NEAR(fit.slope(), 5, 1e-12);
    WallFit one;
    one.add(1, 1, 1);
    EXPECT_THROW(one.slope(), GeometryError);
}

TEST(PipeProfile, flow_of_a_parabola_is_exact_though_particles_keep_off_the_wall) {
    constexpr double dp = 0.1, radius = 1;
    ProfileFit fit(0.25 * dp, 0.5 * dp, 20, 4);
    for (double r = 0.02; r < radius - 0.5 * dp; r += 0.013) fit.add(r, 1 - r * r, r);
    EXPECT_NEAR(flow_through(fit, radius), 0.5 * 3.14159265358979, 1e-12);
}

}   // namespace
}   // namespace patency
