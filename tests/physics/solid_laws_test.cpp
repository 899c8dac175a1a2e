// SPDX-License-Identifier: Apache-2.0
// Laws of solids at a material point: the stress is the slope of the energy, does not depend on the observer, is the same by
// every route and in a pack, and has the moduli that were asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "patency/physics/solid/fibre_artery.h"
#include "patency/physics/solid/hyperelastic.h"
#include "patency/physics/solid/uniaxial.h"

using namespace patency;

namespace {

const ElasticModuli moduli = elastic_moduli({.young = 2e5, .poisson = 0.3, .shear = {}, .bulk = {}});
const Fibres<double> fibres{normalized(Vec3{1, 0.7, 0.2}), normalized(Vec3{1, -0.7, 0.1})};

/// A law with its fibres, if it has any, as plain functions.
struct Law {
    const char* name;
    ElasticModuli moduli;
    std::function<double(const Mat3&)> energy;
    std::function<Mat3(const Mat3&)> pk1, pk2_of_C, kirchhoff;
};

template <class L>
Law isotropic(const char* name, const L& law) {
    return {name,
            law.moduli(),
            [law](const Mat3& F) { return law.energy(F); },
            [law](const Mat3& F) { return law.pk1(F); },
            [law](const Mat3& C) { return law.pk2(C); },
            [law](const Mat3& F) { return law.kirchhoff(F); }};
}

std::vector<Law> laws() {
    const FibreArtery artery{3e4, 5e4, 8, 0.1, 6e5};
    return {isotropic("neo-Hookean", NeoHookean::from(moduli)),
            isotropic("St. Venant-Kirchhoff", StVenantKirchhoff::from(moduli)),
            isotropic("Mooney-Rivlin", MooneyRivlin{3e4, 1e4, 2e5}),
            isotropic("Yeoh", Yeoh{3e4, 2e4, 1e4, 2e5}),
            {"fibre artery", artery.moduli(), [=](const Mat3& F) { return artery.energy(F, fibres); },
             [=](const Mat3& F) { return artery.pk1(F, fibres); }, [=](const Mat3& C) { return artery.pk2(C, fibres); },
             [=](const Mat3& F) { return artery.kirchhoff(F, fibres); }}};
}

std::vector<Mat3> deformations() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-0.25, 0.25);
    std::vector<Mat3> all;
    while (all.size() < 20) {
        Mat3 F = identity<double>();
        for (double* f : {&F.x.x, &F.x.y, &F.x.z, &F.y.x, &F.y.y, &F.y.z, &F.z.x, &F.z.y, &F.z.z}) *f += any(random);
        if (determinant(F) > 0.4) all.push_back(F);
    }
    return all;
}

double size(const Mat3& a) { return std::sqrt(double_dot(a, a)); }

}   // namespace

TEST(SolidLaws, StressIsTheSlopeOfTheEnergy) {
    for (const Law& law : laws())
        for (const Mat3& F : deformations()) {
            const Mat3 P = law.pk1(F);
            constexpr double step = 1e-6;   // the central difference is then right to 1e-9 of the modulus
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column) {
                    const auto moved = [&](double by) {
                        Mat3 G = F;
                        Vec3& r = row == 0 ? G.x : row == 1 ? G.y : G.z;
                        (column == 0 ? r.x : column == 1 ? r.y : r.z) += by;
                        return law.energy(G);
                    };
                    const Vec3& r = row == 0 ? P.x : row == 1 ? P.y : P.z;
                    const double p = column == 0 ? r.x : column == 1 ? r.y : r.z;
                    EXPECT_NEAR((moved(step) - moved(-step)) / (2 * step), p, 1e-7 * size(P) + 1e-2) << law.name;
                }
        }
}

TEST(SolidLaws, ReferenceStateIsFreeOfStressAndEnergy) {
    for (const Law& law : laws()) {
        EXPECT_LT(size(law.pk1(identity<double>())), 1e-9) << law.name;
        EXPECT_NEAR(law.energy(identity<double>()), 0, 1e-9) << law.name;
    }
}

TEST(SolidLaws, ARotatedObserverSeesTheSameEnergyAndTheRotatedStress) {
    const double s = std::sin(1.1), c = std::cos(1.1);
    const Mat3 R = Mat3{{c, -s, 0}, {s, c, 0}, {0, 0, 1}} * Mat3{{1, 0, 0}, {0, c, -s}, {0, s, c}};
    for (const Law& law : laws())
        for (const Mat3& F : deformations()) {
            EXPECT_NEAR(law.energy(R * F), law.energy(F), 1e-10 * law.moduli.bulk) << law.name;
            EXPECT_LT(size(law.pk1(R * F) - R * law.pk1(F)), 1e-12 * law.moduli.bulk + 1e-12 * size(law.pk1(F)))
                << law.name;
        }
}

TEST(SolidLaws, KirchhoffStressIsSymmetric) {
    for (const Law& law : laws())
        for (const Mat3& F : deformations()) {
            const Mat3 tau = kirchhoff_of_pk1(law.pk1(F), F);
            EXPECT_LT(size(tau - transpose(tau)), 1e-12 * size(tau) + 1e-9) << law.name;
        }
}

TEST(SolidLaws, AllRoutesGiveTheSameStress) {
    for (const Law& law : laws())
        for (const Mat3& F : deformations()) {
            const Mat3 P = law.pk1(F);
            EXPECT_LT(size(F * law.pk2_of_C(transpose(F) * F) - P), 1e-12 * size(P) + 1e-12 * law.moduli.bulk)
                << law.name;
            EXPECT_LT(size(pk1_of_kirchhoff(law.kirchhoff(F), F) - P), 1e-12 * size(P) + 1e-12 * law.moduli.bulk)
                << law.name;
        }
}

