// SPDX-License-Identifier: Apache-2.0
// Cross-sections of a lumen's surface by planes: the closed line in which the plane cuts the wall around a place, and
// its measures.
#pragma once

#include <vector>

#include "patency/shape/branches.h"
#include "patency/shape/triangle_tree.h"

namespace patency {

struct CrossSection {
    Vec3 place, normal;                       ///< the plane's [m], unit
    std::vector<Vec3> outline{};              ///< corners in the plane, counter-clockwise seen against the normal [m]
    double area = 0;                          ///< [m^2]
    double perimeter = 0;                     ///< [m]
    double least_width = 0, most_width = 0;   ///< between two parallels that touch it, over all directions [m]
    bool is_closed = false;                   ///< false: the surface ends here; a straight line closes the section
    bool holds_place = false;                 ///< false: the nearest outline does not go around the place
    bool is_shared = false;                   ///< another branch passes through it, or it lies in a bifurcation

    double diameter() const;   ///< of a disc of the same area [m]
};

/// Cuts one surface many times. Keeps a reference to it.
class SectionCutter {
public:
    explicit SectionCutter(const Surface& surface) : surface_(surface), tree_(surface) {}

    /// The smallest outline around the place; if none goes around it, the one nearest to it. Exact but for round-off:
    /// a polygon with a corner on every edge that the plane cuts. An area of 0 where the plane cuts nothing.
    CrossSection cut(const Vec3& place, const Vec3& normal) const;

private:
    const Surface& surface_;
    TriangleTree tree_;
};

/// The sections at every point of every line, across its tangent; at points that lines share, the same. The first and
/// the last ones are those within the surface nearest to its ends.
std::vector<std::vector<CrossSection>> cut_sections(const Surface& surface, const BranchedLines& vessel);

}   // namespace patency
