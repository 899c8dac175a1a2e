// SPDX-License-Identifier: Apache-2.0
// The line that a stent lies along, as coordinates: radius, angle, place along. A straight stent is bent along a vessel
// by a frame that turns as little as it can (docs/THEORY.md section 16).
#pragma once

#include <span>
#include <vector>

#include "patency/shape/signed_distance.h"

namespace patency {

/// A place seen from the stent's axis.
struct StentPoint {
    double radius;   ///< [m]
    double angle;    ///< [rad]
    double along;    ///< [m] from the stent's middle
};

class StentAxis {
public:
    /// The x axis; the angle runs from y to z.
    StentAxis();
    /// A rigid motion of that.
    explicit StentAxis(const RigidMotion& placement);

    /// Along a line of points [m], two or more: the stent's middle at this arc length [m], turned by `rotation` [rad]
    /// around the line. Arc lengths are the line's own. `length` and `radius` [m] are the stent's, for the checks: throws
    /// GeometryError if it reaches past an end of the line, if the line bends more tightly than the radius (struts on the
    /// inner side would fold), or if it comes back to within two radii of itself.
    StentAxis(std::span<const Vec3> line, double arc_length, double rotation, double length, double radius);

    Vec3 place(const StentPoint& p) const;
    /// The nearest such place; past the ends the line goes on straight.
    StentPoint coordinates(const Vec3& x) const;
    /// The same, looked for first within two points of the line around `along` [m]: fast for a place that moves little.
    StentPoint coordinates(const Vec3& x, double along) const;
    /// A place as a tube around the axis sees it.
    struct Sight {
        double radius, along;    ///< as of coordinates
        Vec3 outward, tangent;   ///< unit
    };
    /// Fast for a place that moves little: `piece` of the axis, from 0, is where it was seen last, or `unseen`, and then where it is now.
    /// One that is elsewhere on an axis that bends far may be seen from a piece whose normal plane it lies in by chance. A place on the axis
    /// is seen along no direction.
    static constexpr std::size_t unseen = std::size_t(-1);
    Sight sight(const Vec3& x, std::size_t& piece) const;
    Vec3 outward(const StentPoint& p) const;   ///< unit, away from the axis
    Vec3 tangent(const StentPoint& p) const;   ///< unit, along the axis
    /// Length along there over length along the axis: THEORY (16.5).
    double stretch(const StentPoint& p) const;

private:
    struct Station {   // of the line
        Vec3 at, tangent, normal;
        double along;
    };
    struct Frame {
        Vec3 at, tangent, normal, binormal;
    };
    std::size_t piece_at(double along) const;
    /// Of the places on some pieces and past the ends, in whose normal plane x lies: the nearest; none: infinitely far.
    struct Foot {
        double along, distance;
    };
    Foot nearest_foot(const Vec3& x, std::size_t first, std::size_t last) const;
    double foot_on(std::size_t piece, const Vec3& x) const;
    StentPoint seen_from(const Vec3& x, double along) const;
    Frame frame_at(double along) const;

    std::vector<Station> stations_;   // two or more
};

}   // namespace patency