TEST(SolidLaws, SmallStrainModuliAreThoseAskedFor) {
    constexpr double e = 1e-8;   // strain; the curvature of a law then shows as a few 1e-8
    for (const Law& law : laws()) {
        const auto [G, K] = law.moduli;
        const Mat3 squeezed = law.kirchhoff((1 - e) * identity<double>());   // fibres do not pull
        EXPECT_NEAR(-trace(squeezed) / (9 * e), K, 1e-6 * K) << law.name;
        // Sheared and squeezed a little: no fibre is stretched.
        Mat3 F = (1 - 2 * e) * identity<double>();
        F.x.y = F.y.x = e;
        EXPECT_NEAR(law.kirchhoff(F).x.y / (2 * e), G, 1e-6 * G) << law.name;
    }
}

TEST(SolidLaws, TensionShowsYoungsModulusAndPoissonsRatio) {
    constexpr double e = 1e-6;
    for (const Law& law : laws()) {
        if (std::string(law.name) == "fibre artery") continue;   // is not isotropic
        const UniaxialPoint p = pull_uniaxially(law.kirchhoff, 1 + e, 1 - law.moduli.poisson() * e, law.moduli.bulk);
        const UniaxialPoint n = pull_uniaxially(law.kirchhoff, 1 - e, 1 + law.moduli.poisson() * e, law.moduli.bulk);
        EXPECT_NEAR((p.stress - n.stress) / (2 * e), law.moduli.young(), 1e-6 * law.moduli.young()) << law.name;
        EXPECT_NEAR((n.lateral - p.lateral) / (2 * e), law.moduli.poisson(), 1e-6) << law.name;
    }
}

TEST(SolidLaws, FibresPullOnlyWhenStretched) {
    const FibreArtery artery{3e4, 5e4, 8, 0.0, 6e5}, bare{3e4, 1e-300, 8, 0.0, 6e5};
    const Fibres<double> along{{1, 0, 0}, {1, 0, 0}};
    const auto stretched = [](double l) { return Mat3{{l, 0, 0}, {0, 1, 0}, {0, 0, 1}}; };
    EXPECT_EQ(artery.pk1(stretched(0.9), along), bare.pk1(stretched(0.9), along));
    // Both families along x: tau_xx = 2 * 2 k1 E exp(k2 E^2) l^2, E = l^2 - 1.
    const double l = 1.2, E = l * l - 1, by_hand = 4 * 5e4 * E * std::exp(8 * E * E) * l * l;
    EXPECT_NEAR((artery.kirchhoff(stretched(l), along) - bare.kirchhoff(stretched(l), along)).x.x, by_hand,
                1e-9 * by_hand);
}

TEST(SolidLaws, NeoHookeanUnderUniformStretchByHand) {
    const NeoHookean law{2, 3};
    // F = 2: J = 8, P = G (2 - 1/2) + lambda/2 (64 - 1)/2.
    EXPECT_NEAR(law.pk1(2.0 * identity<double>()).y.y, 2 * 1.5 + 0.5 * 3 * 63 / 2, 1e-13);
}

TEST(SolidLaws, PackIsTheNumberLaneByLane) {
    using P = Pack<double>;
    const NeoHookean neo = NeoHookean::from(moduli);
    const Yeoh yeoh{3e4, 2e4, 1e4, 2e5};
    const FibreArtery artery{3e4, 5e4, 8, 0.1, 6e5};
    const auto wide = [](const Vec3& v) { return Vec<P>{P(v.x), P(v.y), P(v.z)}; };
    for (const Mat3& F : deformations()) {
        const Mat<P> G{wide(F.x), wide(F.y), wide(F.z)};
        EXPECT_EQ(neo.pk1(G).y.z[P::lanes - 1], neo.pk1(F).y.z);
        EXPECT_EQ(yeoh.pk1(G).z.x[0], yeoh.pk1(F).z.x);
        EXPECT_EQ(artery.pk1(G, Fibres<P>{wide(fibres.first), wide(fibres.second)}).x.y[0], artery.pk1(F, fibres).x.y);
    }
}

TEST(ElasticModuli, AnyTwoTellTheOthers) {
    const double E = 1e6, nu = 0.45, G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));
    const std::vector<GivenModuli> given = {
        {.young = E, .poisson = nu, .shear = {}, .bulk = {}}, {.young = E, .poisson = {}, .shear = G, .bulk = {}},
        {.young = E, .poisson = {}, .shear = {}, .bulk = K},  {.young = {}, .poisson = nu, .shear = G, .bulk = {}},
        {.young = {}, .poisson = nu, .shear = {}, .bulk = K}, {.young = {}, .poisson = {}, .shear = G, .bulk = K}};
    for (const GivenModuli& g : given) {
        const ElasticModuli m = elastic_moduli(g);
        EXPECT_NEAR(m.young(), E, 1e-8 * E);
        EXPECT_NEAR(m.poisson(), nu, 1e-8);
        EXPECT_NEAR(m.shear, G, 1e-8 * G);
        EXPECT_NEAR(m.bulk, K, 1e-8 * K);
    }
    EXPECT_NEAR(elastic_moduli(given[0]).p_wave(), E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), 1e-3);
}

TEST(ElasticModuli, OneOrThreeOrImpossibleOnesAreRefused) {
    EXPECT_THROW(elastic_moduli({.young = 1e6, .poisson = {}, .shear = {}, .bulk = {}}), DeckError);
    EXPECT_THROW(elastic_moduli({.young = 1e6, .poisson = 0.3, .shear = {}, .bulk = 2.5e6}), DeckError);
    EXPECT_THROW(elastic_moduli({.young = 1e6, .poisson = 0.5, .shear = {}, .bulk = {}}), DeckError);
}
