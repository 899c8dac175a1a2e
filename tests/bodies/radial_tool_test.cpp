// SPDX-License-Identifier: Apache-2.0
// Balloon and crimper: the push is the slope of its energy, straight and bent, no farther than the tool is long; their work
// is what the solid and the contact have got.
#include "patency/bodies/radial_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/bodies/solid_shape.h"
#include "tests/bodies/surface_load.h"

using namespace patency;

namespace {

constexpr double spacing = 0.25e-3, step = 1e-7, length = 6e-3, within = 2e-3, without = 3e-3;

/// A tube along x, its middle at the origin.
struct Tube {
    Solid solid;
    std::unique_ptr<SolidSurface> surface;

    Tube() {
        const SolidFill fill = fill_cylinder({-length / 2, 0, 0}, {length / 2, 0, 0}, within, without, spacing, false);
        solid.materials = {{1000, NeoHookean{1, 1}}};
        place_particles(solid, fill.places, 0);
        for (std::size_t i = 0; i < solid.particles.size(); ++i)
            solid.particles.mass[i] = 1000 * (solid.particles.volume[i] = fill.volumes[i]);
        surface = std::make_unique<SolidSurface>(fill.surface, solid.particles, 2.3 * spacing, false);
        surface->follow(solid.particles);
    }
    Vec3 load() { return load_by(*surface, solid.particles); }
    /// Outward, through the particles' places across x.
    double radial_load() {
        load();
        double sum = 0;
        for (std::size_t i = 0; i < solid.particles.size(); ++i) {
            const Vec3& x = solid.particles.position[i];
            sum += dot(solid.particles.load[i], normalized(Vec3{0, x.y, x.z}));
        }
        return sum;
    }
};

RadialTool tool(RadialTool::Kind kind, double radius, double how_long = 10e-3) {
    return {.kind = kind, .axis = StentAxis(), .length = how_long, .radius = [radius](double) { return radius; }};
}

}   // namespace

// An artery comes back beside itself: half of the tube lies behind the plane that the line begins at.
TEST(RadialTool, TakesHoldOfATubeBehindABendOfHalfACircle) {
    Tube tube;
    std::vector<Vec3> line;
    for (double x = 1; x > -12; x -= 0.5) line.push_back(1e-3 * Vec3{x, 16, 0});
    for (int k = 0; k < 40; ++k)
        line.push_back(
            1e-3 * Vec3{-12 - 8 * std::sin(std::numbers::pi * k / 40), 8 + 8 * std::cos(std::numbers::pi * k / 40), 0});
    double arc = 0;   // of the origin
    for (double x = -12; x <= 12; x += 0.5) line.push_back(1e-3 * Vec3{x, 0, 0});
    for (std::size_t k = 1; k < line.size() && !(line[k].y == 0 && line[k].x > 1e-9); ++k)
        arc += norm(line[k] - line[k - 1]);
    RadialTool bent = tool(RadialTool::Kind::crimper, without - 0.02e-3);
    bent.axis = StentAxis(line, arc, 0, 10e-3, without);
    const auto crimper = make_tool_contact(*tube.surface, bent, {.friction = 0, .damping = 0, .step = step});
    const auto straight = make_tool_contact(*tube.surface, tool(RadialTool::Kind::crimper, without - 0.02e-3),
                                            {.friction = 0, .damping = 0, .step = step});
    crimper->add_forces(0, step), straight->add_forces(0, step);
    EXPECT_GT(straight->report().normal_force, 0);
    EXPECT_NEAR(crimper->report().normal_force, straight->report().normal_force,
                1e-6 * straight->report().normal_force);
}

