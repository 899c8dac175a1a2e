// SPDX-License-Identifier: Apache-2.0
// Values of the blood at places between its particles: at points, along lines. Reads particles; moves none.
#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "patency/bodies/fluid.h"
#include "patency/search/cells.h"

namespace patency {

/// What is known at one place.
struct FlowSample {
    Vec3 velocity;            ///< [m/s]; NaN where no particle is near
    double pressure;          ///< above the reference pressure [Pa]; NaN where no particle is near
    Mat3 velocity_gradient;   ///< row a: gradient of v_a [1/s]
    int neighbours;           ///< particles that took part
};

/// Where the wall is, for samples near it: the distance (negative inside) and its gradient out of the blood, and the
/// wall's velocity.
struct WallHint {
    std::function<double(const Vec3&)> distance;   ///< [m]
    std::function<Vec3(const Vec3&)> normal;
    std::function<Vec3(const Vec3&)> velocity;   ///< of the surface near a place [m/s]; empty: at rest
    /// Points all over the surface, half of the reach apart or less, if somebody has them [m]. Else points near each place are found
    /// by distance and normal, which takes longer than all the rest.
    std::vector<Vec3> points{};
};

/// A length [m] that may depend on the place; a number is the same everywhere.
class LocalLength {
public:
    LocalLength(double length) : at_([length](const Vec3&) { return length; }) {}
    template <class F>
    requires std::is_invocable_r_v<double, F, const Vec3&> LocalLength(F at) : at_(std::move(at)) {}

    double operator()(const Vec3& place) const { return at_(place); }

private:
    std::function<double(const Vec3&)> at_;
};

/// Weighted least squares with a full quadratic through the particles within `reach` of each place (a linear one where
/// they are too few), weights of the Wendland kernel: exact for quadratic fields, third order. With a hint, places
/// nearer to the wall than `reach` also see the wall's velocity, at points of the surface near them. `reach` is best 2h.
/// Periodic frames are seen through.
std::vector<FlowSample> sample_flow(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> places,
                                    const LocalLength& reach, bool planar, const WallHint* wall = nullptr);

/// The same at places on the wall itself with unit normals out of the blood, where blood sticks to the wall and nothing acts but
/// pressure, friction and a force per volume [N/m^3]: there the curvature of the velocity is known from the pressure's gradient, and the
/// fit is free to follow how it changes. viscosity_at: of the shear rate [1/s]: [Pa s].             THEORY.md (5.7)
std::vector<FlowSample> sample_at_wall(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> places,
                                       std::span<const Vec3> normals, const LocalLength& reach, const WallHint& wall,
                                       const std::function<double(double)>& viscosity_at, const Vec3& force);

/// `count` places from one point to another, both included [m].
std::vector<Vec3> places_along(const Vec3& from, const Vec3& to, int count);

}   // namespace patency
