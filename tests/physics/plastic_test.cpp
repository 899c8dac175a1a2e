// SPDX-License-Identifier: Apache-2.0
// J2 plasticity at a material point, against what can be written down: uniaxial paths, simple facts of flow.
#include "patency/physics/solid/plastic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "patency/physics/solid/uniaxial.h"

using namespace patency;

namespace {

const ElasticModuli steel = elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}});

/// Pulls to each log strain in turn, in `steps` steps; the axial Kirchhoff stress at each.
std::vector<double> pull(const J2Plastic& law, const std::vector<double>& strains, int steps, PlasticState& state) {
    std::vector<double> stresses;
    double from = 0, lateral = 1;
    for (const double to : strains) {
        for (int k = 1; k <= steps; ++k) {
            const double axial = std::exp(from + (to - from) * k / steps);
            const UniaxialPoint p = pull_uniaxially([&](const Mat3& F) { return law.stress(F, state).kirchhoff; },
                                                    axial, lateral, law.elastic.young());
            lateral = p.lateral;
            state = law.stress({{axial, 0, 0}, {0, lateral, 0}, {0, 0, lateral}}, state).state;
            if (k == steps) stresses.push_back(p.stress);
        }
        from = to;
    }
    return stresses;
}

}   // namespace

TEST(J2Plastic, UniaxialLoadUnloadReloadIsTheClosedForm) {
    const double E = steel.young(), y = 300e6, H = 2e9;
    const J2Plastic law{steel, {.yield = y, .slope = H, .saturation = 0, .rate = 0}};
    for (const int steps : {1, 20}) {   // proportional: the step does not matter
        PlasticState state;
        const auto tau = pull(law, {0.1, 0.0995, 0.11, 0.0}, steps, state);
        // Loading: tau = y + H a and e = tau/E + a.
        const double a1 = (0.1 - y / E) / (1 + H / E), t1 = y + H * a1;
        EXPECT_NEAR(tau[0], t1, 1e-9 * t1);
        EXPECT_NEAR(tau[1], t1 - E * 0.0005, 1e-9 * t1) << "unloading is elastic";
        const double a2 = (0.11 - y / E) / (1 + H / E), t2 = y + H * a2;
        EXPECT_NEAR(tau[2], t2, 1e-9 * t2);
        // Back to no strain: yields again at -t2, from e2 = 0.11 - 2 t2/E on; tau = -(y + H a), e = 0.11 - t2/E + tau/E - (a - a2).
        const double a3 = (0.11 - (t2 + y) / E + a2) / (1 + H / E), t3 = -(y + H * a3);
        EXPECT_NEAR(tau[3], t3, 1e-9 * t2);
        EXPECT_NEAR(state.strain, a3, 1e-9);
    }
}

TEST(J2Plastic, VoceHardeningFollowsItsCurve) {
    const double E = steel.young();
    const J2Plastic law{steel, {.yield = 250e6, .slope = 1e9, .saturation = 600e6, .rate = 12}};
    PlasticState state;
    const double tau = pull(law, {0.3}, 1, state)[0];
    EXPECT_NEAR(tau, law.hardening.stress(state.strain), 1e-9 * tau);
    EXPECT_NEAR(0.3, tau / E + state.strain, 1e-9);
    EXPECT_NEAR(law.hardening.stress(0.2), 250e6 + 0.2e9 + 350e6 * (1 - std::exp(-2.4)), 1);
}

TEST(Hardening, WorkIsTheIntegralOfTheYieldStress) {
    const Hardening h{.yield = 250e6, .slope = 1e9, .saturation = 600e6, .rate = 12};
    constexpr int n = 100000;
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += h.stress(0.3 * (k + 0.5) / n) * 0.3 / n;
    EXPECT_NEAR(h.work(0.3), sum, 1e-8 * sum);
    EXPECT_NEAR(h.tangent(0.1), (h.stress(0.1 + 1e-6) - h.stress(0.1 - 1e-6)) / 2e-6, 1e-5 * h.tangent(0.1));
}

