// SPDX-License-Identifier: Apache-2.0
// A network of tubes: centrelines with radii, how they hang together and where they are open, and a lesion in one of
// them. The space inside is network_lumen.h's, files are io's (network_file.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "patency/base/vec.h"
#include "patency/shape/passage.h"

namespace patency {

/// An end of a tube through which blood enters or leaves, cut flat across.
struct TubeOpening {
    std::string name;
    Vec3 normal;   ///< unit, out of the tube
};

struct Tube {
    std::string name;
    std::vector<Vec3> points;                    ///< of the centreline [m], two or more
    std::vector<double> radii;                   ///< one per point, linear in between [m]
    std::optional<TubeOpening> start{}, end{};   ///< none: the end lies within another tube, or is closed and round
};

struct Network {
    std::vector<Tube> tubes;
    double blend = 0;      ///< how far from each other two tubes' walls begin to round into one [m]; 0: a sharp edge
    std::string space{};   ///< axes of the coordinates: "LPS", "RAS", or empty if nobody said
};

/// Throws GeometryError for tubes that cannot be: fewer than two points, points that repeat or are no place in a body, radii
/// that are not positive, two tubes of one name.
void expect_tubes(const Network& network);
/// The same, and for tubes that do not hang together and fewer than two openings.
void expect_sound(const Network& network);

/// The tubes between the branching points and ends of a graph. points and radii [m], edges between indices of points.
/// Points of equal coordinates count as one. A branch begins with its own radius, not with that of the
/// vessel it leaves. Names are branch_1, branch_2... No end is open yet. Throws GeometryError for a closed ring.
Network network_of_graph(const std::vector<Vec3>& points, const std::vector<double>& radii,
                         const std::vector<std::array<std::uint32_t, 2>>& edges);

/// Cuts tubes that run on top of an earlier one (within a tenth of the radius) down to where they part from it.
void part_shared_tubes(Network& network);

/// Makes openings of the ends that lie in no other tube, across the tube's last radius of length. The widest is inlet,
/// the others by falling area outlet_1, outlet_2..., or outlet_TUBE if the tubes have names of their own.
void open_free_ends(Network& network);

/// Makes an opening of the tube that the plane through point cuts across, there, and drops what lies past the plane. normal: out of the
/// vessel. Throws GeometryError if no tube passes through point across the plane.
void open_at(Network& network, const std::string& name, const Vec3& point, const Vec3& normal);

double narrowest_diameter(const Network& network);   ///< [m]
double widest_diameter(const Network& network);      ///< [m]
/// When flows go with the cube of healthy radii (Murray 1926), a tube's healthy radius being its largest. The drag is that
/// of all tubes in a row, no less than that of any way through them.
Passage passage_of(const Network& network);

double length_of(const Tube& tube);   ///< along the centreline [m]

/// A narrowing with the profile of a cosine: radius = healthy (1 - stenosis (1 + cos(2 pi z / length)) / 2) at a
/// distance z < length / 2 along the centreline from its middle.
struct Narrowing {
    std::string tube;
    double
        position;   ///< of the middle: distance along the centreline from the tube's first point, or its opening there [m]
    double length;             ///< [m]
    double stenosis;           ///< 0..1, of the diameter at the middle
    double eccentricity = 0;   ///< 0: plaque all around; 1: the lumen touches the healthy wall opposite to the plaque
    std::optional<Vec3>
        side{};   ///< direction from the axis to the plaque (the part across the axis counts); absent: any
};
/// Throws GeometryError if the tube is not there, or too short for the lesion.
void add_lesion(Network& network, const Narrowing& lesion);

}   // namespace patency
