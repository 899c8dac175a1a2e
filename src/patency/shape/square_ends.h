// SPDX-License-Identifier: Apache-2.0
// How square the ends of a vessel are to its axis, and ends cut square to it. Which ends are cut and by how much is decided
// elsewhere (stages/vessel.h).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patency/shape/sections.h"
#include "patency/shape/surface_openings.h"

namespace patency {

/// An opening as the end of a line.
struct AxisEnd {
    std::string name;
    Vec3 normal;              ///< the opening's, unit, outward
    double radius;            ///< the opening's [m]
    std::vector<Vec3> rim;    ///< its points, with those of what closes it [m]
    const Centreline* line;   ///< that ends there, or starts there
    bool is_start;
    double room;   ///< from it along the line to where its branch begins or parts [m]

    /// The place on the line at that depth before the end [m], its tangent outward.
    CentrelinePoint at(double depth) const;
};

/// The openings' ends, in their order: the inlet's line is the first one, the others have one each. They keep pointers to `lines`.
std::vector<AxisEnd> find_ends(const CheckedSurface& checked, std::span<const SurfaceOpening> openings,
                               const BranchedLines& lines);

/// A plane across a vessel's axis.
struct SquareCut {
    double depth;         ///< of its point, along the line before the end [m]
    Vec3 point, normal;   ///< [m]; unit, towards the end
};

/// The plane across the axis at a depth before the end: its normal goes through the centres of the sections behind it, not
/// ahead of it, where an oblique end leaves a part of the wall out, THEORY.md (17.6). None where the branch is too short for a direction, or is not cut in closed sections.
/// `cutter` cuts the surface with its ends closed.
std::optional<SquareCut> square_cut_at(const SectionCutter& cutter, const AxisEnd& end, double depth);

/// The one of least depth that leaves the whole opening past it; of a square end it is the opening's own plane. None where the branch
/// ends before.
std::optional<SquareCut> least_square_cut(const SectionCutter& cutter, const AxisEnd& end);

/// Between the opening's normal and the axis, of a least_square_cut [rad].
double off_square(const AxisEnd& end, const SquareCut& least);

/// Takes away what lies past the cut and hangs together with the end, and leaves it open there. Returns what went, as a finding.
/// Throws GeometryError if not all of the end lies past the plane, another end would go with it, or the plane
/// leaves more than one rim.
Finding cut_end(Surface& surface, std::span<const AxisEnd> ends, std::size_t which, const SquareCut& cut);

}   // namespace patency
