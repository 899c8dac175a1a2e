// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/wall_shear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/analysis/poiseuille_tube.h"

namespace patency {
namespace {

using testing_analysis::PoiseuilleTube;

WallPlaces places_around(const PoiseuilleTube& tube, double axial, int count) {
    WallPlaces places;
    for (int k = 0; k < count; ++k) {
        const double angle = 2 * std::numbers::pi * k / count;
        const Vec3 out{0, std::cos(angle), std::sin(angle)};
        places.position.push_back(tube.motion.place(Vec3{axial, 0, 0} + tube.radius * out));
        places.normal.push_back(tube.motion.turn(out));
    }
    return places;
}

TEST(WallShear, OfAParabolaIsPoiseuilles) {
    const PoiseuilleTube tube;
    const WallPlaces places = places_around(tube, 4.5e-3, 24);
    const auto stress = flow_at_wall(tube.fluid, *tube.frame, places, tube.reach(), tube.wall, [](double) {
                            return 3.5e-3;
                        }).shear_stress;
    const double exact = tube.wall_stress(3.5e-3);
    for (std::size_t k = 0; k < stress.size(); ++k) {
        EXPECT_NEAR(dot(stress[k], tube.axis()) / exact, 1, 0.01) << k;   // with the stream
        EXPECT_NEAR(dot(stress[k], places.normal[k]) / exact, 0, 1e-12) << k;
        EXPECT_LE(norm(stress[k] - dot(stress[k], tube.axis()) * tube.axis()) / exact, 0.01) << k;
    }
}

/// Parts of the plane z = 0, in no order, with a stress and a pressure that vary linearly along it.
WallParts parts_of_a_plane(const Vec3& normal) {
    WallParts parts;
    for (int k = 0; k < 400; ++k) {
        const double a = std::fmod(0.7548 * k, 1.0), b = std::fmod(0.5698 * k, 1.0);
        parts.places.position.push_back({1e-3 * a, 1e-3 * b, 0});
        parts.places.normal.push_back(normal);
        parts.area.push_back((1 + a) * 2.5e-9);
        parts.flow.shear_stress.push_back({1 + a, 2 * b - a, 0});
        parts.flow.pressure.push_back(10 + 3 * a - b);
    }
    return parts;
}

TEST(WallShear, OfPartsIsExactWhereItVariesLinearly) {
    const WallParts parts = parts_of_a_plane({0, 0, 1});
    // In the middle, at the edge and in a corner of the plane.
    const WallPlaces places{{{0.5e-3, 0.4e-3, 0}, {0, 0.3e-3, 0}, {1e-3, 1e-3, 0}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};
    const WallFlow flow = flow_of_parts(parts, places, 0.15e-3);
    for (std::size_t k = 0; k < 3; ++k) {
        const double a = 1e3 * places.position[k].x, b = 1e3 * places.position[k].y;
        EXPECT_NEAR(flow.shear_stress[k].x, 1 + a, 3e-3) << k;
        EXPECT_NEAR(flow.shear_stress[k].y, 2 * b - a, 3e-3) << k;
        EXPECT_NEAR(flow.pressure[k], 10 + 3 * a - b, 3e-3) << k;
    }
}

TEST(WallShear, OfPartsLeavesOutTheOtherSideOfACarina) {
    WallParts parts = parts_of_a_plane({0, 0, 1});
    const WallParts other = parts_of_a_plane({0, 0, -1});
    for (std::size_t k = 0; k < other.area.size(); ++k) {
        parts.places.position.push_back(other.places.position[k] + Vec3{0, 0, 1e-5});
        parts.places.normal.push_back(other.places.normal[k]);
        parts.area.push_back(other.area[k]);
        parts.flow.shear_stress.push_back({100, 100, 0});
        parts.flow.pressure.push_back(100);
    }
    const WallFlow flow =
        flow_of_parts(parts, {{{0.5e-3, 0.5e-3, 0}, {0.5e-3, 5e-3, 0}}, {{0, 0, 1}, {0, 0, 1}}}, 0.15e-3);
    EXPECT_NEAR(flow.shear_stress[0].x, 1.5, 3e-3);
    EXPECT_TRUE(std::isnan(flow.pressure[1]));   // where there is no wall
}

TEST(WallShear, NeedsNoDistancesWhereTheSurfaceHasPoints) {
    PoiseuilleTube tube;
    for (double x = 0; x < tube.length; x += 0.4 * tube.reach())
        for (int k = 0; k < 16; ++k) {
            const double angle = 2 * std::numbers::pi * k / 16;
            tube.wall.points.push_back(
                tube.motion.place({x, tube.radius * std::cos(angle), tube.radius * std::sin(angle)}));
        }
    tube.wall.distance = [](const Vec3&) -> double { throw std::logic_error("nobody may ask"); };
    tube.wall.normal = [](const Vec3&) -> Vec3 { throw std::logic_error("nobody may ask"); };
    const WallPlaces places = places_around(tube, 4.5e-3, 24);
    const WallFlow flow =
        flow_at_wall(tube.fluid, *tube.frame, places, tube.reach(), tube.wall, [](double) { return 3.5e-3; });
    for (std::size_t k = 0; k < places.position.size(); ++k) {
        EXPECT_NEAR(dot(flow.shear_stress[k], tube.axis()) / tube.wall_stress(3.5e-3), 1, 0.01) << k;
        EXPECT_NEAR(flow.pressure[k], tube.pressure(places.position[k]), 1e-6) << k;
    }
}

/// A layer over the plate z = 0 in which blood is slowed down along x by the pressure that it runs into, and pushed along y: with the
/// curvatures at the plate that the pressure's slopes ask for, of blood whose stress over the shear rate has the slope tangent mu there.
struct SlowedLayer {
    double spacing = 0.2e-3, slope = 900, third = -3e9, mu = 3.5e-3;   // m, 1/s, 1/(m^2 s), Pa s
    Vec3 push{12000, 5000, 0};                                         // Pa/m
    FluidParticles fluid;
    Frame frame{{-4e-3, -4e-3, -1e-3}, {4e-3, 4e-3, 4e-3}, 2.6 * spacing};
    WallHint wall{.distance = [](const Vec3& x) { return -x.z; },
                  .normal =
                      [](const Vec3&) {
                          return Vec3{0, 0, -1};
                      },
                  .velocity = {}};
    WallPlaces places{{{0, 0, 0}, {0.3e-3, -0.2e-3, 0}}, {{0, 0, -1}, {0, 0, -1}}};

    explicit SlowedLayer(double tangent = 1) {
        std::mt19937_64 random(9);
        std::uniform_real_distribution<double> any(-0.2 * spacing, 0.2 * spacing);
        std::vector<Vec3> points;
        for (int i = -8; i < 8; ++i)
            for (int j = -8; j < 8; ++j)
                for (int k = 0; k < 8; ++k)
                    points.push_back({(i + 0.5) * spacing + any(random), (j + 0.5) * spacing + any(random),
                                      (k + 0.5) * spacing + any(random)});
        fluid.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double z = points[i].z;
            fluid.position[i] = points[i];
            fluid.velocity[i] = {slope * z + 0.5 * push.x / (tangent * mu) * z * z + third * z * z * z,
                                 0.5 * push.y / mu * z * z, 0};
            fluid.pressure[i] = dot(push, points[i]);
        }
    }
    void expect_exact(const WallFlow& flow, double allowed) const {
        for (std::size_t k = 0; k < places.position.size(); ++k) {
            EXPECT_NEAR(flow.shear_stress[k].x / (mu * slope), 1, allowed) << k;
            EXPECT_NEAR(flow.shear_stress[k].y / (mu * slope), 0, allowed) << k;
        }
    }
};

// Its curvature changes sign within the reach: a quadratic fit makes a tenth too much of the slope.     THEORY.md (5.7)
TEST(WallShear, OfALayerThatIsSlowedDownIsExact) {
    const SlowedLayer layer;
    const WallFlow flow = flow_at_wall(layer.fluid, layer.frame, layer.places, 2.6 * layer.spacing, layer.wall,
                                       [&](double) { return layer.mu; });
    layer.expect_exact(flow, 1e-9);
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_NEAR(flow.pressure[k], dot(layer.push, layer.places.position[k]), 1e-9) << k;
}

// Along the shear friction grows with the slope of the stress, here 2 mu, across it with the stress itself.
TEST(WallShear, OfThinningBloodKnowsAlongFromAcross) {
    const SlowedLayer layer(2);
    layer.expect_exact(flow_at_wall(layer.fluid, layer.frame, layer.places, 2.6 * layer.spacing, layer.wall,
                                    [&](double rate) { return layer.mu * rate / layer.slope; }),
                       0.01);
}

TEST(WallShear, OfBloodThatAForceHoldsIsNone) {
    SlowedLayer layer;
    for (Vec3& v : layer.fluid.velocity) v = {};
    const WallFlow flow = flow_at_wall(
        layer.fluid, layer.frame, layer.places, 2.6 * layer.spacing, layer.wall, [&](double) { return layer.mu; },
        layer.push);
    for (const Vec3& stress : flow.shear_stress) EXPECT_LE(norm(stress), 1e-9);
}

TEST(WallShear, WhereASurfaceHasNoNormalIsNone) {
    SlowedLayer layer;
    layer.places.normal[0] = {};
    const WallFlow flow = flow_at_wall(layer.fluid, layer.frame, layer.places, 2.6 * layer.spacing, layer.wall,
                                       [&](double) { return layer.mu; });
    EXPECT_EQ(norm(flow.shear_stress[0]), 0);
}

TEST(WallShear, UsesTheViscosityAtTheShearRateThere) {
    // A viscosity that grows with the shear rate, mu = m rate, whose stress has the slope 2 mu: a parabola's pressure at the wall then
    // falls by (2 mu + mu) 4 U/R^2.
    const double m = 1e-6, rate = 4 * 0.3 / 1.5e-3;
    const PoiseuilleTube tube(-3 * m * rate * 4 * 0.3 / (1.5e-3 * 1.5e-3));
    ASSERT_DOUBLE_EQ(rate, 4 * tube.mean_speed / tube.radius);
    const WallPlaces places = places_around(tube, 4.5e-3, 3);
    const auto stress = flow_at_wall(tube.fluid, *tube.frame, places, tube.reach(), tube.wall, [&](double at) {
                            EXPECT_NEAR(at / rate, 1, 0.01);
                            return m * at;
                        }).shear_stress;
    for (const Vec3& s : stress) EXPECT_NEAR(norm(s) / (m * rate * rate), 1, 0.02);
}

TEST(WallShear, WithoutBloodNearbyThereIsNone) {
    const PoiseuilleTube tube;
    const auto stress =
        flow_at_wall(tube.fluid, *tube.frame, places_around(tube, 0.03, 2), tube.reach(), tube.wall, [](double) {
            return 1.0;
        }).shear_stress;
    for (const Vec3& s : stress) EXPECT_TRUE(std::isnan(s.x));
}

TEST(WallShearMeans, OfASteadyStressHaveNoOscillation) {
    WallShearMeans means;
    const std::vector<Vec3> stress{{3, 0, 4}, {0, -2, 0}};
    means.add(stress, 0.25), means.add(stress, 0.75);
    EXPECT_DOUBLE_EQ(means.duration(), 1);
    EXPECT_DOUBLE_EQ(means.tawss()[0], 5);
    EXPECT_DOUBLE_EQ(means.osi()[0], 0);
    EXPECT_DOUBLE_EQ(means.rrt()[1], 0.5);
}

TEST(WallShearMeans, OfNoStressAreNumbersToo) {
    WallShearMeans means;
    means.add(std::vector<Vec3>{{0, 0, 0}, {NAN, 0, 0}}, 1);
    EXPECT_EQ(means.tawss()[0], 0);
    EXPECT_DOUBLE_EQ(means.rrt()[0], 1e6);
    EXPECT_TRUE(std::isnan(means.rrt()[1]));
}

TEST(WallShearMeans, OfAStressThatTurnsRound) {
    WallShearMeans even, uneven;
    const std::vector<Vec3> to{{2, 0, 0}}, fro{{-2, 0, 0}};
    even.add(to, 1), even.add(fro, 1);
    EXPECT_DOUBLE_EQ(even.osi()[0], 0.5);   // the most there is
    EXPECT_DOUBLE_EQ(even.tawss()[0], 2);
    uneven.add(to, 3), uneven.add(fro, 1);
    EXPECT_DOUBLE_EQ(uneven.osi()[0], 0.25);
    EXPECT_DOUBLE_EQ(uneven.rrt()[0], 1 / ((1 - 2 * 0.25) * 2));
    EXPECT_EQ(uneven.mean()[0], (Vec3{1, 0, 0}));
}

}   // namespace
}   // namespace patency
