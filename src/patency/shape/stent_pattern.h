// SPDX-License-Identifier: Apache-2.0
// A stent as a pattern of struts cut from a tube: typed parameters -> centrelines on the unrolled tube (docs/THEORY.md
// section 16). The tube is unrolled at its middle radius, where a strut has its width. All diameters are OUTER ones.
#pragma once

#include <string>
#include <vector>

namespace patency {

enum class StentLayout {
    rings,   ///< rings of crowns, joined by connectors
    helix,   ///< one wave of crowns wound up, its turns joined by connectors
};
/// How the crowns of neighbouring rings meet. A helix has crowns + 1/2 per turn, so that its crowns are aligned.
enum class CrownFacing {
    aligned,     ///< tip to tip: connectors run along the axis
    staggered,   ///< tip to gap: connectors lead half a crown aside
};
enum class ConnectorShape {
    straight,
    flex,   ///< S-shaped, along the axis at both tips
};

struct StentPattern {
    StentLayout layout = StentLayout::rings;
    int rings = 0;                 ///< rings; turns of a helix
    int crowns = 0;                ///< peaks of a ring; of a turn of a helix half a peak more
    double length = 0;             ///< over all [m]
    double diameter = 0;           ///< as cut [m]
    double crimped_diameter = 0;   ///< on its balloon [m]
    double nominal_diameter = 0;   ///< opened [m]
    double strut_width = 0;        ///< [m]
    double strut_thickness = 0;    ///< of the tube's wall [m]
    double crown_radius = 0;       ///< of a crown's centreline [m]
    double gap = 0;                ///< free, between the tips of neighbouring rings [m]
    int connectors = 0;            ///< per gap between rings, per turn of a helix; as many as crowns: closed cells
    ConnectorShape connector_shape = ConnectorShape::straight;
    CrownFacing facing = CrownFacing::aligned;
    double connector_width = 0;   ///< [m]; 0: the strut's
    double connector_swing = 0;   ///< flex: how far a connector swings to both sides [m]
    int connector_shift = 0;      ///< crowns from the connectors of one gap to those of the next
    double edge_radius = 0;       ///< rounding of the struts' edges [m]
    std::string alloy{};          ///< one of alloys()
};

/// A place on the unrolled tube [m]: around at the middle radius, along the axis from the stent's middle.
struct FlatPoint {
    double around, along;
};

/// A strut's centreline; `around` may leave [0, circumference).
struct Strut {
    std::vector<FlatPoint> points;
    double half_width;   ///< [m]
};

/// All struts of a stent, unrolled.
struct StrutCurves {
    double middle_radius;   ///< of the tube's wall [m]
    double thickness;       ///< of the wall [m]
    double edge_radius;     ///< [m]
    double length;          ///< [m]; struts lie at |along| <= length / 2
    int cells;              ///< openings that struts surround, the ends of the tube not counted; < 0: not known
    std::vector<Strut> struts;

    double circumference() const;   ///< at the middle radius [m]
};

/// The centrelines; arcs are chords within 1/2000 of the strut's width. Throws GeometryError for a pattern that cannot be
/// made, naming the parameter and its limit.
StrutCurves make_strut_curves(const StentPattern& pattern);

/// From the lowest tip of a ring's centreline to its highest [m], which follows from length, rings and gap: THEORY (16.2).
double ring_amplitude(const StentPattern& pattern);

/// With as many rings, two at the least, or turns of a helix as come nearest to this length [m]; they keep their size and their gaps, as those
/// of a design that is made in several lengths do.
StentPattern with_length(const StentPattern& pattern, double length);

/// The pattern opened or crimped to another outer diameter: struts keep their length and crowns their radius, so rings
/// become shorter as they open; connectors keep the gap, so those that lead aside become longer. Kinematics, no
/// mechanics. Throws GeometryError if the struts are too short or in each other's way.
StentPattern at_diameter(const StentPattern& pattern, double diameter);

struct Alloy {
    const char* name;
    double density;   ///< [kg/m^3]
    const char* description;
};
const std::vector<Alloy>& alloys();
/// Throws GeometryError with the known names.
const Alloy& find_alloy(const std::string& name);

}   // namespace patency
