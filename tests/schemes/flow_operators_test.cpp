// SPDX-License-Identifier: Apache-2.0
// The scheme's operators, as a step too short to move anything leaves them in the fields: exact on linear fields in any
// arrangement and up to its border, on quadratic ones where they promise it.                          THEORY.md (3)
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/schemes/small_flows.h"

using namespace patency;
using namespace patency::testing_flows;

namespace {

struct Variant {
    Precision precision;
    bool planar;
    double disorder;   // spacings
};

struct Operators : testing::TestWithParam<Variant> {
    SmallFlow flow;
    void SetUp() override {
        make_block(flow, GetParam().planar ? 18 : 12, GetParam().planar);
        flow.numerics.shift = 0;
        if (GetParam().disorder > 0) flow.disturb(GetParam().disorder, 3);
    }
    /// Relative: the bars of docs/VERIFICATION.md. In single precision a place is known to 2^-21 of a support and a value to
    /// 2^-24 of itself, over differences of a spacing in a block of 9 to either side.
    double tolerance() const { return GetParam().precision == Precision::mixed ? 1e-5 : 1e-10; }
    bool planar() const { return GetParam().planar; }
    bool is_border(const Vec3& x, double layers) const {
        const double half = 0.5 * (planar() ? 18 : 12) * dp - layers * dp;
        return std::abs(x.x) > half || std::abs(x.y) > half || std::abs(x.z) > half;
    }
    void remove_viscosity() {
        flow.blood.viscosity = 1e-30;
        std::fill(flow.fluid.viscosity.begin(), flow.fluid.viscosity.end(), flow.blood.viscosity);
    }
    void compute() { flow.make(GetParam().precision)->step(0, 1e-15); }
};

std::string name_of(const testing::TestParamInfo<Variant>& info) {
    const Variant& v = info.param;
    return std::string(v.precision == Precision::mixed ? "Mixed" : "Double") + (v.planar ? "Plane" : "Space") +
           (v.disorder > 0 ? "Disordered" : "Lattice");
}

constexpr double disorder = 0.2;
using enum Precision;
INSTANTIATE_TEST_SUITE_P(Flow, Operators,
                         testing::Values(Variant{mixed, true, 0}, Variant{mixed, true, disorder},
                                         Variant{mixed, false, 0}, Variant{mixed, false, disorder},
                                         Variant{double_precision, true, 0}, Variant{double_precision, true, disorder},
                                         Variant{double_precision, false, 0},
                                         Variant{double_precision, false, disorder}),
                         name_of);

// The Laplacian of a quadratic is promised on lattices: elsewhere the gradient has an error of its own.
struct LatticeOperators : Operators {};
INSTANTIATE_TEST_SUITE_P(Flow, LatticeOperators,
                         testing::Values(Variant{mixed, true, 0}, Variant{mixed, false, 0},
                                         Variant{double_precision, true, 0}, Variant{double_precision, false, 0}),
                         name_of);

TEST_P(Operators, GradientOfALinearPressureIsExact) {
    const Vec3 exact{3000, -2000, planar() ? 0.0 : 1000};   // Pa/m
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) flow.fluid.pressure[i] = dot(exact, flow.fluid.position[i]);
    compute();
    // At the border a particle sees half of its neighbours or less, and the matrix is worse conditioned, by 10 or so.
    for (std::size_t i = 0; i < flow.fluid.size(); ++i)
        EXPECT_LE(norm(flow.fluid.pressure_gradient[i] - exact) / norm(exact),
                  (is_border(flow.fluid.position[i], 3) ? 10 : 1) * tolerance());
}

TEST_P(Operators, GradientAndDivergenceOfALinearVelocityAreExact) {
    Mat3 exact{{70, -30, 20}, {40, 50, -60}, {-20, 80, 90}};   // 1/s
    if (planar()) exact = {{70, -30, 0}, {40, 50, 0}, {0, 0, 0}};
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) flow.fluid.velocity[i] = exact * flow.fluid.position[i];
    compute();
    const double size = std::sqrt(dot(exact.x, exact.x) + dot(exact.y, exact.y) + dot(exact.z, exact.z));
    const double stiffness = flow.blood.density * flow.blood.sound_speed * flow.blood.sound_speed;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const double allowed = (is_border(flow.fluid.position[i], 3) ? 10 : 1) * tolerance();
        const Mat3 error = flow.fluid.velocity_gradient[i] - exact;
        EXPECT_LE(std::sqrt(dot(error.x, error.x) + dot(error.y, error.y) + dot(error.z, error.z)) / size, allowed);
        EXPECT_NEAR(flow.fluid.pressure_rate[i] / (-stiffness * trace(exact)), 1, allowed);
    }
}

