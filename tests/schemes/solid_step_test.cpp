// SPDX-License-Identifier: Apache-2.0
// Solids of different steps: what they do to each other is equal and opposite at every rate, energy stays, and one of a
// stride does what all at the small step do.
#include "patency/schemes/solid_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/bodies/solid_shape.h"

using namespace patency;

namespace {

constexpr double side = 4e-3;

std::unique_ptr<SolidPart> make_block(double from, double young, double spacing, double speed) {
    auto part = std::make_unique<SolidPart>();
    const SolidFill fill = fill_box({from, 0, 0}, {from + side, side, side}, spacing, false);
    part->solid.materials = {
        {1000, NeoHookean::from(elastic_moduli({.young = young, .poisson = 0.3, .shear = {}, .bulk = {}}))}};
    place_particles(part->solid, fill.places, fill.volumes.front());
    for (Vec3& v : part->solid.particles.velocity) v = {speed, 0, 0};
    SolidNumerics numerics;
    numerics.spacing = spacing;
    part->body = make_solid_body(part->solid, numerics);
    part->surface =
        std::make_unique<SolidSurface>(fill.surface, part->solid.particles, numerics.kernel().support(), false);
    return part;
}

/// A stiff block runs into a soft one that is off its middle.
SolidSystem make_blocks(double stiffness_ratio, double damping = 0, double friction = 0) {
    SolidSystem system;
    system.parts.push_back(make_block(0, 1e6, 1e-3, 0));
    system.parts.push_back(make_block(-side - 0.1e-3, 1e6 * stiffness_ratio, 0.5e-3, 2));
    SolidParticles& p = system.parts[1]->body->particles();
    for (Vec3& x : p.position) x += Vec3{0, 0.7e-3, 0.3e-3};
    system.contacts.push_back(
        make_surface_contact(*system.parts[0]->surface, *system.parts[1]->surface,
                             {.friction = friction, .damping = damping, .step = stable_step(system)}));
    return system;
}

struct Sums {
    Vec3 momentum, turn;
    double energy = 0, losses = 0;
};
Sums sums_of(SolidSystem& system) {
    Sums s;
    for (auto& part : system.parts) {
        const SolidEnergy e = part->body->energy();
        s.energy += e.kinetic + e.elastic + e.hourglass;
        const SolidParticles& p = part->body->particles();
        for (std::size_t i = 0; i < p.size(); ++i) {
            s.momentum += p.mass[i] * p.velocity[i];
            s.turn += p.mass[i] * cross(p.position[i], p.velocity[i]);
        }
    }
    const ContactReport r = system.contacts[0]->report();
    s.energy += r.energy, s.losses += r.friction_loss + r.damping_loss;
    return s;
}

}   // namespace

class Rates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(SolidStep, Rates, ::testing::Values(1.0, 30.0, 400.0));

TEST_P(Rates, MomentumIsKeptAndEnergyBounded) {
    SolidSystem system = make_blocks(GetParam());
    const double dt = choose_strides(system);
    EXPECT_EQ(system.parts[1]->stride, 1);
    EXPECT_EQ(system.parts[0]->stride, GetParam() < 2 ? 1 : 9);
    const Sums start = sums_of(system);
    double time = 0, touched = 0, most = start.energy;
    for (int k = 0; k < int(2e-3 / dt); ++k) {
        solid_step(system, time, dt), time += dt;
        touched = std::max(touched, double(system.contacts[0]->report().touching));
        const Sums now = sums_of(system);
        most = std::max(most, now.energy + now.losses);
    }
    const Sums end = sums_of(system);
    EXPECT_GT(touched, 3);
    EXPECT_LT(norm(end.momentum - start.momentum), 1e-13 * norm(start.momentum));
    const bool is_one_rate = GetParam() < 2;   // a held stress turns with contact within its stride, to second order
    EXPECT_LT(norm(end.turn - start.turn), (is_one_rate ? 1e-11 : 1e-3) * side * norm(start.momentum));
    EXPECT_LT(most, 1.03 * start.energy);
    EXPECT_NEAR(end.energy + end.losses, start.energy, (is_one_rate ? 0.001 : 0.03) * start.energy);
    EXPECT_GT(system.parts[0]->body->particles().velocity[0].x, 0.2) << "it was hit";
}