TEST(RadialTool, ABalloonPushesOutAndACrimperIn) {
    Tube tube;
    const auto balloon = make_tool_contact(*tube.surface, tool(RadialTool::Kind::balloon, within + 0.02e-3),
                                           {.friction = 0, .damping = 0, .step = step});
    balloon->add_forces(0, step);
    const ContactReport out = balloon->report();
    EXPECT_NEAR(tube.radial_load(), out.normal_force, 0.03 * out.normal_force)
        << "carriers of a push lie beside it on a round wall";
    EXPECT_NEAR(out.deepest, 0.02e-3, 1e-3 * 0.02e-3);
    EXPECT_LT(norm(out.force), 1e-5 * out.normal_force)
        << "rings of particles are not quite as round as those of vertices";
    // Every vertex of the inner face is as deep, so the pressure is known.
    double stiffness = 0;
    for (std::size_t v = 0; v < tube.surface->size(); ++v) {
        const Vec3& x = tube.surface->position[v];
        if (std::hypot(x.y, x.z) < within + 0.01e-3) stiffness += 0.1 * tube.surface->mass(v) / (step * step);
    }
    EXPECT_NEAR(out.pressure, stiffness * 0.02e-3 / (2 * std::numbers::pi * (within + 0.02e-3) * length),
                0.01 * out.pressure);

    tube.surface->follow(tube.solid.particles);
    const auto crimper = make_tool_contact(*tube.surface, tool(RadialTool::Kind::crimper, without - 0.03e-3),
                                           {.friction = 0, .damping = 0, .step = step});
    crimper->add_forces(0, step);
    EXPECT_NEAR(tube.radial_load(), -crimper->report().normal_force, 0.03 * crimper->report().normal_force);
    EXPECT_NEAR(crimper->report().deepest, 0.03e-3, 1e-3 * 0.03e-3);
}

TEST(RadialTool, AShortBalloonPushesWithItsRoundEndsAndAShortCrimperOnlyWhereItIs) {
    Tube tube;
    const double half = 1e-3, radius = within + 0.1e-3, reach = half + std::sqrt(radius * radius - within * within);
    const auto balloon = make_tool_contact(*tube.surface, tool(RadialTool::Kind::balloon, radius, 2 * half),
                                           {.friction = 0, .damping = 0, .step = step});
    balloon->add_forces(0, step);
    double farthest = 0;
    for (const auto& p : balloon->pushes()) {
        const double x = tube.surface->position[p.vertex].x;
        farthest = std::max(farthest, std::abs(x));
        if (std::abs(x) > half + 1e-5) {
            EXPECT_GT(p.force.x * x, 0) << "the round end pushes aside";
        }
    }
    EXPECT_LT(farthest, reach + 1e-6);
    EXPECT_GT(farthest, reach - spacing);
    tube.surface->follow(tube.solid.particles);
    const auto crimper = make_tool_contact(*tube.surface, tool(RadialTool::Kind::crimper, 2.9e-3, 2 * half),
                                           {.friction = 0, .damping = 0, .step = step});
    crimper->add_forces(0, step);
    EXPECT_GT(crimper->report().touching, 0u);
    for (const auto& p : crimper->pushes()) EXPECT_LE(std::abs(tube.surface->position[p.vertex].x), half + 1e-9);
}

TEST(RadialTool, PushIsTheSlopeOfItsEnergyOnABentAxisToo) {
    Tube tube;
    std::vector<Vec3> line;
    for (int k = -1600; k <= 1600; ++k)
        line.push_back({15e-3 * std::sin(k * 0.5e-3), 15e-3 * (1 - std::cos(k * 0.5e-3)), 0});
    {
        const RadialTool bent{.kind = RadialTool::Kind::balloon,
                              .axis = StentAxis(line, 12e-3, 0, length, without),
                              .length = 12e-3,
                              .radius = [](double) { return within - 0.05e-3; }};
        const auto contact = make_tool_contact(*tube.surface, bent, {.friction = 0, .damping = 0, .step = step});
        const auto at = [&](double y) {
            for (std::size_t i = 0; i < tube.solid.particles.size(); ++i)
                tube.solid.particles.position[i] = tube.solid.particles.reference[i] + Vec3{0, y, 0};
            tube.surface->follow(tube.solid.particles);
            contact->add_forces(0, step);
            return contact->report().energy;
        };
        const double d = 1e-8, up = at(d), down = at(-d);
        at(0);
        const Vec3 load = tube.load();
        ASSERT_GT(contact->report().touching, 3u);
        EXPECT_NEAR(-(up - down) / (2 * d), load.y, 2e-3 * std::abs(load.y));
    }
}

