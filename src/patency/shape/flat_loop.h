// SPDX-License-Identifier: Apache-2.0
// Closed lines on a surface: the boundaries of its triangles, and their measures as the rim of something flat. Whether
// a rim is an opening or a hole is decided by others (surface_check.h, surface_openings.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

/// A closed line of points, as a flat face within it would be measured.
struct FlatLoop {
    std::vector<std::uint32_t> rim{};   ///< indices of the surface's points; the last is followed by the first
    Vec3 centre{};          ///< centroid of the area, or mean of the points where that has none among them [m]
    Vec3 normal{};          ///< unit; of the face that would close the surface: outward
    double area = 0;        ///< [m^2]
    double perimeter = 0;   ///< [m]
    double reach = 0;       ///< from the centre to the farthest point of the rim [m]
    double flatness = 0;    ///< largest distance of the rim from its plane [m]

    double diameter() const;    ///< of a disc of the same area [m]
    double roundness() const;   ///< 4 pi area / perimeter^2: 1 for a circle, 0.79 for a square
};

FlatLoop measured_loop(const Surface& surface, std::vector<std::uint32_t> rim);

/// The closed lines around the triangles, given as the edges that only one of them has. Where lines touch in a point
/// they are kept apart; edges that lie on no closed line (possible only if triangles disagree on which side is out, or
/// more than two share an edge) are left out.
std::vector<FlatLoop> find_loops(const Surface& surface, std::span<const EdgeUse> boundary);

/// The edges of the surface that only one triangle has.
std::vector<EdgeUse> boundary_edges(std::span<const EdgeUse> uses);

/// The surface with every loop closed by triangles around its centre, face ids -1 if the surface has any.
Surface closed_at(Surface surface, std::span<const FlatLoop> loops);

/// Volume of the surface when its loops are closed by flat faces [m^3].
double closed_volume(const Surface& surface, std::span<const FlatLoop> loops);

}   // namespace patency
