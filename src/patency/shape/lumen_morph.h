// SPDX-License-Identifier: Apache-2.0
// A lumen opened to a diameter along a stent, by geometry alone: no mechanics, no recoil. For a quick look.    THEORY (24.1)
#pragma once

#include "patency/shape/stent_axis.h"
#include "patency/shape/surface.h"

namespace patency {

struct LumenMorph {
    double radius;          ///< of the opened stent, outside [m]
    double length;          ///< of the opened stent [m]
    double shoulder;        ///< from its ends to the vessel as it was [m]
    double corner = 0.02;   ///< over the radius: how the opened lumen rounds into one that is wider already
};

/// Where a place goes: outwards from the axis, so that what is narrower than the radius comes to it. A one-to-one map of space outside of
/// the axis, so that a surface around it does not run through itself; far outside and past the shoulders nothing moves.
Vec3 morphed(const Vec3& x, const StentAxis& axis, const LumenMorph& morph);

/// All points of the surface; the axis' own continuation past the shoulders is not asked. Its triangles should be small against the radius.
void morph_surface(Surface& surface, const StentAxis& axis, const LumenMorph& morph);

}   // namespace patency
