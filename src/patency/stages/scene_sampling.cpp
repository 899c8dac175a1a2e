// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/scene_sampling.h"

namespace patency {

double spacing_at(const Scene& scene, const Vec3& place) {
    return scene.spacing_at ? scene.spacing_at(place) : scene.numerics.spacing;
}

LocalLength sampling_reach(const Scene& scene) {
    return [&](const Vec3& place) { return 2 * scene.numerics.smoothing_ratio * spacing_at(scene, place); };
}

WallHint wall_hint(const Scene& scene) {
    const SignedDistance& distance = scene.lumen.distance;
    WallHint hint{.distance = [&](const Vec3& x) { return distance.value(x); },
                  .normal = [&](const Vec3& x) { return distance.gradient(x); },
                  .velocity = {}};
    const WallParticles& wall = scene.wall;
    for (std::size_t i = 0; i < wall.size(); ++i)
        if (wall.depth[i] < spacing_at(scene, wall.position[i]))
            hint.points.push_back(wall.position[i] - wall.depth[i] * wall.normal[i]);
    return hint;
}

WallFlow wall_flow(const Scene& scene, const WallPlaces& places, const WallHint& hint) {
    // Four parts or so to a place's side.
    if (scene.wall_parts)
        return flow_of_parts(*scene.wall_parts, places, [&](const Vec3& x) { return 2 * spacing_at(scene, x); });
    const double mu = scene.material.viscosity;
    const auto constant = [mu](double) { return mu; };
    return flow_at_wall(scene.fluid, *scene.frame, places, sampling_reach(scene), hint,
                        scene.material.viscosity_at ? scene.material.viscosity_at : constant,
                        scene.material.density * scene.numerics.body_force);
}

bool wall_sticks(const Scene& scene) {
    return scene.config.wall.slip == deck::Slip::no_slip && scene.config.wall.velocity.empty();
}

}   // namespace patency
