// SPDX-License-Identifier: Apache-2.0
// Friction of a point on a surface: sticks like a spring, slides at Coulomb's bound, never drives.
#include "patency/physics/solid/contact.h"

#include <gtest/gtest.h>

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
    EXPECT_DOUBLE_EQ(normal_push(k, depth, 0, 0.5, step).force, k * depth);
    EXPECT_EQ(normal_push(k, depth, 3, 0, step).damper, 0);
    EXPECT_GT(normal_push(k, depth, 3, 0.5, step).force, k * depth);
    for (const double approach : {-10.0, -1.0, -0.1, 0.1, 1.0, 10.0}) {
        const NormalPush push = normal_push(k, depth, approach, 0.5, step);
        EXPECT_GE(push.force, 0);
        EXPECT_GT(push.damper * approach, 0);
    }
    EXPECT_EQ(normal_push(k, depth, -10, 0.5, step).force, 0);
}

TEST(NormalPush, IsCriticalAtRatioOne) {   // m x'' = -k x - c x' has c = 2 sqrt(k m)
    const double m = 1e-9, step = 1e-7, k = penalty_stiffness(m, step);
    const double c = (normal_push(k, 1e-6, 0.1, 1, step).force - k * 1e-6) / 0.1;
    EXPECT_NEAR(c, 2 * std::sqrt(k * m), 1e-12 * c);
}
