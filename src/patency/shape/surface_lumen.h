// SPDX-License-Identifier: Apache-2.0
// From a checked surface and its openings to a lumen: flat openings, and the vessel continued straight past them.
// Finds no openings (surface_openings.h) and makes no particles (sampling.h).
#pragma once

#include <span>

#include "patency/shape/lumen.h"
#include "patency/shape/surface_openings.h"

namespace patency {

struct SurfaceLumenSettings {
    double voxel;          ///< of the distance [m]; half a spacing errs by less than a twentieth of it
    double outside;        ///< how far outside the distance is exact [m]
    double extension;      ///< how far the distance goes on straight past an opening [m]
    double straight = 0;   ///< straight pieces put on the openings, in diameters of each; they belong to the lumen
};

/// The surface's triangles, from each opening's rim on a prism along its normal. A rim that is not flat is led on to the
/// plane through its outermost point, so that nothing of the vessel is cut away; the lumen grows by that. Volume and areas
/// are exact for the triangles. THEORY.md (17.2)
/// Throws GeometryError if an opening has no rim of its own or its continuation runs into the vessel.
Lumen make_surface_lumen(const CheckedSurface& checked, std::span<const SurfaceOpening> openings,
                         const SurfaceLumenSettings& settings);

}   // namespace patency
