// SPDX-License-Identifier: Apache-2.0
// How a scene's blood is sampled between its particles: how far, and where its wall is.
#pragma once

#include "patency/analysis/sample.h"
#include "patency/analysis/wall_shear.h"
#include "patency/stages/scene.h"

namespace patency {

/// Of a scene's particles at a place [m].
double spacing_at(const Scene& scene, const Vec3& place);

/// Particles within this far of a place take part in its fit: the kernel's support there. The scene must stay.
LocalLength sampling_reach(const Scene& scene);

/// Distance and normal of the scene's wall, which must outlive the hint, and the feet of its first layer of particles. The wall is at
/// rest.
WallHint wall_hint(const Scene& scene);

/// At places of the wall: what the scheme says itself, or what is fitted to its particles.
WallFlow wall_flow(const Scene& scene, const WallPlaces& places, const WallHint& hint);

/// Whether the wall holds the blood that touches it, so that samples near it may count on its rest.
bool wall_sticks(const Scene& scene);

}   // namespace patency
