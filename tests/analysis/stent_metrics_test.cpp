// SPDX-License-Identifier: Apache-2.0
// A stent's figures on shapes whose figures are known.
#include "patency/analysis/stent_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;

/// Places on the face r(angle, along) of a stent of 10 mm; only at some angles if struts are sparse.
std::vector<StentPoint> face(const std::function<double(double, double)>& radius, int around = 120, int along = 101) {
    std::vector<StentPoint> places;
    for (int j = 0; j < along; ++j)
        for (int k = 0; k < around; ++k) {
            const double s = 10e-3 * (double(j) / (along - 1) - 0.5), angle = 2 * pi * k / around;
            places.push_back({radius(angle, s), angle, s});
        }
    return places;
}

TEST(StentProfile, OfACylinderIsItsDiameter) {
    const StentProfile shape = measure_stent_profile(face([](double, double) { return 1.5e-3; }, 7), 8);
    EXPECT_NEAR(shape.length, 10e-3, 1e-15);
    for (const double d :
         {shape.least_diameter, shape.mean_diameter, shape.most_diameter, shape.end_diameter, shape.middle_diameter})
        EXPECT_NEAR(d, 3e-3, 1e-15);
    EXPECT_NEAR(shape.least_area, pi * 2.25e-6, 1e-18);
    EXPECT_NEAR(dogboning(shape), 0, 1e-14);
}

TEST(StentProfile, KnowsAnEllipseAndAWaist) {
    // r^2 = a^2 b^2 / (b^2 cos^2 + a^2 sin^2): area pi a b
    const double a = 1.6e-3, b = 1.2e-3;
    const StentProfile oval = measure_stent_profile(
        face([=](double t, double) { return a * b / std::hypot(b * std::cos(t), a * std::sin(t)); }, 720), 5);
    EXPECT_NEAR(oval.least_area, pi * a * b, 1e-3 * pi * a * b);
    EXPECT_NEAR(oval.slices[2].least_diameter, 2 * b, 1e-9);
    EXPECT_NEAR(oval.slices[2].most_diameter, 2 * a, 1e-9);
    // A waist: 1 mm in the middle, 1.5 mm at the ends, linear between.
    const StentProfile waist =
        measure_stent_profile(face([](double, double s) { return 1e-3 + 0.1 * std::abs(s); }, 90, 2001), 101);
    EXPECT_NEAR(waist.least_diameter, 2e-3, 0.02e-3);
    EXPECT_NEAR(waist.most_diameter, 3e-3, 0.02e-3);
    EXPECT_NEAR(waist.end_diameter, 2.9e-3, 0.01e-3);      // the mean over the last tenths: 1.45 mm
    EXPECT_NEAR(waist.middle_diameter, 2.1e-3, 0.01e-3);   // the mean over the middle fifth: 1.05 mm
    EXPECT_NEAR(dogboning(waist), 0.8 / 2.9, 0.005);
}

TEST(StentProfile, NeedsStrutsInEverySlice) {
    EXPECT_THROW(measure_stent_profile(face([](double, double) { return 1e-3; }, 3, 4), 8), GeometryError);
    EXPECT_THROW(measure_stent_profile({}, 8), GeometryError);
}

TEST(StentShares, AreOfWhatWasBefore) {
    EXPECT_DOUBLE_EQ(recoil(3.3, 3.135), (3.3 - 3.135) / 3.3);
    EXPECT_DOUBLE_EQ(foreshortening(18, 17.1), (18 - 17.1) / 18);
}

TEST(ReachToWall, IsTheWayToIt) {
    const SignedDistance tube = round_tube(2e-3);
    EXPECT_NEAR(reach_to_wall(tube, {}, {0, 1, 0}, 10e-3), 2e-3, 2e-6);
    EXPECT_NEAR(reach_to_wall(tube, {0, 1e-3, 0}, {0, 1, 0}, 10e-3), 1e-3, 2e-6);
    const double tilt = 0.3;
    EXPECT_NEAR(reach_to_wall(tube, {}, {std::cos(tilt), std::sin(tilt), 0}, 10e-3), 2e-3 / std::sin(tilt), 10e-6);
    EXPECT_DOUBLE_EQ(reach_to_wall(tube, {}, {1, 0, 0}, 10e-3), 10e-3);
}

TEST(StrutFit, TellsMalapposedStrutsByTheirArea) {
    const SignedDistance tube = round_tube(1.5e-3);
    // gaps 0, 0.05, 0.2 mm and one 0.03 mm beyond the wall; areas 1, 2, 3, 4
    const std::vector<Vec3> places = {{0, 1.5e-3, 0}, {1e-3, 0, 1.45e-3}, {0, -1.3e-3, 0}, {0, 1.53e-3, 0}};
    const std::vector<double> areas = {1, 2, 3, 4};
    const StrutFit fit = measure_fit(places, areas, {}, tube);
    EXPECT_NEAR(fit.gap[0], 0, 1e-12);
    EXPECT_NEAR(fit.gap[1], 0.05e-3, 1e-12);
    EXPECT_NEAR(fit.gap[3], -0.03e-3, 1e-12);
    EXPECT_DOUBLE_EQ(fit.malapposed, 0.3);
    EXPECT_NEAR(fit.largest_gap, 0.2e-3, 1e-12);
    EXPECT_DOUBLE_EQ(fit.over_ostia, 0);
}

