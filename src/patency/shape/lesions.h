// SPDX-License-Identifier: Apache-2.0
// Where a vessel is narrow, against what it would be without: reference diameters, stenosis, and the healthy diameter
// along every line. Works from radii and sections alone; says nothing of flow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "patency/shape/sections.h"

namespace patency {

/// A healthy lumen at some place: the largest sphere's diameter [m] and the section's area [m^2].
struct Reference {
    double diameter, area;
};

/// A place where the lumen narrows and widens again. Arcs are along `line` from the inlet [m].
struct Lesion {
    std::size_t branch, line;
    double start_arc, throat_arc, end_arc;
    Vec3 place;                                      ///< of the throat [m]
    double minimum_diameter;                         ///< of the smallest of the largest spheres: what passes [m]
    double minimum_area;                             ///< of the smallest section [m^2]
    std::optional<Reference> proximal{}, distal{};   ///< none where the branch leaves no room for it
    Reference interpolated{};                        ///< at the throat
    double diameter_stenosis = 0;                    ///< 1 - minimum / interpolated diameter
    double area_stenosis = 0;                        ///< 1 - minimum / interpolated area

    double length() const { return end_arc - start_arc; }   ///< [m]
};

struct LesionRule {
    double least_stenosis = 0.25;   ///< of the diameter: mild, CAD-RADS 2.0 (Cury et al. 2022); less is none
    double longest_half = 10;       ///< in vessel diameters: it must widen again so near to its throat
    double shoulder_gain = 0.05;    ///< a lesion ends where the lumen widens by no more than this share
    double reference_length =
        1.5;   ///< in vessel diameters: of the segments beyond the shoulders, 5 mm of a 3.3 mm one
};

struct Assessment {
    std::vector<Lesion> lesions;   ///< by falling diameter stenosis
    /// Per line and point: the lumen without its lesions and without the bulges of its bifurcations (14.8): the diameter
    /// of the largest sphere [m], and the area of the section [m^2].
    std::vector<std::vector<double>> healthy_diameter, healthy_area;
};

/// Valleys of the diameter along each line (14.5); a tapering, the step at a bifurcation and the bulge in it are none.
/// Shoulders (14.6) and references (14.7) lie in the lesion's own branch, with no other branch between (Mintz et al.
/// 2001); a lesion in a bifurcation belongs to the branch after it.
Assessment assess_lesions(const BranchedLines& vessel, const std::vector<std::vector<CrossSection>>& sections,
                          const LesionRule& rule = {});

/// Values per point of a line, at an arc length from the inlet [m]; the line's ends beyond them.
double value_at(const Centreline& line, const std::vector<double>& values, double arc);

}   // namespace patency
