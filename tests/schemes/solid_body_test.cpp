// SPDX-License-Identifier: Apache-2.0
// A solid body: its force is the slope of its energy, both momenta are kept, a linear deformation is seen exactly, and the
// answer does not depend on the loop, the lanes or the threads.
#include "patency/schemes/solid_body.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "tests/schemes/small_solids.h"

using namespace patency;
using namespace patency::testing_solids;

namespace {

/// Takes the positions as they are and computes everything of them.
void look(SolidBody& body) {
    body.drift(0, 0);
    body.compute_force(0);
}

double largest(const Field<Vec3>& field) {
    double most = 0;
    for (const Vec3& f : field) most = std::max(most, norm(f));
    return most;
}

struct Kind {
    bool planar, second_order;
};
class Both : public ::testing::TestWithParam<Kind> {   // planar, and in space, with F of both orders
protected:
    static SolidNumerics numbers(Precision precision = Precision::double_precision) {
        SolidNumerics n = numerics(GetParam().planar, precision);
        n.second_order = GetParam().second_order;
        return n;
    }
};
INSTANTIATE_TEST_SUITE_P(SolidBody, Both,
                         ::testing::Values(Kind{true, false}, Kind{false, false}, Kind{true, true}, Kind{false, true}),
                         [](const auto& kind) {
                             return std::string(kind.param.planar ? "plane" : "space") +
                                    (kind.param.second_order ? "_second" : "_first");
                         });

}   // namespace

TEST_P(Both, ForceIsTheSlopeOfTheEnergy) {
    const bool planar = GetParam().planar;
    Solid solid;
    fill(solid, block(7, 6, planar ? 0 : 5, 0.15), rubber(), planar);
    const auto body = make_solid_body(solid, numbers());
    SolidParticles& p = body->particles();
    shake(p, 0.05, planar);
    look(*body);
    std::vector<Vec3> force(p.force.begin(), p.force.end());
    const double scale = largest(p.force), step = 1e-5 * spacing;
    for (const std::size_t i : {std::size_t(0), p.size() / 3, p.size() / 2, p.size() - 1}) {
        const auto energy_at = [&](double by) {
            const Vec3 kept = p.position[i];
            p.position[i].y += by;
            look(*body);
            const SolidEnergy e = body->energy();
            p.position[i] = kept;
            return e.elastic + e.hourglass;
        };
        EXPECT_NEAR(-(energy_at(step) - energy_at(-step)) / (2 * step), force[i].y, 1e-6 * scale);
    }
}

TEST_P(Both, OnlyTheHourglassControlSeesACheckerboard) {
    const bool planar = GetParam().planar;
    const double a = 1e-3 * spacing;
    for (const double stiffness : {0.0, 0.2}) {
        Solid solid;
        fill(solid, block(17, 17, planar ? 0 : 17, 0), rubber(), planar);
        SolidNumerics n = numbers();
        n.hourglass = stiffness;
        const auto body = make_solid_body(solid, n);
        SolidParticles& p = body->particles();
        std::size_t middle = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 q = p.reference[i] / spacing;
            p.position[i].x += std::lround(q.x + q.y + q.z) % 2 == 0 ? a : -a;
            if (norm(q - Vec3{8, 8, planar ? 0.0 : 8.0}) < 0.5) middle = i;
        }
        look(*body);
        const double omega2 = -p.force[middle].x / (p.mass[middle] * (p.position[middle].x - p.reference[middle].x));
        const double shear_speed2 = rubber().moduli().shear / 1000;
        // Far from the faces the gradient is blind, and the control alone answers: 2 c sum w (u_i - u_j), THEORY (20.8).
        double odd = 0, second = 0;
        for (int x = -2; x <= 2; ++x)
            for (int y = -2; y <= 2; ++y)
                for (int z = planar ? 0 : -2; z <= (planar ? 0 : 2); ++z) {
                    const double r2 = x * x + y * y + z * z, t = std::max(0.0, 1 - std::sqrt(r2) / 2.3);
                    second += t * t * t * r2 / (planar ? 2 : 3);
                    if ((x + y + z) % 2 != 0) odd += t * t * t;
                }
        EXPECT_NEAR(omega2 * spacing * spacing / shear_speed2, stiffness * 4 * odd / second, 1e-9);
    }
}

