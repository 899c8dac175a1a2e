// SPDX-License-Identifier: Apache-2.0
// Wall shear stress where the wall is, and what a cycle makes of it: TAWSS, OSI, RRT. Reads particles; moves none.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "patency/analysis/sample.h"

namespace patency {

/// Places of a wall: middles of its triangles.
struct WallPlaces {
    std::vector<Vec3> position;   ///< [m]
    std::vector<Vec3> normal;     ///< unit, OUT of the blood
};

/// What the blood does to a wall, one per place.
struct WallFlow {
    std::vector<Vec3> shear_stress;   ///< [Pa], along the wall
    std::vector<double> pressure;     ///< above the reference pressure [Pa]
};

/// The force of the blood along the wall, per area [Pa], at every place: the viscosity at the shear rate there, times the
/// velocity gradient fitted one-sidedly to the blood and to the wall's own velocity. It points where the blood goes. NaN
/// where no blood is within reach. viscosity_at: of the shear rate [1/s]: [Pa s].                THEORY.md (5.4)
/// Pressures are fitted to the blood alone. force: what acts on it beside them, per volume [N/m^3].
WallFlow flow_at_wall(const FluidParticles& fluid, const Frame& frame, const WallPlaces& places,
                      const LocalLength& reach, const WallHint& wall, const std::function<double(double)>& viscosity_at,
                      const Vec3& force = {});

/// What a scheme says itself of small parts of a wall.
struct WallParts {
    WallPlaces places;          ///< their middles
    std::vector<double> area;   ///< [m^2]
    WallFlow flow;
};

/// At every place the plane through the parts within `reach` that face its way, by least squares with the parts' areas and the
/// Wendland kernel's weights: exact for what varies linearly along a flat wall. NaN where no part is within reach.
WallFlow flow_of_parts(const WallParts& parts, const WallPlaces& places, const LocalLength& reach);

/// Means over time of a wall shear stress. Places where any stress was NaN stay NaN.
class WallShearMeans {
public:
    /// stress: one per place, always in the same order [Pa]; it lasted dt [s].
    void add(std::span<const Vec3> stress, double dt);

    double duration() const { return time_; }   ///< [s]
    std::vector<Vec3> mean() const;             ///< of the vector [Pa]
    std::vector<double> tawss() const;          ///< mean of the magnitude [Pa]                        THEORY.md (13.8)
    std::vector<double> osi() const;            ///< oscillatory shear index, 0 to 1/2                 THEORY.md (13.9)
    std::vector<double> rrt() const;            ///< relative residence time [1/Pa]                    THEORY.md (13.10)

    /// For checkpoints: the duration, then four integrals per place.
    std::vector<double> state() const;
    void restore(std::span<const double> state);

private:
    std::vector<Vec3> vector_;   // integrals over time
    std::vector<double> magnitude_;
    double time_ = 0;
};

}   // namespace patency
