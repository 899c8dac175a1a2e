// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/fluid/rheology.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

const Rheology laws[] = {blood_newtonian, blood_carreau, blood_carreau_yasuda, blood_casson, blood_power_law};

TEST(Rheology, is_positive_finite_and_never_thickens) {
    for (const Rheology& law : laws) {
        double before = viscosity(law, 0.0);
        for (double g = 1e-9; g < 1e7; g *= 1.3) {
            const double mu = viscosity(law, g);
            ASSERT_TRUE(std::isfinite(mu)) << law.index() << " " << g;
            ASSERT_GT(mu, 0);
            ASSERT_LE(mu, before * (1 + 1e-14)) << law.index() << " " << g;
            before = mu;
        }
    }
}

TEST(Rheology, shear_stress_never_falls_with_shear_rate) {   // else a steady flow would not be unique
    for (const Rheology& law : laws)
        for (double g = 1e-6; g < 1e6; g *= 1.3)
            ASSERT_GT(viscosity(law, 1.3 * g) * 1.3 * g, viscosity(law, g) * g) << law.index() << " " << g;
}

TEST(Rheology, carreau_has_its_plateaus) {
    EXPECT_DOUBLE_EQ(viscosity(blood_carreau, 0.0), 0.056);
    // Far out the bracket is (lambda g)^(n-1) = 3.3e9^-0.64 = 7e-7 of the difference of the plateaus.
    EXPECT_NEAR(viscosity(blood_carreau, 1e9), 0.00345, 1e-6 * 0.056);
}

TEST(Rheology, carreau_knee) {
    // At g = 1/lambda the bracket is 2 whatever a is.
    for (const CarreauYasuda& law : {blood_carreau, blood_carreau_yasuda}) {
        const double share = std::pow(2.0, (law.index - 1) / law.transition);
        EXPECT_NEAR(viscosity(law, 1 / law.relaxation_time), 0.00345 + 0.05255 * share, 1e-15);
    }
}

TEST(Rheology, index_one_is_newtonian) {
    for (double g : {0.0, 1e-3, 1.0, 1e3}) {
        EXPECT_DOUBLE_EQ(viscosity(CarreauYasuda{0.056, 0.00345, 3.313, 1.0, 2}, g), 0.056);
        EXPECT_DOUBLE_EQ(viscosity(PowerLaw{0.0035, 1.0, 1e-6, 1.0}, g), 0.0035);
        EXPECT_DOUBLE_EQ(viscosity(Casson{0.0, 0.0035}, g), 0.0035);
    }
}

TEST(Rheology, casson_is_the_law_of_square_roots_at_high_shear_and_finite_at_rest) {
    const Casson law = blood_casson;
    for (double g : {10.0, 100.0, 1000.0}) {
        // The exponential leaves e^(-sqrt(m g)) = e^(-31) of sqrt(tau_y) at g = 10.
        const double stress = viscosity(law, g) * g;
        EXPECT_NEAR(std::sqrt(stress), std::sqrt(law.yield_stress) + std::sqrt(law.plastic_viscosity * g), 1e-12);
    }
    const double root = std::sqrt(law.plastic_viscosity) + std::sqrt(law.yield_stress * law.regularisation_time);
    EXPECT_NEAR(viscosity(law, 0.0), root * root, 1e-14);
}

TEST(Rheology, power_law_is_clamped) {
    EXPECT_EQ(viscosity(blood_power_law, 0.0), 0.056);
    EXPECT_EQ(viscosity(blood_power_law, 1e9), 0.00345);
    EXPECT_DOUBLE_EQ(viscosity(blood_power_law, 100.0), 0.017 * std::pow(100.0, -0.292));
}

TEST(Rheology, largest_viscosity_bounds_the_law) {
    for (const Rheology& law : laws)
        for (double g = 0; g < 1e4; g = 2 * g + 1e-3) EXPECT_LE(viscosity(law, g), largest_viscosity(law));
}

TEST(Rheology, blood_laws_agree_where_blood_is_measured_best) {
    // Whole blood at 100/s and 37 degrees C is 4 to 6 mPa s in every published set: catches a slipped unit.
    for (const Rheology& law :
         {Rheology(blood_carreau), Rheology(blood_carreau_yasuda), Rheology(blood_casson), Rheology(blood_power_law)}) {
        EXPECT_GT(viscosity(law, 100.0), 0.004);
        EXPECT_LT(viscosity(law, 100.0), 0.006);
    }
}

TEST(Rheology, single_precision_follows_double) {
    for (double g : {0.0, 0.1, 10.0, 1000.0}) {
        // pow amplifies the rounding of its argument by the exponent, below 2: some ten epsilons of float.
        EXPECT_NEAR(viscosity(blood_carreau, float(g)), viscosity(blood_carreau, g), 1e-6 * 0.056);
        EXPECT_NEAR(viscosity(blood_casson, float(g)), viscosity(blood_casson, g), 2e-6 * viscosity(blood_casson, g));
    }
}

TEST(Rheology, wall_shear_rate_of_a_newtonian_pipe) {
    const PowerLaw newtonian{0.0035, 1.0, 1e-6, 1.0};
    EXPECT_DOUBLE_EQ(wall_shear_rate(newtonian, 0.002, 1e-6), 4e-6 / (std::numbers::pi * 8e-9));
}

}   // namespace
}   // namespace patency
