// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/tree/profile_march.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

namespace patency {
namespace {

constexpr double pi = std::numbers::pi, mu = 3.5e-3, rho = 1060;
const TreeBlood blood{rho, [](double) { return mu; }};

struct Tube {
    std::vector<double> arc, area;
};

/// Stations along a tube of a diameter that depends on the place.
template <class Diameter>
Tube tube(double length, Diameter diameter, int stations = 201) {
    Tube t;
    for (int k = 0; k < stations; ++k) {
        t.arc.push_back(length * k / (stations - 1));
        t.area.push_back(pi / 4 * std::pow(diameter(t.arc.back()), 2));
    }
    return t;
}

double mean(const TreeProfile& p) {
    double sum = 0;
    for (double v : p.speed) sum += v / TreeProfile::rings;
    return sum;
}

TEST(ProfileMarch, AParabolaStaysOneAndLosesWhatPoiseuilleSays) {
    const Tube t = tube(0.03, [](double) { return 3e-3; });
    const auto [pressure, profile] = march_profile(blood, t.arc, t.area, 1e-6, TreeProfile::between(0));
    const double drop = 128 * mu * 0.03 * 1e-6 / (pi * std::pow(3e-3, 4));
    EXPECT_NEAR(pressure.back() / -drop, 1, 1e-8);
    EXPECT_NEAR(pressure[100] / -drop, 0.5, 1e-8);
    for (int i = 0; i < TreeProfile::rings; ++i)
        EXPECT_NEAR(profile.back().speed[std::size_t(i)], TreeProfile::between(0).speed[std::size_t(i)], 1e-8);
}

TEST(ProfileMarch, AnyProfileEndsAsTheParabolaAndCarriesTheFlow) {
    const Tube t = tube(0.5, [](double) { return 3e-3; });   // Re 129: an entrance is 0.02 m long
    for (double flat : {0.5, 1.0}) {
        const TreeProfile p = march_profile(blood, t.arc, t.area, 1e-6, TreeProfile::between(flat)).profile.back();
        EXPECT_NEAR(mean(p), 1, 1e-9);
        EXPECT_NEAR(p.speed[0], TreeProfile::between(0).speed[0], 1e-6);
    }
}

/// Of a plug in a tube, over what a parabola loses: Shah & London 1978 (their equation 192), x = z / (D Re).
double entrance_excess(double x) {
    const double root = std::sqrt(x);
    const double apparent = (16 + 0.3125 / x - 3.44 / root) / (1 + 0.00021 / (x * x)) + 3.44 / root;   // f Re
    return 4 * (apparent - 16) * x;
}

TEST(ProfileMarch, APlugLosesTheExcessOfAnEntrance) {
    const double flow = 1e-6, diameter = 3e-3, area = pi / 4 * diameter * diameter, speed = flow / area;
    const double reynolds = rho * speed * diameter / mu;
    for (double x : {0.001, 0.01, 0.05, 0.2}) {
        const Tube t = tube(x * diameter * reynolds, [](double) { return 3e-3; });
        const double drop = -march_profile(blood, t.arc, t.area, flow, TreeProfile::between(1)).pressure.back();
        const double excess =
            (drop - 128 * mu * t.arc.back() * flow / (pi * std::pow(diameter, 4))) / (0.5 * rho * speed * speed);
        EXPECT_NEAR(excess, entrance_excess(x), 0.1) << x;
    }
}

TEST(ProfileMarch, ASlowConeIsPoiseuilleIntegrated) {
    const double flow = 1e-9, length = 0.03;   // Re 0.5: momentum counts for nothing
    const Tube t = tube(
        length, [=](double s) { return 4e-3 - 2e-3 * s / length; }, 2001);
    const double friction = 128 * mu * flow / pi * length / (3 * 2e-3) * (std::pow(2e-3, -3) - std::pow(4e-3, -3));
    EXPECT_NEAR(march_profile(blood, t.arc, t.area, flow, TreeProfile::between(0)).pressure.back() / -friction, 1,
                2e-3);
}

TEST(ProfileMarch, AFastContractionIsBernoulli) {   // too short for friction
    const double flow = 5e-6, length = 2e-4;
    const Tube t = tube(length, [=](double s) { return 4e-3 - 2e-3 * s / length; });
    const double bernoulli = 0.5 * rho * flow * flow * (std::pow(t.area.back(), -2) - std::pow(t.area.front(), -2));
    const double drop = -march_profile(blood, t.arc, t.area, flow, TreeProfile::between(1)).pressure.back();
    EXPECT_GT(drop, bernoulli);
    EXPECT_LT(drop, 1.1 * bernoulli);
}

TEST(ProfileMarch, AJetGivesBackPartOfItsPressureAndThenLosesMore) {
    const Tube t = tube(
        0.06, [](double s) { return 3e-3 - 1.5e-3 * std::exp(-std::pow((s - 0.02) / 2e-3, 2)); }, 601);
    const auto pressure = march_profile(blood, t.arc, t.area, 2e-6, TreeProfile::between(0)).pressure;
    const auto throat = std::min_element(pressure.begin(), pressure.begin() + 300);
    const double bernoulli = 0.5 * rho * std::pow(2e-6 / t.area[200], 2) * (1 - 1.0 / 16);
    const double regained = *std::max_element(throat, pressure.end()) - *throat;
    EXPECT_GT(regained, 0.02 * bernoulli);
    EXPECT_LT(regained, 0.80 * bernoulli);
}

TEST(ProfileMarch, AThroatThatIsNearlyClosedIsPassedToo) {
    // 0.45 mm and 0.3 mm wide behind 3 mm: pressures grow with the square of the flow, as jets' do, however much there is of it.
    for (double depth : {0.85, 0.9}) {
        const Tube t = tube(
            0.03, [=](double s) { return 3e-3 * (1 - depth * std::exp(-std::pow((s - 0.015) / 1e-3, 2))); }, 301);
        const auto drop = [&](double flow) {
            return -march_profile(blood, t.arc, t.area, flow, TreeProfile::between(0)).pressure.back();
        };
        const double some = drop(0.25e-6), twice = drop(0.5e-6);
        EXPECT_GT(twice, 3 * some) << depth;
        EXPECT_LT(twice, 4.2 * some) << depth;
    }
}

TEST(ProfileMarch, StationsAreOnlyWhereOneLooks) {
    const auto throat = [](double s) { return 3e-3 - 1e-3 * std::exp(-std::pow((s - 0.02) / 3e-3, 2)); };
    const Tube coarse = tube(0.04, throat, 161), fine = tube(0.04, throat, 1281);
    const TreeProfile p = TreeProfile::between(0);
    EXPECT_NEAR(march_profile(blood, coarse.arc, coarse.area, 1e-6, p).pressure.back() /
                    march_profile(blood, fine.arc, fine.area, 1e-6, p).pressure.back(),
                1, 0.02);
}

TEST(ProfileMarch, AProfileIsReadBetweenItsRingsAndIsNoughtAtTheWall) {
    const TreeProfile parabola = TreeProfile::between(0);
    for (double r : {0.2, 0.5, 0.77, 0.95, 1.0}) EXPECT_NEAR(parabola.at(r), 2 * (1 - r * r), 1e-12) << r;
    EXPECT_NEAR(parabola.at(0), 2, 1.1 / TreeProfile::rings);
}

TEST(ProfileMarch, NoFlowNoLoss) {
    const Tube t = tube(0.04, [](double) { return 3e-3; });
    const auto [pressure, profile] = march_profile(blood, t.arc, t.area, 0, TreeProfile::between(1));
    for (double v : pressure) EXPECT_EQ(v, 0);
    EXPECT_EQ(profile.back().speed[0], 1);
}

/// A patient's lesion of 84 % area, as finite volumes have it: through the throat, and what comes back behind.
TEST(ProfileMarch, APatientsLesionDropsAndRecoversAsFiniteVolumesSay) {
    std::ifstream file(std::string(PATENCY_SOURCE_DIR) + "/../shared/reference/left_coronary_tree/finite_volume.json");
    if (!file) GTEST_SKIP() << "../shared is not here";
    const auto reference = nlohmann::json::parse(file);
    Tube t;
    std::vector<double> exact;
    for (const auto& s : reference["lesion_sections"]) {
        t.arc.push_back(1e-3 * double(s["arc_mm"])), t.area.push_back(1e-6 * double(s["area_mm2"]));
        exact.push_back(s["mean_pressure_pa"]);
    }
    const auto pressure =
        march_profile(blood, t.arc, t.area, reference["lesion"]["flow_m3_per_s"], TreeProfile::between(0)).pressure;
    const auto least = [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()) - v.front(); };
    EXPECT_NEAR(least(pressure) / least(exact), 1, 0.06);
    EXPECT_NEAR(pressure.back() / (exact.back() - exact.front()), 1, 0.12);
}

}   // namespace
}   // namespace patency
