// SPDX-License-Identifier: Apache-2.0
// The diagnosis of a lumen's surface: what is wrong with it, what of that was repaired, and where it is open. Reads no
// files; the openings of closed ends are surface_openings.h's.
#pragma once

#include <string>
#include <vector>

#include "patency/shape/flat_loop.h"
#include "patency/shape/surface_finding.h"

namespace patency {

struct CheckedSurface {
    Surface surface{};                 ///< after the repairs; outward is outside
    std::vector<Finding> findings{};   ///< in the order they were made
    std::vector<FlatLoop> ends{};      ///< loops at which the vessel is open; the largest first
    double volume = 0;                 ///< with the ends closed by flat faces [m^3]
};

/// All repairs of surface_repair.h, then what they cannot mend: holes, edges of more than two triangles, parts that pass
/// through each other. Throws GeometryError if nothing is left.
CheckedSurface check_surface(Surface surface);

/// Why a loop is a hole and not an open end of a vessel, as the rest of a sentence "it ..."; empty if it is an end.
/// An end is flat, round and has enough edges, and the wall comes to it from behind, while a hole lies within the wall.
std::string why_not_an_end(const Surface& surface, const FlatLoop& loop, const std::vector<EdgeUse>& boundary);

/// Sentences of the refused findings, one line each; empty if the surface can be used.
std::string refusals(const std::vector<Finding>& findings);

}   // namespace patency