TEST(J2Plastic, FlowKeepsTheVolumeAndTheElasticPartIsOnTheYieldSurface) {
    const J2Plastic law{steel, {.yield = 300e6, .slope = 1e9, .saturation = 0, .rate = 0}};
    PlasticState state;
    const Mat3 F{{1.2, 0.3, 0}, {0.1, 0.9, -0.2}, {0, 0.1, 1.05}};
    const PlasticStress s = law.stress(F, state);
    EXPECT_NEAR(determinant(s.state.inverse_plastic), 1, 1e-12);
    EXPECT_NEAR(von_mises(s.kirchhoff), law.hardening.stress(s.state.strain), 1e-9 * 300e6);
    EXPECT_NEAR(trace(s.kirchhoff) / 3, steel.bulk * std::log(determinant(F)), 1e-6 * 300e6) << "pressure is elastic";
}

TEST(J2Plastic, AskedTwiceItAnswersTheSame) {
    const J2Plastic law{steel, {.yield = 300e6, .slope = 1e9, .saturation = 0, .rate = 0}};
    const Mat3 F{{1.02, 0.03, 0}, {0.01, 0.99, -0.02}, {0, 0.01, 1.005}};
    const PlasticStress once = law.stress(F, {}), again = law.stress(F, once.state);
    EXPECT_NEAR(again.state.strain, once.state.strain, 1e-14);
    EXPECT_LT(std::sqrt(double_dot(again.kirchhoff - once.kirchhoff, again.kirchhoff - once.kirchhoff)), 1e-8 * 300e6);
}

TEST(J2Plastic, ARotatedObserverSeesTheRotatedStressAndTheSameState) {
    const J2Plastic law{steel, {.yield = 300e6, .slope = 1e9, .saturation = 0, .rate = 0}};
    const Mat3 F{{1.02, 0.03, 0}, {0.01, 0.99, -0.02}, {0, 0.01, 1.005}};
    const Mat3 R{{0.6, -0.8, 0}, {0.8, 0.6, 0}, {0, 0, 1}};
    const PlasticStress a = law.stress(F, {}), b = law.stress(R * F, {});
    const Mat3 stress = b.kirchhoff - R * a.kirchhoff * transpose(R),
               state = b.state.inverse_plastic - a.state.inverse_plastic;
    EXPECT_LT(std::sqrt(double_dot(stress, stress)), 1e-9 * 300e6);
    EXPECT_LT(std::sqrt(double_dot(state, state)), 1e-12);
}

TEST(J2Plastic, ElasticStressIsTheSlopeOfItsEnergy) {
    const J2Plastic law{steel, {.yield = 1e30, .slope = 0, .saturation = 0, .rate = 0}};
    const Mat3 F{{1.02, 0.03, 0}, {0.01, 0.99, -0.02}, {0, 0.01, 1.005}};
    const Mat3 P = pk1_of_kirchhoff(law.kirchhoff(F), F);
    Mat3 up = F, down = F;
    up.x.y += 1e-6, down.x.y -= 1e-6;
    EXPECT_NEAR((law.energy(up, {}) - law.energy(down, {})) / 2e-6, P.x.y, 1e-7 * std::abs(P.x.y));
}

TEST(SymmetricEigen, RebuildsTheMatrixAlsoWhereValuesMeet) {
    for (const Mat3& a : {Mat3{{2, 1, 0}, {1, 3, -1}, {0, -1, 4}}, Mat3{{1 + 1e-9, 1e-10, 0}, {1e-10, 1, 0}, {0, 0, 1}},
                          identity<double>()}) {
        const SymmetricEigen e = symmetric_eigen(a);
        const Mat3 off = from_eigen(e.values, e.vectors) - a,
                   turn = e.vectors * transpose(e.vectors) - identity<double>();
        EXPECT_LT(std::sqrt(double_dot(off, off)), 1e-14);
        EXPECT_LT(std::sqrt(double_dot(turn, turn)), 1e-14);
    }
}
