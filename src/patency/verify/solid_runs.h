// SPDX-License-Identifier: Apache-2.0
// What the verification cases of solids share: stepping a scene while looking at it.
#pragma once

#include <functional>

#include "patency/stages/solid_scene.h"
#include "patency/verify/run_data.h"

namespace patency {

using Stop = std::function<bool()>;

/// Steps to `until`, looking after every step.
template <class Look>
void run_to(SolidScene& scene, double until, const Stop& interrupted, const Look& look) {
    while (scene.time < until && !(interrupted && interrupted())) {
        step_solids(scene, until);
        look();
    }
}

inline void note_size(const SolidScene& scene, RunData& data) {
    data.particles = std::int64_t(scene.particle_count());
    data.acoustic_steps = scene.steps;
    data.particle_steps = double(data.particles) * double(scene.steps);
}

}   // namespace patency