TEST_P(Operators, ViscosityLeavesLinearVelocitiesAlone) {
    const Mat3 gradient =
        planar() ? Mat3{{70, -30, 0}, {40, 50, 0}, {0, 0, 0}} : Mat3{{70, -30, 20}, {40, 50, -60}, {-20, 80, 90}};
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) flow.fluid.velocity[i] = gradient * flow.fluid.position[i];
    compute();
    // Against what a change of the velocity of 100/s within a spacing would make.
    const double size = flow.blood.kinematic_viscosity() * 100 / dp;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i)
        EXPECT_LE(norm(flow.fluid.slow_acceleration[i]) / size,
                  (is_border(flow.fluid.position[i], 3) ? 10 : 1) * tolerance());
}

// A viscosity that grows along x shears off momentum from a linear velocity too: div (2 mu D) = (L + L^T) grad mu, exact to first
// order in grad mu.                                                                               THEORY.md (3.7)
TEST_P(Operators, ViscosityThatVariesBringsItsWholeStress) {
    const Mat3 l =
        planar() ? Mat3{{70, -30, 0}, {40, -70, 0}, {0, 0, 0}} : Mat3{{70, -30, 20}, {40, 50, -60}, {-20, 80, -120}};
    const auto worst_error =
        [&](double share) {   // of the stress; share: of mu, by which it changes over a third of the block
            const Vec3 slope = share * Vec3{0.8, -0.6, planar() ? 0 : 0.4} / (6 * dp);
            flow.blood.viscosity_at = [mu = flow.blood.viscosity](double) {
                return mu;
            };   // for the next step, which is not taken
            for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
                const Vec3& x = flow.fluid.position[i];
                flow.fluid.velocity[i] = l * x, flow.fluid.viscosity[i] = flow.blood.viscosity * (1 + dot(slope, x));
                flow.fluid.velocity_gradient[i] = {};
            }
            compute();
            const Vec3 exact = flow.blood.kinematic_viscosity() * (l * slope + transpose(l) * slope);
            double worst = 0;
            for (std::size_t i = 0; i < flow.fluid.size(); ++i)
                if (!is_border(flow.fluid.position[i], 3))
                    worst = std::max(worst, norm(flow.fluid.slow_acceleration[i] - exact) / norm(exact));
            return worst;
        };
    const double steep = worst_error(0.5);
    EXPECT_LE(steep, 0.02);
    if (GetParam().precision == double_precision) {
        EXPECT_LE(worst_error(0.05), 0.2 * steep);
    }
}

TEST_P(LatticeOperators, LaplacianOfAQuadraticVelocityIsExact) {
    const double half = 6 * dp;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3 q = flow.fluid.position[i] / half;
        const double z = planar() ? 0 : 1;
        flow.fluid.velocity[i] = {
            0.6 * q.x * q.x + 0.3 * q.y * q.y + 0.4 * z * q.z * q.z + 0.4 * q.x * q.y - 0.4 * q.y * q.z + q.x,
            0.5 * q.x * q.y - 0.2 * q.y * q.y + 0.2 * q.x * q.z, z * (q.x * q.z - 0.3 * q.z * q.z)};
    }
    compute();
    const double nu = flow.blood.kinematic_viscosity();
    const Vec3 exact = nu / (half * half) * (planar() ? Vec3{1.8, -0.4, 0} : Vec3{2.6, -0.4, -0.6});
    int inner = 0;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        if (is_border(flow.fluid.position[i], 3)) continue;   // a lattice all around, as far as the kernel reaches
        ++inner;
        EXPECT_LE(norm(flow.fluid.slow_acceleration[i] - exact) / norm(exact), tolerance());
    }
    EXPECT_GE(inner, 100);
}