TEST_P(Both, AnyMotionKeepsBothMomenta) {
    const bool planar = GetParam().planar;
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
        Solid solid;
        fill(solid, block(8, 7, planar ? 0 : 6, 0.2), rubber(), planar);
        SolidNumerics n = numbers(precision);
        n.viscosity = 0.1;
        const auto body = make_solid_body(solid, n);
        SolidParticles& p = body->particles();
        shake(p, 0.05, planar);
        for (std::size_t i = 0; i < p.size(); ++i)
            p.velocity[i] = Vec3{p.position[i].y, -p.position[i].x, 0} * 100 + Vec3{std::sin(double(i)), 0, 0};
        look(*body);
        double size = 0;
        Vec3 torque{};
        for (std::size_t i = 0; i < p.size(); ++i) {
            size += norm(p.force[i]);
            torque += cross(p.position[i], p.force[i]);
        }
        const double tolerance = precision == Precision::mixed ? 1e-6 : 1e-14;
        EXPECT_LT(norm(total(p.force)), tolerance * size);
        EXPECT_LT(norm(torque), tolerance * size * 8 * spacing);
    }
}

TEST_P(Both, ALinearDeformationIsSeenExactlyOffTheLattice) {
    const bool planar = GetParam().planar;
    const Mat3 F = planar ? Mat3{{1.3, 0.2, 0}, {-0.1, 0.8, 0}, {0, 0, 1}}
                          : Mat3{{1.3, 0.2, 0.1}, {-0.1, 0.8, 0.05}, {0.3, 0, 1.1}};
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
        Solid solid;
        fill(solid, block(7, 7, planar ? 0 : 7, 0.25), rubber(), planar);
        const auto body = make_solid_body(solid, numbers(precision));
        SolidParticles& p = body->particles();
        for (std::size_t i = 0; i < p.size(); ++i) p.position[i] = F * p.reference[i] + Vec3{1, 2, planar ? 0.0 : 3.0};
        look(*body);
        const double tolerance =
            precision == Precision::mixed ? 2e-4 : 1e-11;   // 1000 spacings away: quanta of 1e-6 spacings
        double hourglass = body->energy().hourglass, elastic = body->energy().elastic;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Mat3 off = body->deformation(i) - F;
            EXPECT_LT(std::sqrt(double_dot(off, off)), tolerance);
        }
        EXPECT_LT(std::abs(hourglass), tolerance * elastic);
    }
}

TEST(SolidBody, FOfSecondOrderIsRightAtASurfaceToo) {
    // A bent plate of four particles, off its lattice: of what the fit misses at the faces, where neighbours stand on one side, a
    // fifth is left.
    std::array<double, 2> worst{};
    for (const bool second : {false, true}) {
        Solid solid;
        fill(solid, block(12, 4, 12, 0.1), rubber(), false);
        SolidNumerics n = numerics(false);
        n.second_order = second;
        const auto body = make_solid_body(solid, n);
        SolidParticles& p = body->particles();
        const double bend = 0.01 / spacing, middle = 1.5 * spacing;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3& X = p.reference[i];
            p.position[i] = X + bend * Vec3{X.x * (X.y - middle), -0.5 * X.x * X.x, 0};
        }
        look(*body);
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3& X = p.reference[i];
            const Vec3 q = X / spacing;
            if (q.x < 2.5 || q.x > 8.5 || q.z < 2.5 || q.z > 8.5) continue;
            worst[second] = std::max(worst[second],
                                     std::abs(body->deformation(i).x.x - 1 - bend * (X.y - middle)) / (bend * spacing));
        }
    }
    EXPECT_GT(worst[0], 0.1);
    EXPECT_LT(worst[1], 0.25 * worst[0]);
}

