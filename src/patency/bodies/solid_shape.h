// SPDX-License-Identifier: Apache-2.0
// Solids by their measures: particles that fit them and the surface they have. Rows in a box, rings in a cylinder, a
// relaxed arrangement in a sphere; the volumes are those of the particles' own cells and add up to the solid's.
#pragma once

#include <vector>

#include "patency/bodies/solid_surface.h"

namespace patency {

struct SolidFill {
    std::vector<Vec3> places;      ///< m
    std::vector<double> volumes;   ///< m^3; planar: m^2
    SurfaceElements surface;
};

/// The box between two corners; planar: z counts for nothing. Faces x_low, x_high, y_low, y_high, and z_low, z_high.
SolidFill fill_box(const Vec3& low, const Vec3& high, double spacing, bool planar);

/// The cylinder around the axis between two points, with a hole if the inner radius is above zero; planar: the ring around
/// `from`. Faces inner (of a hole), outer, and from, to.
SolidFill fill_cylinder(const Vec3& from, const Vec3& to, double inner_radius, double outer_radius, double spacing,
                        bool planar);

/// Face outer.
SolidFill fill_sphere(const Vec3& centre, double radius, double spacing);

/// What lies in the box between two corners: particles by their places, elements by all their vertices.
SolidFill cut_to_box(const SolidFill& fill, const Vec3& low, const Vec3& high);

}   // namespace patency
