// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/sampling_of_scene.h"

#include <cmath>

#include "patency/base/errors.h"

namespace patency {

StraightAxis axis_of(const Scene& scene) {
    auto axis = find_straight_axis(*scene.config.geometry.shape);
    if (!axis) throw GeometryError("the verification case needs a shape with one straight axis");
    return *axis;
}

void run_until(Scene& scene, const RunContext& context, double until,
               const std::function<void(const Scene&, double)>& observe) {
    advance(scene, {.until = until, .observe = [&](const Scene& now, const FlowStep& step) {
                        if (context.watch) context.watch(now);
                        if (observe) observe(now, step.dt);
                    }});
}

double mean_velocity_in_middle(const Scene& scene, const StraightAxis& axis) {
    double sum = 0, count = 0;
    for_each_near_middle(scene, axis, 0.25 * axis.length, [&](std::size_t i, double, double) {
        sum += dot(scene.fluid.velocity[i], axis.direction);
        count += 1;
    });
    return sum / count;
}

double pressure_gradient_in_middle(const Scene& scene, const StraightAxis& axis) {
    double n = 0, x = 0, xx = 0, p = 0, xp = 0;
    for_each_near_middle(scene, axis, 0.25 * axis.length, [&](std::size_t i, double along, double) {
        const double value = scene.fluid.pressure[i];
        n += 1, x += along, xx += along * along, p += value, xp += along * value;
    });
    return -(n * xp - x * p) / (n * xx - x * x);
}

ProfileFit make_plane_fit(const Scene& scene) {
    const double gap = scene.config.geometry.shape->gap;
    const int count = int(std::lround(gap / scene.numerics.spacing));
    return {0.5 * gap / count, gap / count, count};
}

void add_plane_profile(const Scene& scene, double columns, double weight, ProfileFit& fit) {
    for_each_near_middle(scene, axis_of(scene), columns * scene.numerics.spacing, [&](std::size_t i, double, double) {
        fit.add(scene.fluid.position[i].y, scene.fluid.velocity[i].x, weight);
    });
}

void put_number(RunData& data, const std::string& name, double value) { data.lists[name] = {value}; }

}  // namespace patency