/// The bending stiffness of a bar of n particles across over that of a beam, from the energy of its pure bending; of the middle of a
/// long bar, which is a longer one's without a shorter one's.
double bending_stiffness(int n, double disorder, const SolidNumerics& numbers) {
    constexpr double young = 1e6, poisson = 0.3, bend = 1e-5 / spacing;
    constexpr int length = 24;
    std::array<double, 2> energy{};
    for (const int longer : {0, 1}) {
        Solid solid;
        fill(solid, block(length * (1 + longer), n, n, disorder), rubber(poisson), false);
        const auto body = make_solid_body(solid, numbers);
        SolidParticles& p = body->particles();
        const Vec3 middle = 0.5 * spacing * Vec3{length * (1.0 + longer) - 1, n - 1.0, n - 1.0};
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 X = p.reference[i] - middle;
            p.position[i] +=
                bend * Vec3{X.x * X.y, -0.5 * (X.x * X.x + poisson * (X.y * X.y - X.z * X.z)), -poisson * X.y * X.z};
        }
        look(*body);
        const SolidEnergy e = body->energy();
        energy[std::size_t(longer)] = e.elastic + e.hourglass;
    }
    return (energy[1] - energy[0]) / (0.5 * young * bend * bend * length * spacing * std::pow(n * spacing, 4) / 12);
}

TEST(SolidBody, AStrutOfFourBendsAsStifflyAsItShould) {   // with the numbers of a stent
    SolidNumerics n = numerics(false);
    n.smoothing_ratio = 1, n.hourglass = 0;
    EXPECT_LT(bending_stiffness(4, 0, n), 0.82);   // of first order
    n.second_order = true;
    EXPECT_NEAR(bending_stiffness(4, 0, n), 15.0 / 16, 0.01);   // the middles of four layers
    n.hourglass = 0.3;
    EXPECT_NEAR(bending_stiffness(4, 0, n), 1, 0.02);
    EXPECT_NEAR(bending_stiffness(4, 0.1, n), 1, 0.02);
    EXPECT_NEAR(bending_stiffness(8, 0.1, n), 1, 0.01);
}

TEST(SolidBody, LoopsThreadsAndLanesGiveTheSameBits) {
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
        std::vector<std::vector<Vec3>> ends;
        for (const auto& [loop, threads] :
             {std::pair{LoopKind::packed, 1}, std::pair{LoopKind::packed, 3}, std::pair{LoopKind::reference, 2}}) {
            omp_set_num_threads(threads);
            Solid solid;
            fill(solid, block(20, 12, 11, 0.1), rubber(), false);
            SolidNumerics n = numerics(false, precision);
            n.viscosity = 0.1;
            n.second_order = precision == Precision::mixed;
            n.loop = loop;
            const auto body = make_solid_body(solid, n);
            shake(body->particles(), 0.03, false);
            const double dt = body->stable_step();
            for (int k = 0; k < 4; ++k) {
                body->drift(0.5 * dt, 0);
                body->compute_force(0);
                body->kick(dt, 0);
                body->drift(0.5 * dt, 0);
            }
            ends.emplace_back(body->particles().position.begin(), body->particles().position.end());
        }
        EXPECT_EQ(ends[0], ends[1]);
        EXPECT_EQ(ends[0], ends[2]);
    }
    omp_set_num_threads(1);
}

// Particles of a tube's layers have different volumes; what they do to each other adds up to nothing all the same.
TEST(SolidBody, ForcesOfUnequalVolumesAddUpToNothing) {
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
        Solid solid;
        const std::vector<Vec3> places = block(8, 7, 6, 0.1);
        fill(solid, places, rubber(), false);
        for (std::size_t i = 0; i < places.size(); ++i) solid.particles.volume[i] *= 1 + 0.1 * double(i % 4);
        const auto body = make_solid_body(solid, numerics(false, precision));
        SolidParticles& p = body->particles();
        for (std::size_t i = 0; i < p.size(); ++i)
            EXPECT_LT(norm(p.position[i] - p.reference[i]), 1e-12 * spacing)
                << "places moved, and what they rest from did not";
        shake(p, 0.03, false);
        look(*body);
        double size = 0;
        for (const Vec3& f : p.force) size += norm(f);
        EXPECT_LT(norm(total(p.force)), (precision == Precision::mixed ? 1e-6 : 1e-13) * size);
    }
}

