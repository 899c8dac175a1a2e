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
/// that a whole number fills them (rows at (k + 1/2) cells from plates, flat openings between rows), and along the
/// others, by about a part in a million, so that a whole number of cells has the lumen's volume. THEORY.md (17.3)
Lattice fitted_lattice(const Lumen& lumen, double spacing);

/// All lattice points in `region` that `wanted` accepts; x varies fastest. The region must be finite.
std::vector<Vec3> lattice_points(const Lattice& lattice, const Bounds& region,
                                 const std::function<bool(const Vec3&)>& wanted);

/// The lattice points inside the lumen (contains), behind its openings.
std::vector<Vec3> make_lattice(const Lumen& lumen, double spacing);

/// True if the lumen's lattice meets all its walls half-way between points: boxes, channels. It needs no relaxation.
bool lattice_fits(const Lumen& lumen);

/// How far the points reach. Past the openings: whole cells of a lattice that lies along them.
struct PointsExtent {
    double wall_thickness = 0;    ///< points of the wall lie at 0 < distance < this [m]
    double fluid_extension = 0;   ///< fluid this far past each opening [m]
    double wall_extension = 0;    ///< wall this far past each opening [m]; the fluid's and the kernel's support
};

/// Points for the fluid and the wall.
struct FittedPoints {
    std::vector<Vec3> fluid;   ///< those of the lumen, then those past opening 0, 1, ..
    std::vector<Vec3> wall;
    std::vector<Vec3> filler;               ///< inside, past the fluid's end, as far as the wall: for relaxation only
    std::vector<std::size_t> fluid_count;   ///< in the lumen, past opening 0, past opening 1, ..
    std::vector<double> fluid_end;          ///< where the fluid ends past each opening [m]
    std::vector<double> wall_end;           ///< where the wall ends past each opening [m]
    double volume;                          ///< of one point [m^3]; planar: [m^2]
};

/// The points of fitted_lattice. The number of fluid points times `volume` is the lumen's volume exactly
/// (area x extension past an opening to within half a point), and the wall's likewise: the points deepest inside are taken.
/// So on a curved wall some points lie on the wrong side of a face, by less than a spacing; relaxation moves them.
/// Throws GeometryError if the lumen is too narrow to have that many.
FittedPoints make_fitted_points(const Lumen& lumen, double spacing, const PointsExtent& extent);

}   // namespace patency