TEST(JailedOstia, HaveTheAreaOfTheSideBranchOnTheStent) {
    // A side branch of radius b across a main one of the stent's radius a: on the cylinder, area 4 int_0^b a asin(y/a) ... =
    // int over |along| < b of 2 a asin(sqrt(b^2 - s^2) / a).
    const double a = 1.5e-3, b = 0.8e-3;
    const SignedDistance y =
        union_of_round_cones({{{-20e-3, 0, 0}, {20e-3, 0, 0}, a, a}, {{0, 0, 0}, {0, 15e-3, 0}, b, b}});
    const StentProfile shape = measure_stent_profile(face([=](double, double) { return a; }), 10);
    double expected = 0;
    const int n = 2000;
    for (int k = 0; k < n; ++k) {
        const double s = b * (2 * (k + 0.5) / n - 1);
        expected += 2 * a * std::asin(std::sqrt(b * b - s * s) / a) * 2 * b / n;
    }
    const std::vector<JailedOstium> ostia = find_jailed_ostia(shape, {}, y);
    ASSERT_EQ(ostia.size(), 1u);
    // Seen from the axis, a ray leaves through the branch only if it does so still at twice the radius: a cone of half that angle across.
    double seen = 0;
    for (int k = 0; k < n; ++k) {
        const double s = b * (2 * (k + 0.5) / n - 1);
        seen += 2 * a * std::asin(std::sqrt(b * b - s * s) / (2 * a)) * 2 * b / n;
    }
    EXPECT_GT(ostia[0].area, 0.95 * seen);
    EXPECT_LT(ostia[0].area, 1.05 * expected);
    EXPECT_NEAR(ostia[0].centre.x, 0, 0.05e-3);
    EXPECT_GT(ostia[0].centre.y, 0.9 * a);
    // A strut in front of it is not malapposed, one in front of the wall is.
    const std::vector<Vec3> places = {{0, 1.3e-3, 0}, {0, -1.3e-3, 0}};
    const std::vector<double> areas = {1, 1};
    const StrutFit fit = measure_fit(places, areas, {}, y);
    EXPECT_TRUE(fit.is_over_ostium[0]);
    EXPECT_FALSE(fit.is_over_ostium[1]);
    EXPECT_DOUBLE_EQ(fit.over_ostia, 1);
    EXPECT_DOUBLE_EQ(fit.malapposed, 1);
}

TEST(JailedOstia, ThereAreNoneInATube) {
    const StentProfile shape = measure_stent_profile(face([](double, double) { return 1.5e-3; }), 10);
    EXPECT_TRUE(find_jailed_ostia(shape, {}, round_tube(1.6e-3)).empty());
}

TEST(WeightedPercentile, CountsWeights) {
    const std::vector<double> values = {3, 1, 2}, weights = {1, 1, 2};
    EXPECT_DOUBLE_EQ(weighted_percentile(values, weights, 0.2), 1);
    EXPECT_DOUBLE_EQ(weighted_percentile(values, weights, 0.5), 2);
    EXPECT_DOUBLE_EQ(weighted_percentile(values, weights, 0.75), 2);
    EXPECT_DOUBLE_EQ(weighted_percentile(values, weights, 0.99), 3);
    EXPECT_DOUBLE_EQ(weighted_percentile({}, {}, 0.5), 0);
}

/// A strut of 0.13 mm, its places 25 um apart, on which a wall with vertices 0.1 mm apart presses with 0.7 MPa: the same pressure however
/// coarse the wall is, where single vertices of the strut bear many times as much; none where it does not press.
TEST(PressuresOn, AFaceAreThoseOfTheWallHoweverCoarseItIs) {
    constexpr double place = 25e-6, pressure = 0.7e6, width = 0.13e-3, length = 4e-3;
    std::vector<Vec3> places;
    std::vector<double> areas;
    for (double x = place / 2; x < length; x += place)
        for (double y = width / 10; y < width; y += width / 5)
            places.push_back({y, x, 1.6e-3}), areas.push_back(place * width / 5);
    for (const double apart : {0.05e-3, 0.1e-3}) {
        std::vector<PressedPlace> presses;
        for (double x = apart / 2; x < length / 2; x += apart)
            presses.push_back({{0.3 * width, x, 1.6e-3}, 0.4 * pressure * apart * width}),
                presses.push_back({{0.8 * width, x + 0.2 * apart, 1.6e-3}, 0.6 * pressure * apart * width});
        const std::vector<double> found = pressures_on(places, areas, presses, 0.2e-3);
        ASSERT_EQ(found.size(), places.size());
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double x = places[k].y;
            if (x < length / 2 - 0.2e-3) {
                EXPECT_NEAR(found[k], pressure, (apart < 0.06e-3 ? 0.15 : 0.3) * pressure) << x;
            } else if (x > length / 2 + 0.2e-3) {
                EXPECT_EQ(found[k], 0) << x;
            }
        }
        EXPECT_NEAR(weighted_percentile(found, areas, 0.75), pressure, 0.1 * pressure);   // the median of its half
    }
    EXPECT_TRUE(pressures_on({}, {}, {}, 1e-3).empty());
}

}   // namespace
}   // namespace patency
