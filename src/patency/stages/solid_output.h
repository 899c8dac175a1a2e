// SPDX-License-Identifier: Apache-2.0
// What users see of solids: fields at the particles, sums over the bodies.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "patency/io/vtp.h"
#include "patency/stages/solid_scene.h"

namespace patency {

/// A vertex per particle where it is now: displacement, velocity, von Mises stress, Cauchy stress, principal stretches (the
/// largest first), volume ratio, plastic strain.
PolyData solid_picture(SolidPart& part);

/// The scene's energies and contacts, and each solid's extent, largest values and energies.
nlohmann::ordered_json solid_summary(SolidScene& scene);

}   // namespace patency
