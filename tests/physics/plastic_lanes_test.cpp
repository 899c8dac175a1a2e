// SPDX-License-Identifier: Apache-2.0
// Metal by packs does what metal by one does, elastic and flowing, whichever lanes are beside it.
#include "patency/physics/solid/plastic_lanes.h"

#include <gtest/gtest.h>

#include <random>

using namespace patency;

namespace {

using P = Pack<double>;

Mat3 lane_of(const Mat<P>& m, int l) {
    return {{m.x.x[l], m.x.y[l], m.x.z[l]}, {m.y.x[l], m.y.y[l], m.y.z[l]}, {m.z.x[l], m.z.y[l], m.z.z[l]}};
}
void put(Mat<P>& m, int l, const Mat3& a) {
    m.x.x.v[l] = a.x.x, m.x.y.v[l] = a.x.y, m.x.z.v[l] = a.x.z, m.y.x.v[l] = a.y.x, m.y.y.v[l] = a.y.y,
    m.y.z.v[l] = a.y.z;
    m.z.x.v[l] = a.z.x, m.z.y.v[l] = a.z.y, m.z.z.v[l] = a.z.z;
}
double distance(const Mat3& a, const Mat3& b) { return std::sqrt(double_dot(a - b, a - b)); }

}   // namespace

Sym<P> symmetric(const Mat<P>& m) { return {m.x.x, m.y.y, m.z.z, m.x.y, m.x.z, m.y.z}; }
Mat<P> full(const Sym<P>& s) { return {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}; }

class PlasticLanesOf : public ::testing::TestWithParam<Hardening> {};
INSTANTIATE_TEST_SUITE_P(Laws, PlasticLanesOf,
                         ::testing::Values(Hardening{.yield = 172e6, .slope = 1.5e9, .saturation = 0, .rate = 0},
                                           Hardening{.yield = 250e6, .slope = 1e8, .saturation = 600e6, .rate = 12}));

TEST_P(PlasticLanesOf, AreThoseOfOneAlone) {
    constexpr unsigned first_seed = 236;   // of walks that stay within the series' range for up to eight lanes
    const J2Plastic law{elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}}), GetParam()};
    std::vector<std::mt19937> random;   // of each lane: it goes its way for any number of lanes
    for (unsigned l = 0; l < unsigned(P::lanes); ++l) random.emplace_back(first_seed + l);
    const auto matrix = [&](int lane, double size) {
        std::normal_distribution<double> any;
        Mat3 m;
        for (double* x : {&m.x.x, &m.x.y, &m.x.z, &m.y.x, &m.y.y, &m.y.z, &m.z.x, &m.z.y, &m.z.z})
            *x = size * any(random[std::size_t(lane)]);
        return m;
    };
    // A random walk of the deformation, turned anyhow: most steps flow, every other lane is nearly at rest.
    std::vector<Mat3> F(std::size_t(P::lanes), identity<double>());
    std::vector<PlasticState> state(std::size_t(P::lanes));
    int flowed = 0, rested = 0;
    for (int step = 0; step < 200; ++step) {
        Mat<P> f, c;
        P a;
        for (int l = 0; l < P::lanes; ++l) {
            F[std::size_t(l)] = (identity<double>() + matrix(l, l % 2 ? 3e-3 : 1e-5)) * F[std::size_t(l)];
            put(f, l, F[std::size_t(l)]), put(c, l, state[std::size_t(l)].inverse_plastic),
                a.v[l] = state[std::size_t(l)].strain;
        }
        const auto packed = stress_by_series(law, f, symmetric(c), a);
        for (int l = 0; l < P::lanes; ++l) {
            const auto alone = law.stress(F[std::size_t(l)], state[std::size_t(l)]);
            ASSERT_LT(packed.distance[l], furthest_series);
            EXPECT_LT(distance(lane_of(full(packed.kirchhoff), l), alone.kirchhoff), 1e-11 * law.elastic.shear);
            EXPECT_LT(distance(lane_of(full(packed.inverse_plastic), l), alone.state.inverse_plastic), 1e-12);
            EXPECT_NEAR(packed.strain[l], alone.state.strain, 1e-13);
            const bool flows = alone.state.strain > state[std::size_t(l)].strain;
            if (!flows) {
                EXPECT_EQ(lane_of(full(packed.inverse_plastic), l), lane_of(full(symmetric(c)), l));
            }
            flowed += flows, rested += !flows;
            state[std::size_t(l)] = alone.state;
        }
    }
    EXPECT_GT(flowed, 100);
    EXPECT_GT(rested, 100);
}
