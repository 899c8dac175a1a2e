// SPDX-License-Identifier: Apache-2.0
// The signed distance of a closed surface of triangles, from a grid of voxels. Openings and their continuations are
// surface_lumen.h's.
#pragma once

#include "patency/shape/signed_distance.h"
#include "patency/shape/surface.h"

namespace patency {

/// At the corners of voxels [m] it is the triangles' own, inside and up to `outside` [m] outside (ten voxels if that is 0).
/// Between the corners it is linear along each axis, so that the
/// value errs by less than voxel^2 / 8 times the sum of the curvatures of its level, THEORY.md (17.1); edges are cut by up to a quarter of a
/// voxel. The gradient is that of central differences over two voxels, interpolated and made a unit vector; the
/// curvature is its divergence, a mean over three voxels. Farther outside than `outside` the value is a lower bound and
/// the gradient some unit vector. The same bits for any number of threads; memory is 16 bytes per corner.
/// Throws GeometryError if the surface is not closed, is inside out, or has too many voxels.
SignedDistance make_surface_distance(const Surface& closed, double voxel, double outside = 0);

}   // namespace patency
