// SPDX-License-Identifier: Apache-2.0
// A lumen: the wall's signed distance, the openings, and the exact measures of the space between them.
// Made here from typed parameters; files come elsewhere. No particles (sampling.h).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "patency/shape/distance_shapes.h"
#include "patency/shape/passage.h"
#include "patency/shape/signed_distance.h"

namespace patency {

/// A flat end through which blood enters or leaves.
struct Opening {
    std::string name;
    Vec3 centre;     ///< [m]
    Vec3 normal;     ///< unit, OUT of the lumen
    double area;     ///< [m^2]; planar: width [m], which is the area per metre of depth
    double radius;   ///< equivalent, sqrt(area / pi) [m]; planar: half the width
    double reach;    ///< from the centre to the farthest point of the opening [m]
    bool planar;
    double mean_square;   ///< mean over the opening of the squared distance from its centre [m^2]
};

/// A place seen from an opening.
struct OpeningCoordinates {
    double s;      ///< along the normal [m], positive outside of the lumen
    Vec3 radial;   ///< across the normal, from the opening's axis [m]
};
OpeningCoordinates opening_coordinates(const Opening& opening, const Vec3& x);

struct Lumen {
    /// Of the lumen continued straight through its openings (by `extension` at least): the lumen itself is
    /// the part behind the opening planes.
    SignedDistance distance;
    std::vector<Opening> openings;
    double volume;                         ///< behind the opening planes [m^3]; planar: [m^2], per metre of depth
    double wall_area;                      ///< without the openings [m^2]; planar: [m]
    bool planar = false;                   ///< all in the plane z = 0
    double extension = Bounds::infinity;   ///< how far the distance goes on straight past an opening [m]
    Bounds bounds;                         ///< around the lumen behind its openings [m]
    double narrowest = 0;   ///< the smallest width anywhere: a gap, a side or a diameter [m]; 0 if nobody said
    Passage passage{};
    Vec3 period{};   ///< the length of the periodic box per axis [m], 0 where it is not periodic
    /// Where lattices of particles are laid: cell faces pass through the frame's origin, and along an axis with
    /// fit > 0 a whole number of cells fills that length [m].
    RigidMotion frame{};
    Vec3 fit{};
    /// The same distance from the triangles themselves (exact_distance.h), where `distance` is a grid's: slower, but its
    /// nearest place lies on the wall to round-off. None where `distance` is as good.
    std::optional<SignedDistance> exact{};
};

/// Which opening's straight continuation holds x (its index), or -1. x may lie up to `margin` [m] beside the
/// opening's reach and past the continuation's end (for places inside the wall).
int opening_beyond(const Lumen& lumen, const Vec3& x, double margin = 0);

/// Inside the wall and behind all openings. The plane of one opening does not cut off another branch.
bool contains(const Lumen& lumen, const Vec3& x);

/// The lumen after a rigid motion. A planar lumen may only turn about z, a periodic one only shift: otherwise
/// GeometryError.
Lumen moved(Lumen lumen, const RigidMotion& motion);

/// What closes a box across one axis.
enum class Side { wall, open, periodic };

/// The box 0 < x, y, z < size [m]. Openings: inlet at x = 0 and outlet at x = size.x; y_low, y_high, z_low,
/// z_high for the others.
struct BoxShape {
    Vec3 size;
    std::array<Side, 3> sides = {Side::wall, Side::wall, Side::wall};
    bool planar = false;   ///< z and its side are void
};
Lumen make_box(const BoxShape& shape);

/// Planar, 0 < x < length between plates at y = 0 and y = gap [m].
struct ChannelShape {
    double length, gap;
    Side ends = Side::open;
};
Lumen make_channel(const ChannelShape& shape);

/// Planar, 0 < x < length below a plate at y = gap and above one at y = height that drops to y = 0 at x = at [m].
struct StepShape {
    double length, gap, height, at;
};
Lumen make_step(const StepShape& shape);

/// Round, around the x axis, 0 < x < length [m].
struct TubeShape {
    double length, radius;
    Side ends = Side::open;
};
Lumen make_tube(const TubeShape& shape);

/// A tapered tube around the x axis, 0 < x < length [m].
struct ConeShape {
    double length, inlet_radius, outlet_radius;
};
Lumen make_cone(const ConeShape& shape);

/// A round tube of piecewise linear radius around the x axis; inlet and outlet are at its ends.
struct NozzleShape {
    std::vector<AxialRadius> outline;   ///< two points at the same place are a step
};
Lumen make_nozzle(const NozzleShape& shape);

/// A branch: a centreline with radii, linear in between. An end with a name is an opening across the
/// centreline; one without lies inside another branch (or is a round blind end).
struct BranchShape {
    std::vector<Vec3> points;    ///< [m], two or more
    std::vector<double> radii;   ///< [m], one per point
    std::string start, end;
};
struct BranchesShape {
    std::vector<BranchShape> branches;
    double extension;   ///< how far the lumen goes on straight past its openings [m]
};
/// The union of tapered round tubes (union_of_round_cones). Volume and area are measured (measure.h) to about
/// 1e-4. Throws GeometryError if an opening or its straight continuation runs into another branch.
Lumen make_branches(const BranchesShape& shape);

}   // namespace patency
