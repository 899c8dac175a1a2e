// SPDX-License-Identifier: Apache-2.0
// The field whose zero level is the wall of a network of tubes. Negative inside; its zero level is exact, its values are
// distances only roughly. For network*.cpp.
#pragma once

#include <vector>

#include "patency/base/pack.h"
#include "patency/shape/network.h"
#include "patency/shape/signed_distance.h"

namespace patency {

/// One tube: the distance to its centreline less the radius at the nearest point. Sections across the centreline are
/// circles of just that radius. Ends are round.
class TubeField {
public:
    explicit TubeField(const Tube& tube);

    /// [m]. Where it is above `ceiling` any number above that may come instead, sooner.
    double value(const Vec3& x, double ceiling = Bounds::infinity) const;
    double distance_from_axis(const Vec3& x) const;   ///< [m]
    double steepest() const { return steepest_; }     ///< largest slope
    const Bounds& bounds() const { return bounds_; }

private:
    struct Nearest {
        double squared_distance, radius;
    };
    static constexpr int run_length = 8;   // pieces; a compromise between spheres and pieces to look at
    struct Run {   // some pieces in a row, side by side, and a sphere around them; the last of them again to fill it
        using P = Pack<double, run_length>;
        std::size_t first;
        Vec3 centre;
        double reach;
        Vec<P> start, piece;
        P square;   // of the piece's length
    };
    Nearest nearest(const Vec3& x) const;

    std::vector<Vec3> points_;
    std::vector<double> radii_;
    std::vector<Run> runs_;
    double largest_radius_ = 0, steepest_ = 1;
    Bounds bounds_;
};

/// All tubes, rounded into each other where their walls come nearer than the blend k [m]: in the order of the tubes
///     f = a (1 - h) + b h - k h (1 - h),   h = clamp(1/2 + (a - b) / (2 k), 0, 1),
/// the smooth minimum of what was before (a) and the next tube (b).
class NetworkField {
public:
    explicit NetworkField(const Network& network);
    double value(const Vec3& x) const;   ///< [m]
    double steepest() const { return steepest_; }
    const Bounds& bounds() const { return bounds_; }

private:
    std::vector<TubeField> tubes_;
    double blend_, steepest_ = 1;
    Bounds bounds_;
};

}   // namespace patency