TEST(SolidBody, MixedPrecisionFollowsDouble) {
    std::vector<std::vector<Vec3>> forces;
    double scale = 0;
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
        Solid solid;
        fill(solid, block(12, 10, 9, 0.1), rubber(), false);
        const auto body = make_solid_body(solid, numerics(false, precision));
        SolidParticles& p = body->particles();
        shake(p, 0.03, false);
        look(*body);
        scale = largest(p.force);
        std::vector<std::pair<Vec3, Vec3>> by_place;   // the orders differ in the last digit of places
        forces.emplace_back(p.force.begin(), p.force.end());
    }
    for (std::size_t i = 0; i < forces[0].size(); ++i) EXPECT_LT(norm(forces[0][i] - forces[1][i]), 2e-5 * scale);
}

TEST(SolidBody, ViscosityTakesEnergyButNothingFromARotation) {
    Solid solid;
    fill(solid, block(8, 8, 8, 0.1), rubber(), false);
    SolidNumerics n = numerics(false);
    n.viscosity = 0.2;
    const auto body = make_solid_body(solid, n);
    SolidParticles& p = body->particles();
    const Vec3 spin{30, -20, 10};
    for (std::size_t i = 0; i < p.size(); ++i) p.velocity[i] = cross(spin, p.position[i]);
    look(*body);
    const double turning = largest(p.force);
    double power = 0;
    for (std::size_t i = 0; i < p.size(); ++i) p.velocity[i] = Vec3{std::sin(900 * p.position[i].y), 0, 0};
    look(*body);
    for (std::size_t i = 0; i < p.size(); ++i) power += dot(p.force[i], p.velocity[i]);
    EXPECT_LT(power, 0);
    EXPECT_LT(turning, 1e-12 * largest(p.force));
}

TEST(SolidBody, TheStepIsStableWithRoomToSpare) {
    // The stiffest mode by power iteration on the force of small displacements.
    for (const auto& [poisson, second_order] : {std::pair(0.3, false), {0.49, false}, {0.3, true}, {0.49, true}}) {
        Solid solid;
        fill(solid, block(9, 9, 9, 0.1), rubber(poisson), false);
        SolidNumerics n = numerics(false);
        n.second_order = second_order;
        const auto body = make_solid_body(solid, n);
        SolidParticles& p = body->particles();
        shake(p, 1e-6, false);
        double omega2 = 0;
        for (int k = 0; k < 60; ++k) {
            look(*body);
            double f2 = 0, uf = 0;
            for (std::size_t i = 0; i < p.size(); ++i) {
                f2 += dot(p.force[i], p.force[i]);
                uf -= dot(p.force[i], p.position[i] - p.reference[i]) * p.mass[i];
            }
            omega2 = f2 / uf;
            const double shrink = 1e-6 * spacing / std::sqrt(f2 / double(p.size()));
            for (std::size_t i = 0; i < p.size(); ++i) p.position[i] = p.reference[i] + shrink * p.force[i];
        }
        const double limit = 2 / std::sqrt(omega2), step = body->stable_step();
        RecordProperty("limit_over_step", std::to_string(limit / step));
        EXPECT_GT(limit, (second_order ? 1.05 : 1.3) * step) << poisson << (second_order ? ", second order" : "");
        EXPECT_LT(limit, 4 * step) << poisson << (second_order ? ", second order" : "");
    }
}

TEST(SolidBody, TooThinIsASentence) {
    Solid solid;
    fill(solid, block(9, 9, 1, 0), rubber(), false);
    EXPECT_THROW(make_solid_body(solid, numerics(false)), GeometryError);
    Solid line;
    fill(line, block(9, 1, 0, 0), rubber(), true);
    EXPECT_THROW(make_solid_body(line, numerics(true)), GeometryError);
}