TEST(RadialTool, ItsWorkIsWhatSolidAndContactGet) {
    // The tube goes out at a third of the balloon's speed: the spring, the damper and the tube share the work.
    Tube tube;
    const double speed = 10, dt = step, third = speed / 3;
    const RadialTool balloon{
        .kind = RadialTool::Kind::balloon, .axis = StentAxis(), .length = 10e-3, .radius = [=](double t) {
            return within + speed * t;
        }};
    const auto contact = make_tool_contact(*tube.surface, balloon, {.friction = 0.2, .damping = 0.3, .step = step});
    double to_tube = 0;
    for (int k = 1; k <= 100; ++k) {
        for (std::size_t i = 0; i < tube.solid.particles.size(); ++i) {
            const Vec3& X = tube.solid.particles.reference[i];
            const Vec3 v = third * normalized(Vec3{0, X.y, X.z}) + Vec3{8, 0, 0};   // and slides along
            tube.solid.particles.position[i] = X + (k * dt) * v;
            tube.solid.particles.velocity[i] = v;
        }
        tube.surface->follow(tube.solid.particles);
        contact->add_forces(k * dt, dt);
        for (std::size_t v = 0; v < tube.surface->size(); ++v)
            to_tube += dt * dot(tube.surface->force[v], tube.surface->velocity(v));
    }
    const ContactReport r = contact->report();
    EXPECT_GT(r.damping_loss, 0);
    EXPECT_GT(r.friction_loss, 0);
    EXPECT_NEAR(r.work, to_tube + r.energy + r.friction_loss + r.damping_loss, 0.02 * r.work);
}

TEST(RadialTool, RadiusGoesFasterAndFasterFromRestToRest) {
    const auto radius = ramped_radius({1, 2, 4}, {1e-3, 3e-3, 2e-3});
    EXPECT_EQ(radius(0), 1e-3);
    EXPECT_EQ(radius(2), 3e-3);
    EXPECT_EQ(radius(9), 2e-3);
    const auto speed = [&](double t) { return (radius(t + 1e-6) - radius(t - 1e-6)) / 2e-6; };
    for (const double t : {1.0, 2.0, 4.0}) EXPECT_LT(std::abs(speed(t)), 1e-4 * 2e-3);
    EXPECT_NEAR(speed(1.95 - 2e-6) / speed(1.05 + 2e-6), 3, 1e-3);
    EXPECT_NEAR(speed(1.5), 0.5 * (speed(1.1) + speed(1.9)), 1e-8);
    EXPECT_NEAR(speed(3) / speed(1.5), -0.25, 1e-6);   // half the way, in twice the time
    for (double t = 1; t < 2; t += 1e-3)
        EXPECT_LT(std::abs(speed(t + 1e-3) - speed(t)), 0.05 * 2e-3);   // no jump anywhere
}

TEST(RadialTool, GoesOnFromItsState) {
    Tube tube, twin;
    const auto make = [](Tube& t) {
        return make_tool_contact(*t.surface, tool(RadialTool::Kind::balloon, within + 0.02e-3),
                                 {.friction = 0.3, .damping = 0.1, .step = step});
    };
    for (Tube* t : {&tube, &twin})
        for (Vec3& v : t->solid.particles.velocity) v = {5, 1, 0};
    const auto contact = make(tube), resumed = make(twin);
    const auto go = [](Tube& t, Contact& c) { t.surface->follow(t.solid.particles), c.add_forces(0, step); };
    go(tube, *contact), go(tube, *contact);
    resumed->restore(contact->state());
    EXPECT_EQ(resumed->report().energy, contact->report().energy);
    EXPECT_EQ(resumed->report().touching, contact->report().touching);
    go(tube, *contact), go(twin, *resumed);
    EXPECT_EQ(resumed->state(), contact->state());
    EXPECT_EQ(twin.load(), tube.load());
    EXPECT_GT(contact->report().friction_loss + contact->report().energy, 0);
}
