// SPDX-License-Identifier: Apache-2.0
// For tests of what is read off a flow: particles strewn in a tube along a direction, with a parabola's velocity and a linear
// pressure.
#pragma once

#include <memory>
#include <optional>
#include <random>

#include "patency/analysis/sample.h"
#include "patency/shape/lumen.h"
#include "patency/shape/sampling.h"

namespace patency::testing_analysis {

struct PoiseuilleTube {
    double radius = 1.5e-3, length = 9e-3, spacing = 0.25e-3, mean_speed = 0.3, slope;   // m, m, m, m/s, Pa/m
    RigidMotion motion = motion_along({1, 2, -1}, {0.01, -0.02, 0.005});
    FluidParticles fluid;
    std::unique_ptr<Frame> frame;
    WallHint wall;

    /// The pressure that drives the parabola in blood of 3.5 mPa s, or what is told [Pa/m].
    explicit PoiseuilleTube(std::optional<double> told = {})
        : slope(told ? *told : -8 * 3.5e-3 * mean_speed / (radius * radius)) {
        const Lumen tube = make_tube({.length = length, .radius = radius});
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> any(-0.2 * spacing, 0.2 * spacing);
        std::vector<Vec3> points;
        for (Vec3 x : make_lattice(tube, spacing)) {
            x += Vec3{any(random), any(random), any(random)};
            if (tube.distance.value(x) < 0) points.push_back(x);
        }
        fluid.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            fluid.position[i] = motion.place(points[i]);
            fluid.velocity[i] = velocity(fluid.position[i]);
            fluid.pressure[i] = pressure(fluid.position[i]);
            fluid.volume[i] = spacing * spacing * spacing;
        }
        frame = std::make_unique<Frame>(Vec3{-0.05, -0.05, -0.05}, Vec3{0.05, 0.05, 0.05}, reach());
        wall.distance = [this](const Vec3& x) { return radial(x) - radius; };
        wall.normal = [this](const Vec3& x) {
            Vec3 r = motion.place_back(x);
            r.x = 0;
            return motion.turn(normalized(r));
        };
    }
    PoiseuilleTube(const PoiseuilleTube&) = delete;   // the hint holds its address

    double reach() const { return 2.6 * spacing; }
    double radial(const Vec3& x) const {
        const Vec3 r = motion.place_back(x);
        return std::hypot(r.y, r.z);
    }
    double axial(const Vec3& x) const { return motion.place_back(x).x; }
    Vec3 axis() const { return motion.turn({1, 0, 0}); }
    Vec3 velocity(const Vec3& x) const {
        const double share = radial(x) / radius;
        return 2 * mean_speed * (1 - share * share) * axis();
    }
    double pressure(const Vec3& x) const { return 900 + slope * axial(x); }
    double wall_stress(double viscosity) const { return 4 * viscosity * mean_speed / radius; }   // Pa
};

}   // namespace patency::testing_analysis
