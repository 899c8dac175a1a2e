// SPDX-License-Identifier: Apache-2.0
// Centrelines: from the inlet to every outlet the line of the centres of the largest spheres that fit the lumen. No seeds
// are chosen by hand. Branches are branches.h's, sections across them sections.h's.
#pragma once

#include <string>
#include <vector>

#include "patency/shape/lumen.h"

namespace patency {

struct CentrelinePoint {
    Vec3 place;      ///< [m]
    Vec3 tangent;    ///< unit, away from the inlet
    double radius;   ///< of the largest sphere around this place that fits the lumen [m]
    double arc;      ///< along the line from the inlet [m]
};

struct Centreline {
    std::string outlet;                                   ///< the name of the opening at its end
    std::vector<CentrelinePoint> points{};                ///< evenly spaced by arc, but for the last one
    double length() const { return points.back().arc; }   ///< [m]
};

/// The place at an arc length from the inlet [m], linear between points; the line's ends for arcs beyond them.
CentrelinePoint point_at(const Centreline& line, double arc);

/// How many points two lines have in common, from the inlet on.
std::size_t shared_points(const Centreline& a, const Centreline& b);

/// One line per opening but the inlet, in their order; all start at the inlet's centre along its normal and end so at
/// their outlet. Lines share the points up to where they part, bit for bit, and have the same spacing: half the smallest
/// radius, or what gives 50,000 points in all. Centred by (14.2), radii by (14.3). The distance may be one with the
/// openings closed by flat caps, or one that goes on through them.
/// Throws GeometryError if an opening is not connected with the inlet, naming it (find_ways).
std::vector<Centreline> find_centrelines(const SignedDistance& distance, const std::vector<Opening>& openings,
                                         std::size_t inlet = 0);

}   // namespace patency
