// SPDX-License-Identifier: Apache-2.0
// A pressure on the struts that opens a stent: that of a fluid which is pumped in, and out, at the speed of the program.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "patency/bodies/solid_surface.h"
#include "patency/shape/stent_axis.h"

namespace patency {

/// The inner face of a stent, on the average over its area.
class InnerFace {
public:
    /// Both must outlive it. Along the directions from the axis in the reference configuration: a stent moves along it by little.
    InnerFace(const SolidSurface& stent, const StentAxis& axis);

    double radius() const;                  ///< its distance from the axis now [m]
    double speed() const;                   ///< at which that grows [m/s]
    double area() const { return area_; }   ///< in the reference configuration [m^2]

private:
    struct Place {
        std::uint32_t vertex;
        Vec3 outward;   // times its share of the area
    };
    const SolidSurface& stent_;
    std::vector<Place> places_;
    double area_ = 0, of_axis_ = 0;   // of_axis: what the axis' own places come to along these directions [m]
};

/// Rises as the stent lags behind the program, with the damping that lets neither swing: a stent that gives way does not run
/// ahead. Times of the program [s].                                                                  THEORY (21.17)
struct RadialLoad {
    std::function<double(double time)> pumped;   ///< the radius that the fluid would fill [m]
    std::function<double()> radius, speed;       ///< of the stent's inner face now [m], [m/s]
    double most = 0;                             ///< where it lags by `full_lag` of its radius, or more [Pa]
    double mass_by_area = 0;                     ///< of the stent, over its inner face's [kg/m^2]
    double filled = INFINITY;                    ///< no more is pumped in where the stent is as wide as wanted [m]

    static constexpr double full_lag = 0.05;

    bool is_filled() const { return filled < INFINITY; }
    double pressure(double time) const;
    /// No more is pumped in: as much is there as presses like this where nothing moves.
    void fill(double time);
    /// To be kept and put back.
    std::vector<double*> numbers() { return {&filled}; }
};

}   // namespace patency
