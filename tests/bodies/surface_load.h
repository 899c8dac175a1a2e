// SPDX-License-Identifier: Apache-2.0
// What the forces on a surface's vertices do to the particles that carry it.
#pragma once

#include "patency/bodies/solid_surface.h"

namespace patency {

/// Particles' loads from the surface alone [N]; returns their sum.
inline Vec3 load_by(const SolidSurface& surface, SolidParticles& particles) {
    for (Vec3& f : particles.load) f = {};
    surface.push(particles);
    Vec3 sum{};
    for (const Vec3& f : particles.load) sum += f;
    return sum;
}

}   // namespace patency