TEST(SolidBody, AParticleInsideOutStopsWithItsPlaceAndTime) {
    Solid solid;
    fill(solid, block(6, 6, 6, 0), rubber(), false);
    const auto body = make_solid_body(solid, numerics(false));
    SolidParticles& p = body->particles();
    for (std::size_t i = 0; i < p.size(); ++i) p.position[i].x *= -1;
    body->drift(0, 0);
    try {
        body->compute_force(0.125);
        FAIL() << "a mirrored body was accepted";
    } catch (const DivergedError& error) {
        EXPECT_NE(std::string(error.what()).find("t = 0.125 s"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("det F = -1"), std::string::npos) << error.what();
    }
}

TEST(SolidBody, AConstraintHoldsItsAxesAndCountsItsReaction) {
    Solid solid;
    fill(solid, block(6, 5, 5, 0), rubber(), false);
    solid.constraints = {{{true, false, true}, [](const Vec3&, double t) { return Vec3{100 * t * t, 7, 0}; }}};
    for (std::size_t i = 0; i < solid.particles.size(); ++i)
        if (solid.particles.reference[i].x < 0.5 * spacing) solid.particles.constraint[i] = 1;
    const auto body = make_solid_body(solid, numerics(false));
    SolidParticles& p = body->particles();
    const double dt = body->stable_step();
    double time = 0;
    const auto momentum = [&] {
        Vec3 sum{};
        for (std::size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * p.velocity[i];
        return sum;
    };
    for (int k = 0; k < 50; ++k) {
        body->drift(0.5 * dt, time + 0.5 * dt);
        body->compute_force(time + 0.5 * dt);
        body->kick(dt, time);
        body->drift(0.5 * dt, time + dt);
        time += dt;
    }
    for (std::size_t i = 0; i < p.size(); ++i)
        EXPECT_NEAR(p.position[i].x - p.reference[i].x, p.constraint[i] ? 100 * time * time : 0,
                    p.constraint[i] ? 1e-15 : 1)
            << i;
    EXPECT_LT(norm(momentum() - body->reaction_impulse(0)), 1e-12 * norm(momentum()));
    const SolidEnergy e = body->energy();
    EXPECT_NEAR(e.constraint_work, e.kinetic + e.elastic + e.hourglass, 0.02 * e.constraint_work);
}

TEST(SolidBody, WhatBendsAMetalIsAccountedForToTheLast) {
    // A strut is bent until it is a hinge. Hourglass control becomes softer as the metal flows; what it gives up is not in the
    // energy of the particles any more.
    Solid solid;
    const J2Plastic steel{elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}}),
                          {.yield = 172e6, .slope = 1.5e9, .saturation = 0, .rate = 0}};
    fill(solid, block(20, 4, 4, 0), {8000, steel}, false);
    constexpr double ramp = 150e-6, way = 4 * spacing;
    solid.constraints = {{}, {{true, true, true}, [](const Vec3&, double t) {
                                  return Vec3{0, way * std::pow(std::sin(0.5 * std::numbers::pi * t / ramp), 2), 0};
                              }}};
    for (std::size_t i = 0; i < solid.particles.size(); ++i) {
        const double x = solid.particles.reference[i].x / spacing;
        solid.particles.constraint[i] = x < 2.5 ? 1 : x > 16.5 ? 2 : 0;
    }
    const auto body = make_solid_body(solid, numerics(false));
    const double dt = body->stable_step();
    for (double time = 0; time < ramp; time += dt) {
        body->drift(0.5 * dt, time + 0.5 * dt);
        body->compute_force(time + 0.5 * dt);
        body->kick(dt, time);
        body->drift(0.5 * dt, time + dt);
    }
    const SolidEnergy e = body->energy();
    EXPECT_GT(e.plastic, 0.5 * e.constraint_work);
    EXPECT_GT(e.yielded, 0.01 * e.constraint_work);
    EXPECT_LT(e.hourglass, 0.12 * e.constraint_work) << "curvature of a hinge must not be stored";
    EXPECT_NEAR(e.kinetic + e.internal() + e.lost(), e.constraint_work, 0.002 * e.constraint_work);
}
