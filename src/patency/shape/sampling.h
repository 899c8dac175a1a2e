// SPDX-License-Identifier: Apache-2.0
// Points inside a lumen and in the wall around it: lattices, body-fitted where the shape allows it (boxes and
// channels exactly), candidates for relaxation (bodies/relax.h) elsewhere.
#pragma once

#include <functional>
#include <vector>

#include "patency/shape/lumen.h"

namespace patency {

/// Cells of `cell` [m] whose faces pass through the frame's origin; points sit in their middles. Planar: z = 0.
struct Lattice {
    RigidMotion frame;
    Vec3 cell;
    bool planar = false;

    double cell_volume() const { return planar ? cell.x * cell.y : cell.x * cell.y * cell.z; }   // [m^3], [m^2]
};

/// The lattice in the lumen's frame: cells of `spacing` [m], stretched along the axes that the lumen fits so
/// that a whole number fills them (rows at (k + 1/2) cells from plates, flat openings between rows).
Lattice fitted_lattice(const Lumen& lumen, double spacing);

/// All lattice points in `region` that `wanted` accepts; x varies fastest. The region must be finite.
std::vector<Vec3> lattice_points(const Lattice& lattice, const Bounds& region,
                                 const std::function<bool(const Vec3&)>& wanted);

/// The lattice points inside the lumen (contains), behind its openings.
std::vector<Vec3> make_lattice(const Lumen& lumen, double spacing);

/// How far the points reach.
struct PointsExtent {
    double wall_thickness = 0;    ///< points of the wall lie at 0 < distance < this [m]
    double fluid_extension = 0;   ///< fluid this far past each opening [m], rounded to whole cells
    double wall_extension = 0;    ///< wall this far past each opening [m]; at least fluid_extension + support
};

/// Lattice points for the fluid and the wall.
struct FittedPoints {
    std::vector<Vec3> fluid;      ///< first those of the lumen, then those past opening 0, 1, ..
    std::vector<Vec3> wall;
    std::vector<std::size_t> fluid_count;   ///< in the lumen, past opening 0, past opening 1, ..
    std::vector<double> fluid_extension;    ///< how far the fluid reaches past each opening [m]
    double volume;                ///< of one point [m^3]; planar: [m^2]
};

/// The points of fitted_lattice. The number of fluid points times `volume` is the lumen's volume (area x
/// extension past an opening) to within half a point: the points deepest inside are taken. So on a curved wall
/// some points lie on the wrong side, by less than a spacing; relaxation moves them.
FittedPoints make_fitted_points(const Lumen& lumen, double spacing, const PointsExtent& extent);

}  // namespace patency
