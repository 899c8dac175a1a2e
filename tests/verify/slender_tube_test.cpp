// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/slender_tube.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/verify/closed_forms.h"

namespace patency {
namespace {

using std::numbers::pi;

SlenderTube cone(double flow, double length = 0.04) {
    return {[length](double x) { return 2e-3 - 1.5e-3 * x / length; }, length, flow, 1060, 3.5e-3};
}

TEST(SlenderTube, losesWhatPoiseuilleSaysWhereItIsStraight) {
    const SlenderTube tube{[](double) { return 1e-3; }, 0.02, 1e-6, 1060, 3.5e-3};
    EXPECT_NEAR(slender_tube_pressure_drop(tube, 0.005, 0.015) / (0.01 * pipe_pressure_gradient(1e-3, 3.5e-3, 1e-6)), 1,
                1e-6);
}

TEST(SlenderTube, losesInPartsWhatItLosesInAll) {
    const SlenderTube tube = cone(2e-7);
    const double all = slender_tube_pressure_drop(tube, 0, 0.04);
    EXPECT_NEAR(slender_tube_pressure_drop(tube, 0, 0.0171) + slender_tube_pressure_drop(tube, 0.0171, 0.04), all,
                1e-12 * all);
}

// In a radius that falls by the same share everywhere the profile settles, and the slope of the pressure is, to first order in
// d ln R / dt, 2 - 4 d ln R / dt: by hand from (12.11).
TEST(SlenderTube, feelsInertiaAsThePerturbationOfTheParabola) {
    const double flow = 1e-6, nu = 3.5e-3 / 1060, unit = 4 * pi * nu / flow;
    double excess[2];
    for (const int k : {0, 1}) {
        const double rate = (k == 0 ? -0.02 : -0.01) * unit;   // d ln R / dx
        const SlenderTube tube{[rate](double x) { return 1e-3 * std::exp(rate * x); }, 10 / unit, flow, 1060, 3.5e-3};
        const double from = 0.8 * tube.length, to = tube.length;
        const double creeping =
            8 * 3.5e-3 * flow / (pi * 1e-12) * (std::exp(-4 * rate * to) - std::exp(-4 * rate * from)) / (-4 * rate);
        excess[k] = (slender_tube_pressure_drop(tube, from, to) / creeping - 1) / (-2 * rate / unit) - 1;
    }
    EXPECT_LT(std::abs(excess[0]), 0.03);
    EXPECT_NEAR(excess[1] / excess[0], 0.5, 0.05);   // what is left is of second order
}

// Of a creeping flow in a cone (Harrison 1920) the exact loss along the axis differs by a third of the squared slope.
TEST(SlenderTube, missesACreepingFlowInAConeByTheSquareOfItsSlope) {
    for (const double length : {0.04, 0.01}) {
        const double slope = 1.5e-3 / length, c = std::cos(std::atan(slope));
        const SlenderTube tube = cone(1e-12, length);
        const double exact_over_lubrication = 3 * (1 + c) * (1 + c) / (4 * c * (1 + 2 * c));
        const double lubrication =
            8 * tube.viscosity * tube.flow / (3 * pi * slope) * (std::pow(0.5e-3, -3) - std::pow(2e-3, -3));
        const double computed = slender_tube_pressure_drop(tube, 0, length);
        EXPECT_NEAR(computed / lubrication, 1, 1e-4);
        EXPECT_NEAR(exact_over_lubrication - 1, slope * slope / 3, 0.02 * slope * slope);
    }
}

TEST(SlenderTube, convergesWithTheSquareOfItsGrid) {
    const SlenderTube tube = cone(2.6e-7);   // Re from 25 to 100: of the verification case
    double drop[3];
    for (int k = 0; k < 3; ++k)
        drop[k] = slender_tube_pressure_drop(tube, 0, 0.04, {.rings = 50 << k, .steps = 100 << k});
    EXPECT_LT(std::abs(drop[2] - drop[1]), 0.35 * std::abs(drop[1] - drop[0]));
    EXPECT_LT(std::abs(drop[2] / drop[1] - 1), 1e-3);
}

TEST(SlenderTube, refusesAFlowThatTurnsBack) {
    const SlenderTube tube{[](double x) { return 1e-3 + 0.3 * x; }, 0.02, 5e-6, 1060, 3.5e-3};
    EXPECT_THROW(slender_tube_pressure_drop(tube, 0, 0.02), DivergedError);
}

}   // namespace
}   // namespace patency
