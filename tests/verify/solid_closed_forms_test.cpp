// SPDX-License-Identifier: Apache-2.0
// Closed forms of solids in their limits, and against figures computed elsewhere.
#include "patency/verify/solid_closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace patency;

TEST(Cantilever, ASlenderOneIsEulersAndAThickOneIsSlower) {
    const ElasticModuli m = elastic_moduli({.young = 2e6, .poisson = 0.4, .shear = {}, .bulk = {}});
    const auto slender = [&](double height) {
        const double E = m.young() / (1 - 0.16);
        return 3.5160153 * std::sqrt(E * height * height / 12 / 1000);
    };
    EXPECT_NEAR(cantilever_frequency({1, 0.002, 1000, m}), slender(0.002), 1e-5 * slender(0.002));
    const double ratio = cantilever_frequency({1, 0.1, 1000, m}) / slender(0.1);
    EXPECT_LT(ratio, 0.995);   // shear and turning inertia cost it about (H/L)^2
    EXPECT_GT(ratio, 0.98);
    EXPECT_NEAR(cantilever_shape({1, 0.1, 1000, m}, 1), 1, 1e-12);
    EXPECT_NEAR(cantilever_shape({1, 0.002, 1000, m}, 0.5), 0.33952, 1e-4);   // of the first mode (Euler and Bernoulli)
}

TEST(RubberTube, NearlyIncompressibleItHasTheClosedForm) {
    const ElasticModuli m = elastic_moduli({.young = {}, .poisson = {}, .shear = 1, .bulk = 1e6});
    const RubberTube tube{1, 1.5, NeoHookean::from(m)};
    for (const double la : {1.02, 1.1, 1.2, 1.5}) {
        const double lb = std::sqrt(1 + (la * la - 1) / 2.25);
        EXPECT_NEAR(tube_pressure(tube, la), std::log(la / lb) + 0.5 * (1 / (lb * lb) - 1 / (la * la)), 1e-5) << la;
    }
    EXPECT_NEAR(tube_radius(tube, 0.094789), 1.1, 1e-4);
}

TEST(RubberTube, AtSmallStrainItIsLames) {
    const ElasticModuli m = elastic_moduli({.young = 1, .poisson = 0.45, .shear = {}, .bulk = {}});
    const RubberTube tube{1, 1.5, NeoHookean::from(m)};
    // u(A) = p A (1 + nu) [(1 - 2 nu) A^2 + B^2] / (E (B^2 - A^2))
    EXPECT_NEAR(tube_pressure(tube, 1 + 1e-5), 1e-5 / (1.45 * (0.1 + 2.25) / 1.25), 1e-9);
}

TEST(PlasticTube, StressesBalanceAndVanishOutside) {
    const double A = 1, B = 2, yield = 3, p = 0.85 * collapse_pressure(A, B, yield), c = plastic_radius(A, B, yield, p);
    EXPECT_GT(c, A);
    EXPECT_LT(c, B);
    EXPECT_NEAR(residual_stress(A, B, yield, p, A).radial, 0, 1e-9);
    EXPECT_NEAR(residual_stress(A, B, yield, p, B).radial, 0, 1e-9);
    EXPECT_LT(residual_stress(A, B, yield, p, A).hoop, 0) << "the bore stays compressed";
    double force = 0;   // the hoop stress of a tube without load adds up to nothing
    constexpr int n = 4000;
    for (int k = 0; k < n; ++k) force += residual_stress(A, B, yield, p, A + (k + 0.5) / n).hoop / n;
    EXPECT_NEAR(force, 0, 1e-3);
}

TEST(Hertz, LoadWidthAndPressureAreOne) {
    const HertzLine line{0.1, 1e6};
    EXPECT_NEAR(line.peak_pressure(50) * line.half_width(50) * 3.14159265358979 / 2, 50, 1e-9);
    EXPECT_NEAR(hertz_force(4, 3, 0.25), 4 * 2 * 0.125, 1e-12);
    // At the surface both bodies' parts are the approach; far below a point force's displacement is left.
    const double young = 5, nu = 0.3, modulus = young / (2 * (1 - nu * nu)), force = hertz_force(4, modulus, 0.25);
    EXPECT_NEAR(hertz_sinking(4, modulus, force, young, nu, 0), 0.125, 1e-7);
    EXPECT_NEAR(hertz_sinking(4, modulus, force, young, nu, 100),
                (1 + nu) * (3 - 2 * nu) * force / (2 * std::numbers::pi * young * 100), 1e-4 * force / 500);
}
