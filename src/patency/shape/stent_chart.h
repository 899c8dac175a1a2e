// SPDX-License-Identifier: Apache-2.0
// What struts enclose: the unrolled tube on a fine grid, its metal cut out cell by cell. Gives measures and a mesh.
#pragma once

#include <vector>

#include "patency/shape/stent_metal.h"
#include "patency/shape/surface.h"

namespace patency {

/// An opening between struts, at the middle of the wall.
struct StentCell {
    double area;        ///< [m^2]
    double perimeter;   ///< its free edge [m]
    double inscribed;   ///< the diameter of the largest circle in it [m]
    FlatPoint centre;   ///< of that circle
};

/// THEORY (16.4).
struct StentMeasures {
    double plan_area;      ///< of the metal at the middle of the wall [m^2]
    double edge_length;    ///< of all strut edges there [m]
    double volume;         ///< of the metal, rounded edges taken off [m^3]
    double surface_area;   ///< [m^2]
    double metal_ratio;    ///< outer face of the metal over the cylinder around it: metal to artery
    std::vector<StentCell> cells;
};

/// Measured on a grid of `resolution` [m] (0: a sixth of the thinnest strut); areas err by about (resolution / crown radius)^2.
/// Throws GeometryError if struts overlap or do not join: if the metal falls into pieces or has other cells than the pattern.
StentMeasures measure_stent(const StrutCurves& curves, double resolution = 0);

/// The metal as a closed surface with sharp edges, along an axis. Points 2k are on the outer face, 2k + 1 below them on the
/// inner one.
Surface make_stent_surface(const StrutCurves& curves, const StentAxis& axis = {}, double resolution = 0);

}   // namespace patency
