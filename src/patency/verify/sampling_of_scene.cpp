// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/sampling_of_scene.h"

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"

namespace patency {

StraightAxis axis_of(const Scene& scene) {
    auto axis = find_straight_axis(scene.config.geometry);
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

ProfileFit make_pipe_fit(const Scene& scene, const StraightAxis& axis) {
    const double dp = scene.numerics.spacing;
    return {0.25 * dp, 0.5 * dp, int(2 * axis.outline.front().radius / dp + 1e-6), 4};
}

void add_pipe_profile(const Scene& scene, const StraightAxis& axis, double weight, ProfileFit& fit) {
    for_each_near_middle(scene, axis, 0.25 * axis.length, [&](std::size_t i, double, double r) {
        fit.add(r, dot(scene.fluid.velocity[i], axis.direction), weight);
    });
}

double flow_through(const ProfileFit& fit, double radius) {
    const std::vector<double> u = fit.values();
    const auto& r = fit.stations();
    const auto square = [](double x) { return x * x; };
    const double slope = (u[1] - u[0]) / (square(r[1]) - square(r[0]));
    double integral = (u[0] - 0.5 * slope * square(r[0])) * square(r[0]);   // from the axis to the first station
    for (std::size_t k = 1; k < r.size(); ++k) integral += 0.5 * (u[k] + u[k - 1]) * (square(r[k]) - square(r[k - 1]));
    integral += 0.5 * u.back() * (square(radius) - square(r.back()));
    return std::numbers::pi * integral;
}

void put_number(RunData& data, const std::string& name, double value) { data.lists[name] = {value}; }

}   // namespace patency