/// A quadratic velocity's gradient; steps sort particles, so it is asked by place.
Mat3 quadratic_gradient(const Vec3& x, double half) {
    const Vec3 q = x / half;
    return (1 / half) * Mat3{{1.2 * q.x + 0.4 * q.y, 0.6 * q.y + 0.4 * q.x, 0},
                             {0.5 * q.y, 0.5 * q.x - 0.4 * q.y, 0},
                             {0.6 * q.x, 0, 0}};
}

/// Sets velocities to a quadratic function of place, and the gradients to its own.
void set_quadratic(SmallFlow& flow, double half) {
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3 q = flow.fluid.position[i] / half;
        flow.fluid.velocity[i] = {0.6 * q.x * q.x + 0.3 * q.y * q.y + 0.4 * q.x * q.y,
                                  0.5 * q.x * q.y - 0.2 * q.y * q.y, 0.3 * q.x * q.x};
        flow.fluid.velocity_gradient[i] = quadratic_gradient(flow.fluid.position[i], half);
    }
}

double size_of(const Mat3& m) { return std::sqrt(dot(m.x, m.x) + dot(m.y, m.y) + dot(m.z, m.z)); }

// A step starts from the gradients of the last one, and from the true ones it stays there.             THEORY.md (3.8)
TEST_P(Operators, GradientAndDivergenceOfAQuadraticVelocityAreExactOnceKnown) {
    const double half = 6 * dp, stiffness = flow.blood.density * flow.blood.sound_speed * flow.blood.sound_speed;
    set_quadratic(flow, half);
    compute();
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const double allowed = (is_border(flow.fluid.position[i], 3) ? 10 : 1) * tolerance() / half;
        const Mat3 exact = quadratic_gradient(flow.fluid.position[i], half);
        EXPECT_LE(size_of(flow.fluid.velocity_gradient[i] - exact), allowed);
        EXPECT_NEAR(flow.fluid.pressure_rate[i] / -stiffness, trace(exact), allowed);
    }
}

TEST_P(Operators, GradientsOfAQuadraticVelocityAreFoundStepByStep) {
    const double half = 6 * dp;
    set_quadratic(flow, half);
    std::fill(flow.fluid.velocity_gradient.begin(), flow.fluid.velocity_gradient.end(), Mat3{});
    const auto scheme = flow.make(GetParam().precision);
    const auto worst = [&] {
        double most = 0;
        for (std::size_t i = 0; i < flow.fluid.size(); ++i)
            most = std::max(most, half * size_of(flow.fluid.velocity_gradient[i] -
                                                 quadratic_gradient(flow.fluid.position[i], half)));
        return most;
    };
    scheme->step(0, 1e-15);
    const double first = worst();
    for (int k = 0; k < 30; ++k) scheme->step(0, 1e-15);
    EXPECT_GE(first, 0.05);   // one-sided differences at the border
    EXPECT_LE(worst(), std::max(0.02 * first, 10 * tolerance())) << first;
}

TEST_P(Operators, DissipationLeavesQuadraticVelocitiesAlone) {   // THEORY.md (4.9)
    remove_viscosity();                                          // nothing but the dissipation is left
    set_quadratic(flow, 6 * dp);
    compute();
    // Against what it would take from a speed of 1 m/s that changes from particle to particle.
    for (std::size_t i = 0; i < flow.fluid.size(); ++i)
        EXPECT_LE(norm(flow.fluid.slow_acceleration[i]) * dp, 3 * tolerance());
}

TEST_P(Operators, DissipationTakesTheEnergyOfNoise) {
    // As fast as the blood goes; where it does not, by a hundredth of the speed of sound.
    for (const double speed : {3.0, 0.0}) {
        remove_viscosity();
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> any(-0.01, 0.01);
        const Vec3 stream{0, speed, 0};
        std::vector<Vec3> noise(flow.fluid.size());
        for (Vec3& v : noise) v = {any(random), any(random), planar() ? 0 : any(random)};
        for (std::size_t i = 0; i < noise.size(); ++i) flow.fluid.velocity[i] = stream + noise[i];
        flow.fluid.velocity_gradient[0] = {{1e-12, 0, 0}, {}, {}};   // known, and nothing
        compute();
        double power = 0, energy = 0;
        for (std::size_t i = 0; i < noise.size(); ++i) {
            const Vec3 v = flow.fluid.velocity[i] - stream;
            power += dot(v, flow.fluid.slow_acceleration[i]), energy += dot(v, v);
        }
        // Noise has no mean among the neighbours, so its rate is U times the sum of V |W'|: 8 pi int W r dr = 2.5/h in space, 2.8/h
        // in the plane for a whole neighbourhood; half of the block is border.
        const double h = flow.numerics.smoothing_ratio * dp,
                     fastest = speed > 0 ? speed : 0.01 * flow.blood.sound_speed;
        const double rate = -power / energy * h / (flow.numerics.velocity_dissipation * fastest);
        EXPECT_GT(rate, 1.5) << speed;
        EXPECT_LT(rate, 3.0) << speed;
    }
}