TEST(SolidStep, AStrideDoesWhatTheSmallStepDoes) {
    SolidSystem together = make_blocks(30, 0, 0.2), apart = make_blocks(30, 0, 0.2);
    const double dt = choose_strides(apart);
    for (int k = 0; k < int(1e-3 / dt); ++k) {
        solid_step(apart, k * dt, dt);
        for (int n = 0; n < 9; ++n) solid_step(together, k * dt + n * dt / 9, dt / 9);
    }
    const auto centre = [](const SolidSystem& s) {
        Vec3 sum{};
        for (const Vec3& x : s.parts[0]->body->particles().position) sum += x;
        return sum / double(s.parts[0]->body->particles().size());
    };
    const Vec3 way = centre(together) - Vec3{side / 2, side / 2, side / 2};
    EXPECT_GT(norm(way), 0.1e-3);
    EXPECT_LT(norm(centre(apart) - centre(together)), 0.01 * norm(way));
}

TEST(SolidStep, DampingTakesEnergyAndTellsHowMuch) {
    SolidSystem system = make_blocks(30, 0.5);
    const double dt = choose_strides(system);
    const Sums start = sums_of(system);
    for (int k = 0; k < int(2e-3 / dt); ++k) solid_step(system, k * dt, dt);
    const Sums end = sums_of(system);
    EXPECT_GT(system.contacts[0]->report().damping_loss, 0.005 * start.energy);
    EXPECT_NEAR(end.energy + end.losses, start.energy, 0.01 * start.energy);
}

/// A slender bar hangs from its top, and every step pushes neighbours apart and together by turns, as rounding does.
TEST(SolidStep, ABodyWhoseParticlesTrembleComesToRestAllTheSame) {
    constexpr double length = 72e-3, width = 3e-3, young = 1e6, density = 1000, pull = 100;
    const double sag = density * pull * length * length / (2 * young);
    const SolidFill fill = fill_box({0, 0, 0}, {length, width, width}, 1e-3, false);
    SolidSystem system;
    system.gravity = {pull, 0, 0};
    system.is_relaxed = true;
    auto part = std::make_unique<SolidPart>();
    part->solid.materials = {
        {density, NeoHookean::from(elastic_moduli({.young = young, .poisson = 0, .shear = {}, .bulk = {}}))}};
    place_particles(part->solid, fill.places, fill.volumes.front());
    part->solid.constraints.push_back({});
    for (std::size_t i = 0; i < fill.places.size(); ++i)
        if (fill.places[i].x < 1e-3) part->solid.particles.constraint[i] = 1;
    SolidNumerics numerics;
    numerics.spacing = 1e-3;
    part->body = make_solid_body(part->solid, numerics);
    SolidParticles& p = part->body->particles();
    system.parts.push_back(std::move(part));
    const double dt = choose_strides(system), quiver = 1e-4 * sag / dt;
    for (int k = 0; k < 1500; ++k) {
        for (std::size_t i = 0; i < p.size(); ++i)
            if (p.constraint[i] == 0)
                p.velocity[i] += (k % 2 == 0 ? 1 : -1) *
                                 (std::lround(p.reference[i].x / 1e-3 - 0.5) % 2 == 0 ? quiver : -quiver) *
                                 Vec3{1, 0, 0};
        solid_step(system, k * dt, dt);
    }
    double lowest = 0;
    for (std::size_t i = 0; i < p.size(); ++i) lowest = std::max(lowest, p.position[i].x - p.reference[i].x);
    EXPECT_NEAR(lowest, 0.98 * sag, 0.02 * sag);   // the first millimetre is held
}

/// A block that rode a hundred times as fast drifts, and swings with all the energy that it has of its own.
TEST(SolidStep, WhatSwingsAfterAFastRideComesToRest) {
    SolidSystem system;
    system.is_relaxed = true;
    system.parts.push_back(make_block(0, 1e6, 1e-3, 10));
    const double dt = choose_strides(system);
    solid_step(system, 0, dt);
    SolidParticles& p = system.parts[0]->body->particles();
    for (std::size_t i = 0; i < p.size(); ++i) p.velocity[i] = {0.1, 0.01 * (p.reference[i].y / side - 0.5), 0};
    const auto energy = [&] {
        const SolidEnergy e = system.parts[0]->body->energy();
        return e.kinetic + e.elastic + e.hourglass;
    };
    const double start = energy();
    for (int k = 1; k < 1000; ++k) solid_step(system, k * dt, dt);
    EXPECT_LT(energy(), 1e-4 * start);
}

TEST(SolidStep, WhatIsNoLongerRelaxedIsNoLongerSlowedDown) {
    SolidSystem system = make_blocks(30);
    system.is_relaxed = true;
    const double dt = choose_strides(system);
    int k = 0;
    const auto drag_after = [&](int steps) {
        for (const int end = k + steps; k < end; ++k) solid_step(system, k * dt, dt);
        return system.parts[1]->body->energy().drag;
    };
    const double relaxed = drag_after(40);
    EXPECT_GT(relaxed, 0);
    system.is_relaxed = false;
    EXPECT_EQ(drag_after(40), relaxed);
}
