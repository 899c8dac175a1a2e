// SPDX-License-Identifier: Apache-2.0
// A stent as a solid: particles in its struts, the metal, the surface that tools and the wall touch.
#pragma once

#include <memory>
#include <string>

#include "patency/schemes/solid_step.h"
#include "patency/shape/stent_axis.h"
#include "patency/shape/stent_form.h"

namespace patency {

/// How many times heavier a stent's particles are against their neighbours. Four times as long a step then bears it; struts
/// that swing weigh a twentieth more.                                                                 THEORY (20.17)
inline constexpr double stent_particle_mass_scaling = 16;
/// Smoothing length over spacing that resolves bending best with four particles across, in layers as the struts of a pattern hold them.
inline constexpr double stent_smoothing_ratio = 1.0;

/// The stent as it was made, along the axis, free of stress and at rest. numerics.spacing [m] must put four particles across
/// every strut (largest_stent_spacing); mass_scaling multiplies the material's density. Its surface has the faces outer,
/// inner and side (stent_skin.h). Throws GeometryError if that is too coarse.
std::unique_ptr<SolidPart> make_stent_part(const std::string& name, const StentForm& form, const StentAxis& axis,
                                           const SolidMaterial& material, const SolidNumerics& numerics,
                                           double mass_scaling = 1);

/// The means of a stent, or of any tube around the axis, as it is now.
struct StentShape {
    double outer_diameter = 0;                         ///< twice the mean distance of the outer face from the axis [m]
    double least_diameter = 0, largest_diameter = 0;   ///< of its vertices
    double length = 0;                                 ///< between its ends along the axis [m]
    double end_diameter = 0,
           middle_diameter = 0;   ///< means over the outer eighths and the middle quarter of its length [m]
};
StentShape measure_stent_shape(const SolidPart& stent, const StentAxis& axis);

}   // namespace patency
