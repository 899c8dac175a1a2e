// SPDX-License-Identifier: Apache-2.0
// Exact signed distances of the elementary shapes, each in its own frame (axes along x); move them with
// moved(). Values and gradients are exact to round-off, curvatures are the closed forms.
#pragma once

#include <array>
#include <vector>

#include "patency/shape/signed_distance.h"

namespace patency {

/// Everything: a fluid without walls (a periodic box). The value is minus infinity, the gradient zero.
SignedDistance everywhere();

/// The half-space behind the plane through point [m] with normal out of it (any length > 0).
SignedDistance half_space(const Vec3& point, const Vec3& normal);

/// The box between low and high [m], walls only across the axes that say so: walled = {false, true, false} is
/// the space between two plates. Axes without walls are infinite.
SignedDistance box_between(const Vec3& low, const Vec3& high, std::array<bool, 3> walled = {true, true, true});

/// The gap between two plates, 0 < y < gap [m], infinite in x and z: |y - gap/2| - gap/2.
SignedDistance gap_between_plates(double gap);

/// The gap below a plate at y = gap and above one at y = height for x < at, which drops to y = 0 there [m]; infinite in x and z.
SignedDistance stepped_gap(double gap, double height, double at);

/// One point of a tube's outline: the radius at a position along the x axis.
struct AxialRadius {
    double axial;    ///< [m]
    double radius;   ///< [m], >= 0
};

enum class TubeEnds {
    open,     ///< the first and the last radius go on straight for ever
    capped,   ///< flat caps close the body
};

/// The round body around the x axis whose outline is piecewise linear: tube, cone, nozzle, sudden expansion.
/// The distance is exact, to the polyline in the (axial, radial) half-plane. outline: at least one point,
/// axial not falling; two points with the same axial position are a step.
/// Throws GeometryError if the outline is none.
SignedDistance body_of_revolution(std::vector<AxialRadius> outline, TubeEnds ends);

/// The infinite round tube around the x axis [m].
SignedDistance round_tube(double radius);

/// A straight piece of a vessel: all spheres along it, their radii linear in between (a round cone).
struct RoundCone {
    Vec3 start, end;                   ///< [m]
    double start_radius, end_radius;   ///< [m], > 0
};

/// The union of round cones, which is a network of tapered round tubes with smooth joints:
/// value = min over all spheres (|x - centre| - radius). Exact for one piece, and outside; inside a union
/// only |value| <= the true distance, near the edges where pieces meet. At least one piece.
SignedDistance union_of_round_cones(const std::vector<RoundCone>& pieces);

}   // namespace patency
