// SPDX-License-Identifier: Apache-2.0
// A body that is heavy against itself only: momentum is the forces', what moves as one keeps its mass, what the step is set by
// is slow, energy is kept.
#include "patency/schemes/selective_mass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/errors.h"
#include "tests/schemes/small_solids.h"

using namespace patency;
using namespace patency::testing_solids;

namespace {

constexpr double scaling = 16;

/// Of n particles, one in seven heavier than the others.
std::vector<double> scalings(std::size_t n) {
    std::vector<double> all(n, scaling);
    for (std::size_t i = 0; i < n; i += 7) all[i] = 2.5 * scaling;
    return all;
}

void fill_strut(Solid& solid) { fill(solid, block(24, 4, 4, 0.05), rubber(0.3), false); }

double power(const std::vector<Vec3>& momentum, const Field<Vec3>& velocity) {
    double sum = 0;
    for (std::size_t i = 0; i < momentum.size(); ++i) sum += dot(momentum[i], velocity[i]);
    return sum;
}

std::vector<Vec3> momenta(const SolidParticles& p, double k) {
    std::vector<Vec3> momentum;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 x = p.reference[i] / spacing;
        momentum.push_back(p.mass[i] *
                           Vec3{std::sin(k * x.x + x.y), std::cos(k * x.y - x.z), 0.3 + std::sin(k * x.z * x.x)});
    }
    return momentum;
}

/// Position Verlet from time, which goes on by dt.                                                    THEORY (20.11)
void step(SolidBody& body, double& time, double dt) {
    body.drift(0.5 * dt, time + 0.5 * dt);
    body.compute_force(time + 0.5 * dt);
    body.kick(dt, time);
    body.drift(0.5 * dt, time += dt);
}

}   // namespace

TEST(SelectiveMass, KeepsMomentumAndMovesAsOneWhatMovesAsOne) {
    Solid solid;
    fill_strut(solid);
    SolidParticles& p = solid.particles;
    const SelectiveMass mass(p, spacing, scalings(p.size()));
    const auto any = momenta(p, 1.7);
    mass.compute_velocity(any, p);
    Vec3 moved{}, pushed{};
    for (std::size_t i = 0; i < p.size(); ++i) moved += p.mass[i] * p.velocity[i], pushed += any[i];
    EXPECT_LT(norm(moved - pushed), 1e-13 * norm(pushed));

    std::vector<Vec3> as_one;
    for (const double m : p.mass) as_one.push_back(m * Vec3{1, -2, 3});
    mass.compute_velocity(as_one, p);
    for (const Vec3& v : p.velocity) EXPECT_LT(norm(v - Vec3{1, -2, 3}), 1e-13);
}

TEST(SelectiveMass, IsAMass) {   // symmetric, and no motion is without energy
    Solid solid;
    fill_strut(solid);
    SolidParticles& p = solid.particles;
    const SelectiveMass mass(p, spacing, scalings(p.size()));
    const auto one = momenta(p, 1.7), other = momenta(p, 0.4);
    mass.compute_velocity(one, p);
    const double forth = power(other, p.velocity);
    double alone = 0;
    const std::vector<double> heavier = scalings(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) alone += dot(one[i], one[i]) / (heavier[i] * p.mass[i]);
    EXPECT_GT(power(one, p.velocity), alone);
    mass.compute_velocity(other, p);
    EXPECT_NEAR(power(one, p.velocity), forth, 1e-12 * std::abs(forth));
}

TEST(SelectiveMass, ASwingingStrutIsHardlyHeavierAndAVibrationMuch) {
    Solid solid;
    fill(solid, block(36, 4, 4, 0), rubber(0.3), false);
    SolidParticles& p = solid.particles;
    const SelectiveMass mass(p, spacing, std::vector<double>(p.size(), scaling));
    const auto share = [&](const auto& shape) {   // of the velocity that the own mass would give, by its energy
        std::vector<Vec3> momentum;
        double own = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const double v = shape(p.reference[i] / spacing);
            momentum.push_back({0, p.mass[i] * v, 0});
            own += p.mass[i] * v * v;
        }
        mass.compute_velocity(momentum, p);
        return power(momentum, p.velocity) / own;
    };
    EXPECT_GT(share([](const Vec3& x) { return x.x - 17.5; }), 0.85);
    EXPECT_LT(share([](const Vec3& x) { return (int(std::lround(x.x)) + int(std::lround(x.y))) % 2 ? 1.0 : -1.0; }),
              1.1 / scaling);
}

TEST(SelectiveMass, ItsLongStepKeepsTheEnergy) {
    Solid solid, plain;
    fill_strut(solid), fill_strut(plain);
    SolidNumerics heavy = numerics(false);
    heavy.mass_scaling = scaling;
    const auto body = make_solid_body(solid, heavy);
    const double dt = body->stable_step();
    EXPECT_NEAR(dt, 4 * make_solid_body(plain, numerics(false))->stable_step(), 1e-12 * dt);
    SolidParticles& p = body->particles();
    shake(p, 0.02, false);
    double time = 0;
    const auto largest_energy_of = [&](int steps) {   // it swings about a constant
        double most = 0;
        for (int k = 0; k < steps; ++k) {
            step(*body, time, dt);
            const SolidEnergy e = body->energy();
            most = std::max(most, e.kinetic + e.elastic + e.hourglass);
        }
        return most;
    };
    const double early = largest_energy_of(400);
    largest_energy_of(1200);
    const double late = largest_energy_of(400);
    EXPECT_LT(late, 1.01 * early);
    EXPECT_GT(late, 0.8 * early);
    EXPECT_GT(body->energy().kinetic, 0.1 * early);
}

// Some particles in disorder vibrate faster than any of a lattice: they are heavier, the step is the same.
TEST(SelectiveMass, ParticlesInDisorderBearTheStepOfLayers) {
    SolidNumerics stent = numerics(false);
    stent.smoothing_ratio = 1, stent.second_order = true, stent.hourglass = 0.3, stent.mass_scaling = scaling;
    const auto growth = [&](double disorder, double& dt) {   // of the energy of a vibration, in 600 steps
        Solid solid;
        fill(solid, block(24, 4, 4, disorder), rubber(0.3), false);
        const auto body = make_solid_body(solid, stent);
        dt = body->stable_step();
        shake(body->particles(), 1e-4, false);
        const SolidEnergy first = body->energy();
        double most = 0, time = 0;
        for (int k = 0; k < 600; ++k) {
            step(*body, time, dt);
            const SolidEnergy e = body->energy();
            most = std::max(most, e.kinetic + e.elastic + e.hourglass);
        }
        return most / (first.elastic + first.hourglass);
    };
    // Verlet keeps |p|^2 / m + (1 - angle^2 / 4) k |u|^2 of a vibration that turns by an angle in a step, here by 1.5.
    const double swings = 1 / (1 - 1.5 * 1.5 / 4);
    double layers, disorder;
    EXPECT_LT(growth(0, layers), swings);
    EXPECT_LT(growth(0.4, disorder), swings);
    EXPECT_EQ(disorder, layers);
}

TEST(SelectiveMass, CannotBeHeld) {
    Solid solid;
    fill_strut(solid);
    solid.constraints.push_back({});
    SolidNumerics heavy = numerics(false);
    heavy.mass_scaling = scaling;
    EXPECT_THROW(make_solid_body(solid, heavy), DeckError);
}