TEST_P(Operators, ConstantFieldsGiveExactlyNothing) {
    const Vec3 v{0.1, -0.2, planar() ? 0 : 0.3};
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) flow.fluid.velocity[i] = v, flow.fluid.pressure[i] = 13000;
    compute();
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        EXPECT_EQ(flow.fluid.pressure_gradient[i], Vec3{});
        EXPECT_EQ(flow.fluid.velocity_gradient[i], Mat3{});
        EXPECT_EQ(flow.fluid.slow_acceleration[i], Vec3{});
        EXPECT_EQ(flow.fluid.pressure_rate[i], 0);
        EXPECT_EQ(flow.fluid.velocity[i], v);
    }
}

TEST(OperatorsAtWalls, AShearBetweenPlatesIsExactUpToThem) {
    // The upper plate moves; the linear mirror continues the profile exactly.                        THEORY.md (5.1)
    SmallFlow flow;
    const int across = 10;
    make_channel(flow, 12, across, true, OpenEnd::Kind::velocity, OpenEnd::Kind::velocity);
    flow.numerics.shift = 0;
    const double gap = across * dp, shear = 200;
    for (OpenEnd& end : flow.ends)
        end.velocity = [=](double) { return [=](const Vec3& x) { return Vec3{shear * x.y, 0, 0}; }; };
    for (std::size_t i = 0; i < flow.fluid.size(); ++i)
        flow.fluid.velocity[i] = {shear * flow.fluid.position[i].y, 0, 0};
    for (std::size_t i = 0; i < flow.wall.size(); ++i)
        flow.wall.velocity[i] = {flow.wall.position[i].y > gap / 2 ? shear * gap : 0.0, 0, 0};
    flow.make(Precision::double_precision)->step(0, 1e-15);
    const double size = flow.blood.kinematic_viscosity() * shear / dp;
    int checked = 0;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const double x = flow.fluid.position[i].x;
        if (x < 0 || x > 12 * dp) continue;
        ++checked;
        const Mat3& g = flow.fluid.velocity_gradient[i];
        EXPECT_NEAR(g.x.y, shear, 1e-10 * shear);
        EXPECT_NEAR(g.x.x, 0, 1e-10 * shear);
        EXPECT_NEAR(g.y.x, 0, 1e-10 * shear);
        EXPECT_LE(norm(flow.fluid.slow_acceleration[i]) / size, 1e-10);
    }
    EXPECT_EQ(checked, 120);
}

