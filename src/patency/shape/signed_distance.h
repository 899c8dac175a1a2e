// SPDX-License-Identifier: Apache-2.0
// The signed distance to the wall of a lumen: NEGATIVE inside the lumen, zero on the wall, positive outside.
// A value that can be copied and combined; whoever can sample a distance (a formula here, a grid read from a
// file later) can be one. Knows nothing of openings (lumen.h) or of particles.
#pragma once

#include <functional>
#include <limits>
#include <utility>

#include "patency/base/vec.h"

namespace patency {

/// An axis-aligned box [m]; a side may be infinite.
struct Bounds {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{-infinity, -infinity, -infinity};
    Vec3 high{infinity, infinity, infinity};
};
Bounds joined(const Bounds& a, const Bounds& b);   ///< the smallest box around both
Bounds common(const Bounds& a, const Bounds& b);   ///< what both share
Bounds grown(const Bounds& a, double margin);      ///< margin [m] more on every side

/// x -> origin + rotation x: a rigid motion from a shape's own frame to the world's.
struct RigidMotion {
    Mat3 rotation = identity<double>();   ///< orthonormal, determinant 1
    Vec3 origin{};                        ///< [m]

    Vec3 place(const Vec3& x) const { return origin + rotation * x; }
    Vec3 turn(const Vec3& direction) const { return rotation * direction; }
    Vec3 place_back(const Vec3& x) const { return transpose(rotation) * (x - origin); }
    /// First inner, then this.
    RigidMotion after(const RigidMotion& inner) const { return {rotation * inner.rotation, place(inner.origin)}; }
};
/// The motion that carries the x axis to direction (any length > 0) and the origin to origin [m].
RigidMotion motion_along(const Vec3& direction, const Vec3& origin);
/// The box around a box that was moved.
Bounds moved(const Bounds& bounds, const RigidMotion& motion);

/// What a signed distance says about one place.
struct DistanceSample {
    double value = 0;       ///< distance to the wall [m], negative inside
    Vec3 gradient{};        ///< unit vector out of the lumen; on the medial axis one of the possible ones
    double curvature = 0;   ///< Laplacian of the distance [1/m]: 1/r for a tube at radius r, 0 for a plane
};

class SignedDistance {
public:
    using Sampler = std::function<DistanceSample(const Vec3&)>;
    using NearSampler = std::function<DistanceSample(const Vec3&, double reach)>;

    /// sampler: pure, safe to call from several threads; bounds: a box around the inside; near_sampler: what
    /// sample_within says, if that can be said sooner.
    SignedDistance(Sampler sampler, Bounds bounds, NearSampler near_sampler = {})
        : sampler_(std::move(sampler)), near_sampler_(std::move(near_sampler)), bounds_(bounds) {}

    DistanceSample sample(const Vec3& x) const { return sampler_(x); }
    /// Of a place that lies in the lumen or nearer to the wall than `reach` [m]: the sample where the wall is nearer than
    /// that. Where it is not, a value between the distance and -reach, and any gradient: deep in a vessel all sides are
    /// about as near, and which is nearest takes long to find.
    DistanceSample sample_within(const Vec3& x, double reach) const {
        return near_sampler_ ? near_sampler_(x, reach) : sampler_(x);
    }
    double value(const Vec3& x) const { return sampler_(x).value; }           ///< [m], negative inside
    Vec3 gradient(const Vec3& x) const { return sampler_(x).gradient; }       ///< unit, out of the lumen
    double curvature(const Vec3& x) const { return sampler_(x).curvature; }   ///< [1/m]
    const Bounds& bounds() const { return bounds_; }                          ///< a box around the inside

private:
    Sampler sampler_;
    NearSampler near_sampler_;
    Bounds bounds_;
};

/// The distance that `make` makes, made when it is first asked: a lumen is measured and planned with long before particles
/// need its distance. Ask once outside of parallel loops. What make throws comes with the first question.
SignedDistance made_when_asked(std::function<SignedDistance()> make, const Bounds& bounds);

/// The Laplacian of a distance [1/m] by central differences of its gradient over +-step [m], for samplers
/// that have no formula; its error is O(step^2) where the distance is smooth.
double curvature_by_differences(const SignedDistance& distance, const Vec3& x, double step);

// Combinations. The wall that results is exact; so is its distance, except where it says "bound".

/// The lumen of a or b: the smaller distance. Exact outside; inside only |value| <= the true distance, which
/// differs near the edges where the two meet. Its zero set and its sign are exact.
SignedDistance union_of(SignedDistance a, SignedDistance b);
/// What is in a and in b: the larger distance. Exact inside; outside a bound near the edges.
SignedDistance intersection_of(SignedDistance a, SignedDistance b);
/// What is not in a.
SignedDistance complement_of(SignedDistance a);
/// The surface at distance [m] outside a (inside if negative): the outer face of a wall, a crimped lumen.
SignedDistance offset_by(SignedDistance a, double distance);
/// a after a rigid motion.
SignedDistance moved(SignedDistance a, const RigidMotion& motion);

}   // namespace patency
