// SPDX-License-Identifier: Apache-2.0
// Friction of a point on a surface: sticks like a spring, slides at Coulomb's bound, never drives.
#include "patency/physics/solid/contact.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace patency;

namespace {
const Vec3 up{0, 0, 1};
constexpr double push = 10, stiffness = 1000, mu = 0.3;   // slides beyond 3 N, 3 mm
}   // namespace

TEST(Friction, SticksLikeASpringBelowTheBound) {
    const FrictionState f = friction({}, {1e-3, -1e-3, 5}, up, push, stiffness, mu);
    EXPECT_EQ(f.force, (Vec3{-1, 1, 0})) << "what goes through the surface counts for nothing";
    EXPECT_EQ(f.loss, 0);
    const FrictionState back = friction(f.stick, {-1e-3, 1e-3, 0}, up, push, stiffness, mu);
    EXPECT_NEAR(norm(back.force), 0, 1e-15);
}

TEST(Friction, SlidesAgainstTheMotionAtTheBound) {
    FrictionState f;
    double work = 0, loss = 0;
    for (int k = 0; k < 100; ++k) {
        f = friction(f.stick, {0, 1e-4, 0}, up, push, stiffness, mu);
        work += -f.force.y * 1e-4, loss += f.loss;
    }
    EXPECT_NEAR(f.force.y, -mu * push, 1e-12);
    EXPECT_NEAR(loss, mu * push * 0.007, 1e-12) << "of the 10 mm, 3 stretched the spring";
    EXPECT_NEAR(work, loss + 0.5 * stiffness * 9e-6, 2e-4);
    const FrictionState none = friction(f.stick, {}, up, 0, stiffness, mu);
    EXPECT_EQ(norm(none.force), 0) << "without a push nothing holds";
}

TEST(Penalty, IsATenthOfWhatTheStepWouldStop) { EXPECT_DOUBLE_EQ(penalty_stiffness(2, 0.1), 20); }

TEST(NormalPush, NeverPullsAndOnlyLoses) {
    const double k = 2e3, depth = 1e-6, step = 1e-7;
    EXPECT_DOUBLE_EQ(normal_push(k, depth, 0, 0, 0.5, step).force, k * depth);
    EXPECT_EQ(normal_push(k, depth, 0, 3, 0, step).unsprung, 0);
    EXPECT_GT(normal_push(k, depth, 0, 3, 0.5, step).force, k * depth);
    for (const double approach : {-10.0, -1.0, -0.1, 0.1, 1.0, 10.0}) {
        const NormalPush push = normal_push(k, depth, 0, approach, 0.5, step);
        EXPECT_GE(push.force, 0);
        EXPECT_GT(push.unsprung * approach, 0);
    }
    EXPECT_EQ(normal_push(k, depth, 0, -10, 0.5, step).force, 0);
}

TEST(NormalPush, IsCriticalAtRatioOne) {   // m x'' = -k x - c x' has c = 2 sqrt(k m)
    const double m = 1e-9, step = 1e-7, k = penalty_stiffness(m, step);
    const double c = (normal_push(k, 1e-6, 0, 0.1, 1, step).force - k * 1e-6) / 0.1;
    EXPECT_NEAR(c, 2 * std::sqrt(k * m), 1e-12 * c);
}

namespace {

struct Pressed {
    double depth, motion;   // at the end: over what the spring alone would leave, and kinetic over its energy
    double imbalance;       // of energies, over the spring's
};

/// A mass (over that which the spring is set for) that a load presses, from rest at the surface.
Pressed press(double mass_ratio, const Hold& hold, double damping, int steps) {
    const double m = 1e-9, dt = 1e-7, k = penalty_stiffness(m, dt), load = 1e-3;
    double depth = 0, speed = 0, held = 0, lost = 0;
    for (int n = 0; n < steps; ++n) {
        held = held_push(held, hold, k, depth, dt, dt);
        const NormalPush p = normal_push(k, depth, held, speed, damping, dt);
        const double before = speed;
        speed += dt * (load - p.force) / (mass_ratio * m);
        depth += dt * speed;
        lost += 0.5 * dt * p.unsprung * (before + speed);
    }
    const double unit = 0.5 * load * load / k, kinetic = 0.5 * mass_ratio * m * speed * speed;
    return {depth * k / load, kinetic / unit, (load * depth - 0.5 * k * depth * depth - kinetic - lost) / unit};
}

}   // namespace

TEST(HeldPush, LeavesLittleOfTheDepthAndComesToRest) {
    for (const double mass_ratio : {0.1, 1.0, 5.0}) {   // ten vertices on one mass, and a wall behind them
        const Pressed p = press(mass_ratio, hold_when_driven, damping_when_driven, 200000);
        EXPECT_NEAR(p.depth, 1 / (1 + hold_when_driven.ratio), 1e-3) << mass_ratio;
        EXPECT_LT(p.motion, 1e-4) << mass_ratio;
        EXPECT_LT(std::abs(p.imbalance), 0.02) << mass_ratio;
    }
}

TEST(HeldPush, GrowsByItsRatioOverItsSteps) {
    const Hold hold{9, 50};
    EXPECT_NEAR(held_push(0, hold, stiffness, 1e-6, 1e-7, 1e-7), 9 * stiffness * 1e-6 / 50, 1e-15);
    EXPECT_NEAR(held_push(0, hold, stiffness, 1e-6, 1e-7, 3e-7), 9 * stiffness * 1e-6 / 150, 1e-15);
    EXPECT_EQ(held_push(0, hold, stiffness, -1e-6, 1e-7, 1e-7), 0);
}

TEST(HeldPush, WithoutADamperDrivesWhatItHolds) {   // the criterion of Routh and Hurwitz, THEORY (21.15)
    EXPECT_GT(press(1, hold_at_rest, 0, 200000).motion, 1);
    EXPECT_GT(press(1, hold_at_rest, damping_when_driven, 200000).motion, 1) << "too quick for its damper";
}