/// Blood that rests at both walls, gathers along them and rises from them without expanding: the largest error of the velocity gradient in
/// the layers that see the lower wall, over the rate at which it gathers a spacing from it; and that of the divergence.
std::pair<double, double> errors_of_what_rises_from_a_wall(Precision precision, bool planar) {
    SmallFlow flow;
    const int along = 12, across = 16;
    make_channel(flow, along, across, planar, OpenEnd::Kind::velocity, OpenEnd::Kind::velocity);
    flow.numerics.shift = 0;
    const double gap = across * dp, middle = 0.5 * along * dp, slope = 1000, growth = -4e5;   // 1/s, 1/(m s)
    const auto depth = [=](const Vec3& x) { return std::min(x.y, gap - x.y); };
    const auto velocity = [=](const Vec3& x) {
        const double s = depth(x), rise = -0.5 * growth * s * s;
        return Vec3{s * (slope + growth * (x.x - middle)), x.y < gap / 2 ? rise : -rise, 0};
    };
    for (OpenEnd& end : flow.ends) end.velocity = [&](double) { return velocity; };
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) flow.fluid.velocity[i] = velocity(flow.fluid.position[i]);
    flow.make(precision)->step(0, 1e-15);
    const double unit = std::abs(growth) * dp,
                 stiffness = flow.blood.density * flow.blood.sound_speed * flow.blood.sound_speed;
    double worst = 0, worst_divergence = 0;
    int checked = 0;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3& x = flow.fluid.position[i];
        if (x.y > 2.6 * dp || std::abs(x.x - middle) > 3 * dp || (!planar && std::abs(x.z - gap / 2) > 2 * dp))
            continue;
        ++checked;
        const double s = x.y;
        const Mat3 exact{{growth * s, slope + growth * (x.x - middle), 0}, {0, -growth * s, 0}, {}};
        const Mat3 error = flow.fluid.velocity_gradient[i] - exact;
        worst = std::max(worst, size_of(error) / unit);
        worst_divergence = std::max(worst_divergence, std::abs(flow.fluid.pressure_rate[i]) / stiffness / unit);
    }
    EXPECT_EQ(checked, planar ? 18 : 72);
    return {worst, worst_divergence};
}

// The mirror alone is off by a fifth and a twentieth.                                              THEORY.md (5.5), (5.6)
TEST(OperatorsAtWalls, WhatRisesFromAWallIsExact) {
    for (const bool planar : {true, false})
        for (const Precision precision : {mixed, double_precision}) {
            const auto [gradient, divergence] = errors_of_what_rises_from_a_wall(precision, planar);
            EXPECT_LE(gradient, precision == mixed ? 1e-3 : 1e-9) << planar;
            EXPECT_LE(divergence, precision == mixed ? 1e-3 : 1e-9) << planar;
        }
}

/// How far the viscous force on the layer at a wall is off the pressure gradient that it balances, over that; mu doubles within a
/// quarter of the gap.
double error_at_wall_of_thinning_blood(int across) {
    SmallFlow flow;
    make_channel(flow, 12, across, true, OpenEnd::Kind::velocity, OpenEnd::Kind::velocity);
    flow.numerics.shift = 0;
    const double gap = across * dp, slope = 2000, mu_0 = flow.blood.viscosity;   // Pa/m
    const auto from_wall = [&](double y) { return std::min(y, gap - y); };
    const auto mu = [&](double s) { return mu_0 * (1 + 4 * s / gap); };
    // mu du/ds = slope (gap/2 - s), integrated.
    const auto velocity = [&](double s) {
        const double a = 4 / gap;
        return slope / mu_0 * ((gap / 2 + 1 / a) * std::log(1 + a * s) / a - s / a);
    };
    flow.blood.viscosity = mu(gap / 2);                          // the largest
    flow.blood.viscosity_at = [mu_0](double) { return mu_0; };   // for the next step, which is not taken
    for (OpenEnd& end : flow.ends)
        end.velocity = [&](double) { return [&](const Vec3& x) { return Vec3{velocity(from_wall(x.y)), 0, 0}; }; };
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const double s = from_wall(flow.fluid.position[i].y);
        flow.fluid.velocity[i] = {velocity(s), 0, 0}, flow.fluid.viscosity[i] = mu(s);
        flow.fluid.pressure_gradient[i] = {-slope, 0, 0};
    }
    flow.make(Precision::double_precision)->step(0, 1e-15);
    double worst = 0;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3& x = flow.fluid.position[i];
        if (x.x < 0 || x.x > 12 * dp || from_wall(x.y) > dp) continue;
        worst = std::max(worst, std::abs(flow.fluid.slow_acceleration[i].x * flow.blood.density / slope + 1));
    }
    return worst;
}

// The wall has no viscosity to tell how mu goes on behind it.                                    THEORY.md (5.3)
TEST(OperatorsAtWalls, TheLayerAtAWallFeelsTheWholeStressOfThinningBlood) {
    const double coarse = error_at_wall_of_thinning_blood(16), fine = error_at_wall_of_thinning_blood(32);
    EXPECT_LE(coarse, 0.12);
    EXPECT_LE(fine, 0.7 * coarse);   // without the part of grad mu it is 0.47 at any spacing
}

}   // namespace
