// SPDX-License-Identifier: Apache-2.0
// The surface of a stent's metal as elements that particles can carry.
#pragma once

#include "patency/bodies/solid_surface.h"
#include "patency/shape/stent_axis.h"
#include "patency/shape/stent_form.h"

namespace patency {

/// Faces of a stent: outer to the vessel, inner to the blood, side between them, cut along radii.
inline constexpr std::uint16_t stent_outer = 0, stent_inner = 1, stent_side = 2;

/// The closed surface of the metal, along the axis, at about this size of its elements [m]. Of a stent that came as a surface it is
/// meshed anew, which rounds edges by a part of that size.
SurfaceElements make_stent_skin(const StentForm& form, const StentAxis& axis, double size);

}   // namespace patency
