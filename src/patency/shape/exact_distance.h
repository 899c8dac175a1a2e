// SPDX-License-Identifier: Apache-2.0
// The exact signed distance of a closed surface, without a grid: for centrelines, whose thinnest place nobody knows
// beforehand. Particles sample a grid (surface_distance.h), which is quicker and has curvatures.
#pragma once

#include "patency/shape/signed_distance.h"
#include "patency/shape/surface.h"

namespace patency {

/// Value and gradient to round-off at any place, a few microseconds each; the curvature is left 0. The sign is that of
/// the mean normal of the triangles that meet at the nearest place, weighted by their angles there (Baerentzen & Aanaes
/// 2005); where the surface passes through itself, by rays (ray_parity.h). Throws GeometryError if it has an open edge.
SignedDistance make_exact_distance(Surface closed);

}   // namespace patency
