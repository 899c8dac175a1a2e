// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/scene_sampling.h"

namespace patency {

double sampling_reach(const Scene& scene) { return 2 * scene.numerics.smoothing_ratio * scene.numerics.spacing; }

WallHint wall_hint(const Scene& scene) {
    const SignedDistance& distance = scene.lumen.distance;
    return {.distance = [&](const Vec3& x) { return distance.value(x); },
            .normal = [&](const Vec3& x) { return distance.gradient(x); },
            .velocity = {}};
}

bool wall_sticks(const Scene& scene) {
    return scene.config.wall.slip == deck::Slip::no_slip && scene.config.wall.velocity.empty();
}

}   // namespace patency
