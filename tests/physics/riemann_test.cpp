// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/fluid/riemann.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "patency/physics/fluid/equation_of_state.h"

namespace patency {
namespace {

constexpr double rest = 1060, c = 10;
using Side = RiemannSide<double>;

Side at(double velocity, double pressure) { return {density_at_pressure(pressure, rest, c), velocity, pressure}; }

/// The same pair seen from the other particle: the line turns round.
Side turned(const Side& s) { return {s.density, -s.velocity, s.pressure}; }

TEST(EquationOfState, goes_both_ways) {
    EXPECT_DOUBLE_EQ(pressure_at_density(rest, rest, c), 0);
    for (double p : {-500.0, 0.0, 3.0, 1000.0})   // density carries 1e-16 of 1060, which is 1e-11 Pa
        EXPECT_NEAR(pressure_at_density(density_at_pressure(p, rest, c), rest, c), p, 1e-10);
}

TEST(Riemann, equal_states_pass_unchanged) {
    const Side s = at(0.7, 12);
    EXPECT_DOUBLE_EQ(star_velocity(s, s, c), 0.7);
    EXPECT_DOUBLE_EQ(star_pressure(s, s, c), 12);
}

TEST(Riemann, limiter_is_nothing_for_parting_and_at_most_c_for_approaching_pairs) {
    EXPECT_EQ(riemann_limiter(-0.5, c), 0);
    EXPECT_EQ(riemann_limiter(0.0, c), 0);
    EXPECT_DOUBLE_EQ(riemann_limiter(0.5, c), 1.5);
    EXPECT_DOUBLE_EQ(riemann_limiter(100.0, c), c);
}

TEST(Riemann, approaching_pairs_are_pushed_apart_and_parting_ones_are_left_alone) {
    // The left one moves to the right, the right one to the left, each at 0.2: the jump is 0.4, beta = 1.2 and the mean
    // density halved weighs the product.
    EXPECT_NEAR(star_pressure(at(0.2, 0), at(-0.2, 0), c), 0.5 * rest * 1.2 * 0.4, 1e-9);
    EXPECT_DOUBLE_EQ(star_pressure(at(-0.2, 5), at(0.2, 7), c), 6);
}

TEST(Riemann, kinetic_energy_never_grows_by_the_dissipation) {
    // The extra pressure times the rate at which the gap closes is the power taken from the motion.
    for (double left : {-3.0, -0.1, 0.0, 0.4, 20.0})
        for (double right : {-20.0, -0.3, 0.0, 0.2, 3.0}) {
            const Side l = at(left, 40), r = at(right, -15);
            EXPECT_GE((star_pressure(l, r, c) - 12.5) * (left - right), -1e-12) << left << " " << right;
        }
}

TEST(Riemann, swapping_the_particles_changes_nothing_to_the_last_bit) {
    for (double left : {-0.31, 0.0, 0.77})
        for (double right : {-0.4, 0.13})
            for (double p : {-33.3, 0.0, 71.7}) {
                const Side l = at(left, p), r = at(right, 19.1);
                EXPECT_EQ(star_pressure(l, r, c), star_pressure(turned(r), turned(l), c));
                EXPECT_EQ(star_velocity(l, r, c), -star_velocity(turned(r), turned(l), c));
            }
}

TEST(Riemann, flow_goes_from_the_higher_pressure) {
    // To first order 0.5 (P_L - P_R) / (rho c); the densities differ from rest by p / (rho c^2) = 1e-3.
    EXPECT_NEAR(star_velocity(at(0, 100), at(0, 0), c), 0.5 * 100 / (rest * c), 1e-5);
}

TEST(Riemann, is_the_same_in_packs) {
    using P = Pack<double>;
    const Side l = at(0.4, 20), r = at(-0.1, 30);
    const RiemannSide<P> pl{l.density, l.velocity, l.pressure}, pr{r.density, r.velocity, r.pressure};
    EXPECT_EQ(star_pressure(pl, pr, P(c))[0], star_pressure(l, r, c));
    EXPECT_EQ(star_velocity(pl, pr, P(c))[P::lanes - 1], star_velocity(l, r, c));
}

}   // namespace
}   // namespace patency
