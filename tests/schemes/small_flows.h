// SPDX-License-Identifier: Apache-2.0
// For tests of the flow scheme: small domains made by hand. Not for the program, which fits points to any lumen.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "patency/schemes/flow_scheme.h"
#include "patency/search/cells.h"

namespace patency::testing_flows {

inline constexpr double dp = 1e-4;   // m: 10 across a millimetre

/// Everything a scheme works on, with blood at rest in it.
struct SmallFlow {
    FluidParticles fluid;
    WallParticles wall;
    std::vector<OpenEnd> ends;
    std::unique_ptr<Frame> frame;
    FluidMaterial blood{.density = 1060, .viscosity = 3.5e-3, .sound_speed = 2, .viscosity_at = {}};
    FlowNumerics numerics;
    std::function<double(const Vec3&)> distance = [](const Vec3&) { return -1.0; };

    SmallFlow() { numerics.spacing = dp, numerics.reference_speed = 0.2; }
    double support() const { return 2 * numerics.smoothing_ratio * dp; }
    double cell() const { return numerics.planar ? dp * dp : dp * dp * dp; }
    std::unique_ptr<FlowScheme> make(Precision precision) {
        return make_flow_scheme(precision, {fluid, wall, ends, *frame, distance}, blood, numerics);
    }
    void fill(std::span<const Vec3> points) {
        fluid.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            fluid.position[i] = points[i];
            fluid.volume[i] = cell();
            fluid.viscosity[i] = blood.viscosity;
        }
    }
    void disturb(double spacings, unsigned seed) {   // every particle by up to this along each axis
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> any(-spacings * dp, spacings * dp);
        for (Vec3& x : fluid.position) {
            x.x += any(random), x.y += any(random);
            if (!numerics.planar) x.z += any(random);
        }
    }
};

/// A block of across^2 or across^3 particles around the origin, with nothing around it.
inline void make_block(SmallFlow& flow, int across, bool planar) {
    flow.numerics.planar = planar;
    std::vector<Vec3> points;
    const auto at = [&](int i) { return (i + 0.5 - 0.5 * across) * dp; };
    for (int k = 0; k < (planar ? 1 : across); ++k)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i) points.push_back({at(i), at(j), planar ? 0 : at(k)});
    flow.fill(points);
    const double half = 0.5 * across * dp + 4 * dp;
    flow.frame = std::make_unique<Frame>(Vec3{-half, -half, -half}, Vec3{half, half, half}, flow.support());
}

/// The same block, periodic all around.
inline void make_periodic_block(SmallFlow& flow, int across, bool planar) {
    make_block(flow, across, planar);
    const double half = 0.5 * across * dp;
    flow.frame = std::make_unique<Frame>(Vec3{-half, -half, planar ? -dp : -half}, Vec3{half, half, planar ? dp : half},
                                         flow.support(), std::array<bool, 3>{true, true, !planar});
}

inline OpenEnd make_end(double x, double normal, OpenEnd::Kind kind, double area, double reach) {
    OpenEnd end;
    end.name = normal < 0 ? "inlet" : "outlet";
    end.kind = kind;
    end.centre = {x, 0, 0}, end.normal = {normal, 0, 0};
    end.area = area, end.reach = reach, end.buffer_length = 4 * dp;
    return end;
}

/// Blood between plates at y = 0 and y = across dp (planar), or in a square duct of that side (y, z from 0), `along`
/// spacings long, with an inlet at x = 0 and an outlet. Walls stand still; velocity ends impose what the particles have.
inline void make_channel(SmallFlow& flow, int along, int across, bool planar, OpenEnd::Kind inlet,
                         OpenEnd::Kind outlet) {
    flow.numerics.planar = planar;
    const double gap = across * dp, length = along * dp;
    const int beyond = 4, behind = 3;   // layers past an end, and of the wall
    std::vector<Vec3> blood;
    struct Brick {
        Vec3 x, normal;
        double depth;
    };
    std::vector<Brick> bricks;
    // Beyond the nearer of the plates, and which side it is on.
    const auto over = [gap](double y) { return std::max(-y, y - gap); };
    const auto side = [gap](double y) { return y < gap / 2 ? -1.0 : 1.0; };
    flow.distance = [=](const Vec3& x) { return planar ? over(x.y) : std::max(over(x.y), over(x.z)); };   // of blood
    for (int k = planar ? 0 : -behind; k < (planar ? 1 : across + behind); ++k)
        for (int j = -behind; j < across + behind; ++j)
            for (int i = -beyond - 7; i < along + beyond + 7; ++i) {
                const Vec3 x{(i + 0.5) * dp, (j + 0.5) * dp, planar ? 0 : (k + 0.5) * dp};
                if (flow.distance(x) < 0) {
                    if (i >= -beyond && i < along + beyond) blood.push_back(x);
                    continue;
                }
                const Vec3 away{0, side(x.y) * std::max(over(x.y), 0.0),
                                planar ? 0 : side(x.z) * std::max(over(x.z), 0.0)};
                bricks.push_back({x, normalized(away), norm(away)});
            }
    flow.fill(blood);
    for (std::size_t i = 0; i < blood.size(); ++i)
        flow.fluid.opening[i] = blood[i].x < 0 ? 1 : blood[i].x > length ? 2 : 0;
    flow.wall.resize(bricks.size());
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        flow.wall.position[i] = bricks[i].x, flow.wall.normal[i] = bricks[i].normal,
        flow.wall.depth[i] = bricks[i].depth;
        flow.wall.volume[i] = flow.cell();
    }
    const double area = planar ? gap : gap * gap;
    flow.ends = {make_end(0, -1, inlet, area, 2 * gap), make_end(length, 1, outlet, area, 2 * gap)};
    for (OpenEnd& end : flow.ends) end.centre.y = gap / 2, end.centre.z = planar ? 0 : gap / 2;
    const double past = 14 * dp, around = 5 * dp;
    flow.frame = std::make_unique<Frame>(Vec3{-past, -around, -around}, Vec3{length + past, gap + around, gap + around},
                                         flow.support());
}

}   // namespace patency::testing_flows
