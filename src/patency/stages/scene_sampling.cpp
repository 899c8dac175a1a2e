// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/scene_sampling.h"

namespace patency {

double sampling_reach(const Scene& scene) { return 2 * scene.numerics.smoothing_ratio * scene.numerics.spacing; }

WallHint wall_hint(const Scene& scene) {
    const SignedDistance& distance = scene.lumen.distance;
    WallHint hint{.distance = [&](const Vec3& x) { return distance.value(x); },
                  .normal = [&](const Vec3& x) { return distance.gradient(x); },
                  .velocity = {}};
    const WallParticles& wall = scene.wall;
    for (std::size_t i = 0; i < wall.size(); ++i)
        if (wall.depth[i] < scene.numerics.spacing) hint.points.push_back(wall.position[i] - wall.depth[i] * wall.normal[i]);
    return hint;
}

bool wall_sticks(const Scene& scene) {
    return scene.config.wall.slip == deck::Slip::no_slip && scene.config.wall.velocity.empty();
}

}   // namespace patency
