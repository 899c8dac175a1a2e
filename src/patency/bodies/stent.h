// SPDX-License-Identifier: Apache-2.0
// A stent of particles that fit its struts.
#pragma once

#include "patency/particles/particle_set.h"
#include "patency/shape/stent_form.h"
#include "patency/shape/stent_metal.h"

namespace patency {

struct StentParticles : ParticleSet {
    Field<Vec3> position{*this, "position", "m", Keep::state};
    Field<double> volume{*this, "volume", "m^3", Keep::state};
};

inline constexpr int least_across = 4;   ///< particles across a strut, in width and in thickness

/// The largest spacing [m] that puts four particles across every strut.
double largest_stent_spacing(const StentForm& form);

/// Relaxed on the unrolled tube, in whole layers from the wall's inner to its outer face, then rolled up and bent.
/// Volumes are those of the cut: larger towards the outer face and on the outer side of a bend; their sum is the metal's
/// (measure_stent). Throws GeometryError if the spacing [m] is too large.
void make_stent_particles(const StrutCurves& curves, const StentAxis& axis, double spacing, StentParticles& particles);

/// Relaxed in the straight metal of a surface, then bent: volumes are larger on the outer side of a bend, their sum is the metal's. Throws GeometryError if the spacing [m] is
/// too large.
void make_stent_particles(const ImportedStent& stent, const StentAxis& axis, double spacing, StentParticles& particles);

/// Particles of any metal of this volume [m^3], by relaxation in space.
void make_stent_particles(const SignedDistance& metal, double volume, double spacing, StentParticles& particles);

}   // namespace patency
