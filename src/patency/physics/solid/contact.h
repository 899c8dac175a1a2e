// SPDX-License-Identifier: Apache-2.0
// What a point that has gone into a surface feels: a push out of it in proportion to the depth, damped, and Coulomb's
// friction with a stick that is a spring.                                                 THEORY (21.6) to (21.11), (21.15)
#pragma once

#include <algorithm>
#include <cmath>

#include "patency/base/vec.h"

namespace patency {

/// The share of m*/dt^2 that a push may have: it then adds a twentieth to what an explicit step bears.
inline constexpr double penalty_share = 0.1;

/// Stiffness [N/m] for the joint mass m* [kg] of what touches, and the step dt [s] it is to be stable for.  THEORY (21.6)
inline double penalty_stiffness(double mass, double dt) { return penalty_share * mass / (dt * dt); }

struct NormalPush {
    double force = 0;      ///< >= 0 [N]
    double unsprung = 0;   ///< what of it is not the spring's, which stores nothing [N]
};

/// The spring of `stiffness` [N/m], a `held` part [N] and a damper of `ratio` of the critical damping, which never pull together;
/// approach: how fast the depth [m] grows [m/s]; step [s]: that of the stiffness.                THEORY (21.9), (21.11)
inline NormalPush normal_push(double stiffness, double depth, double held, double approach, double ratio, double step) {
    const double damper = 2 * ratio * stiffness * step / std::sqrt(penalty_share);
    const double force = std::max(0.0, stiffness * depth + held + damper * approach);
    return {force, force - stiffness * std::max(0.0, depth)};
}

/// How a push that lasts is held: by up to `ratio` times its spring's force, so that at rest it is as deep as with a spring so
/// much stiffer and one more; this grows over so many of the steps that the stiffness is for, times how much lighter the joint mass
/// is than that which is pushed, and what is quicker meets the spring.
struct Hold {
    double ratio = 0, steps = 1;   // nothing is held
};
inline constexpr Hold hold_at_rest{9, 50};   ///< where solids come to rest, whose drag takes what such a push drives
/// Where solids are driven nothing else takes that: more slowly, with a damper.                           THEORY (21.15)
inline constexpr Hold hold_when_driven{90, 8000};
inline constexpr double damping_when_driven = 0.1;

/// The held part [N] after a step dt, from that before; step [s]: that of the stiffness, times how much lighter the joint mass is.
/// None pulls.                                                                                            THEORY (21.11)
inline double held_push(double held, const Hold& hold, double stiffness, double depth, double dt, double step) {
    const double share = std::min(1.0, dt / (hold.steps * step));
    return std::max(0.0, held + share * (hold.ratio * stiffness * depth - held));
}

struct FrictionState {
    Vec3 force;        ///< on the point, along the surface [N]
    Vec3 stick;        ///< what the spring is stretched by, after the step [m]
    double loss = 0;   ///< work of sliding in the step [J]
};

/// stick: before the step [m]; slide: how the point moved against the surface in the step [m]; normal: of the surface, unit;
/// push: its normal force, >= 0 [N]; stiffness of the spring [N/m].                                        THEORY (21.8)
inline FrictionState friction(const Vec3& stick, const Vec3& slide, const Vec3& normal, double push, double stiffness,
                              double coefficient) {
    const Vec3 stretched = stick + slide;
    const Vec3 trial = stretched - dot(stretched, normal) * normal;   // the surface may have turned
    const double length = norm(trial), most = coefficient * push / stiffness;
    if (length <= most) return {-stiffness * trial, trial, 0};
    const Vec3 kept = (most / length) * trial;
    return {-stiffness * kept, kept, stiffness * most * (length - most)};
}

}   // namespace patency
