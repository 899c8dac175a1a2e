// SPDX-License-Identifier: Apache-2.0
// Solids before anything moves: the laws at a material point, and the gradient of disordered particles.
#include <algorithm>
#include <cmath>
#include <functional>

#include "patency/physics/solid/uniaxial.h"
#include "patency/schemes/solid_body.h"
#include "patency/verify/verify_case.h"

namespace patency {

namespace {

/// A law as plain functions, and the moduli it was made for.
struct PointLaw {
    ElasticModuli wanted;
    std::function<Mat3(const Mat3&)> pk1, pk2, kirchhoff;   // of F, C, F
    bool is_isotropic = true;
};

template <class Law>
PointLaw point_law(const ElasticModuli& wanted, const Law& law) {
    return {wanted, [law](const Mat3& F) { return law.pk1(F); }, [law](const Mat3& C) { return law.pk2(C); },
            [law](const Mat3& F) { return law.kirchhoff(F); }};
}

std::vector<PointLaw> point_laws() {
    std::vector<PointLaw> laws;
    for (const double nu : {0.125, 0.3, 0.45, 0.49}) {
        const ElasticModuli m = elastic_moduli({.young = 1e6, .poisson = nu, .shear = {}, .bulk = {}});
        laws.push_back(point_law(m, NeoHookean::from(m)));
        laws.push_back(point_law(m, StVenantKirchhoff::from(m)));
        laws.push_back(point_law(m, MooneyRivlin{0.35 * m.shear, 0.15 * m.shear, m.bulk}));
        laws.push_back(point_law(m, Yeoh{0.5 * m.shear, 0.2 * m.shear, 0.1 * m.shear, m.bulk}));
        const FibreArtery artery{m.shear, 2 * m.shear, 8, 0.1, m.bulk};
        const Fibres<double> fibres{normalized(Vec3{1, 0.8, 0}), normalized(Vec3{1, -0.8, 0})};
        laws.push_back({m, [=](const Mat3& F) { return artery.pk1(F, fibres); },
                        [=](const Mat3& C) { return artery.pk2(C, fibres); },
                        [=](const Mat3& F) { return artery.kirchhoff(F, fibres); }, false});
        const J2Plastic metal{m, {.yield = 1e-2 * m.young(), .slope = 0, .saturation = 0, .rate = 0}};
        laws.push_back({m, [=](const Mat3& F) { return pk1_of_kirchhoff(metal.kirchhoff(F), F); },
                        [=](const Mat3& C) {   // by the material route: S of the right stretch, which is sqrt(C)
                            const SymmetricEigen e = symmetric_eigen(C);
                            const Mat3 U = from_eigen(
                                {std::sqrt(e.values.x), std::sqrt(e.values.y), std::sqrt(e.values.z)}, e.vectors);
                            return pk2_of_pk1(pk1_of_kirchhoff(metal.kirchhoff(U), U), U);
                        },
                        [=](const Mat3& F) { return metal.kirchhoff(F); }});
    }
    return laws;
}

double off(double value, double wanted) { return std::abs(value / wanted - 1); }
double size(const Mat3& a) { return std::sqrt(double_dot(a, a)); }

/// Central differences where a law is smooth; fibres pull on one side only, so theirs are taken where they do not.
double moduli_error(const PointLaw& law) {
    const double e = 1e-5, one_sided = 1e-8;
    const auto sheared = [](double volume, double shear) {
        Mat3 F = (1 + volume) * identity<double>();
        F.x.y = F.y.x = shear;
        return F;
    };
    const auto [G, K] = law.wanted;
    if (!law.is_isotropic) {
        const double bulk = -trace(law.kirchhoff(sheared(-one_sided, 0))) / (9 * one_sided);
        return std::max(off(bulk, K), off(law.kirchhoff(sheared(-2 * one_sided, one_sided)).x.y / (2 * one_sided), G));
    }
    const double bulk = (trace(law.kirchhoff(sheared(e, 0))) - trace(law.kirchhoff(sheared(-e, 0)))) / (18 * e);
    const double shear = (law.kirchhoff(sheared(0, e)).x.y - law.kirchhoff(sheared(0, -e)).x.y) / (4 * e);
    const double nu = law.wanted.poisson();
    const UniaxialPoint up = pull_uniaxially(law.kirchhoff, 1 + e, 1 - nu * e, K),
                        down = pull_uniaxially(law.kirchhoff, 1 - e, 1 + nu * e, K);
    return std::max({off(bulk, K), off(shear, G), off((up.stress - down.stress) / (2 * e), law.wanted.young()),
                     std::abs((down.lateral - up.lateral) / (2 * e) - nu)});
}

double route_difference(const PointLaw& law) {
    const Mat3 F{{1.12, 0.15, -0.04}, {-0.06, 0.93, 0.08}, {0.03, -0.1, 1.05}};
    const Mat3 P = law.pk1(F);
    return std::max(size(F * law.pk2(transpose(F) * F) - P), size(pk1_of_kirchhoff(law.kirchhoff(F), F) - P)) / size(P);
}

/// Load, unload, reload, and on into compression, linear and Voce's hardening.
double j2_path_error() {
    const ElasticModuli m = elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}});
    double worst = 0;
    for (const Hardening& h : {Hardening{.yield = 205e6, .slope = 1.5e9, .saturation = 0, .rate = 0},
                               Hardening{.yield = 205e6, .slope = 0.3e9, .saturation = 500e6, .rate = 10}}) {
        const J2Plastic law{m, h};
        PlasticState state;
        double lateral = 1, plastic = 0, equivalent = 0;   // exact: log strain = stress / E + plastic
        double at = 0;
        for (const double to : {0.08, 0.0795, 0.15, 0.149, 0.05, 0.0505, -0.1}) {
            constexpr int parts = 20;
            for (int k = 1; k <= parts; ++k) {
                const double strain = at + (to - at) * k / parts, axial = std::exp(strain);
                const UniaxialPoint p = pull_uniaxially([&](const Mat3& F) { return law.stress(F, state).kirchhoff; },
                                                        axial, lateral, m.young());
                lateral = p.lateral;
                state = law.stress({{axial, 0, 0}, {0, lateral, 0}, {0, 0, lateral}}, state).state;
                const double trial = m.young() * (strain - plastic), side = trial > 0 ? 1 : -1;
                if (std::abs(trial) > h.stress(equivalent)) {   // E (|e - e_p| - x) = y(a + x), by bisection
                    double low = 0, high = std::abs(strain - plastic);
                    for (int n = 0; n < 200; ++n) {
                        const double x = 0.5 * (low + high);
                        (std::abs(trial) - m.young() * x > h.stress(equivalent + x) ? low : high) = x;
                    }
                    plastic += side * low, equivalent += low;
                }
                worst = std::max(worst, std::abs(p.stress - m.young() * (strain - plastic)) / h.yield);
            }
            at = to;
        }
    }
    return worst;
}

void material_figures(const Results&, FigureList& figures) {
    const auto laws = point_laws();
    const auto worst_of = [&](double (*error)(const PointLaw&)) {
        double worst = 0;
        for (const PointLaw& law : laws) worst = std::max(worst, error(law));
        return worst;
    };
    figures.add({"small_strain_moduli_error", "1", Bar{1e-6}}, {}, [&] { return worst_of(moduli_error); });
    figures.add({"route_difference", "1", Bar{1e-10}}, {}, [&] { return worst_of(route_difference); });
    figures.add({"j2_path_error", "1", Bar{1e-6}}, {}, j2_path_error);
}

/// A number in -1..1 that looks random and is the same everywhere.
double scatter(std::uint64_t n) {
    n = (n + 1) * 0x9E3779B97F4A7C15u;
    n = (n ^ (n >> 30)) * 0xBF58476D1CE4E5B9u;
    n = (n ^ (n >> 27)) * 0x94D049BB133111EBu;
    return double((n ^ (n >> 31)) >> 11) / double(1ULL << 52) - 1;
}

struct PatchErrors {
    double affine = 0, rotation = 0;
};

/// A block of particles, each moved by up to a quarter of a spacing: F against the one imposed, stress of a turned block over E.
PatchErrors measure_patch(Precision precision, bool planar) {
    constexpr double spacing = 1e-4;
    constexpr int across = 12;
    const ElasticModuli m = elastic_moduli({.young = 1e6, .poisson = 0.45, .shear = {}, .bulk = {}});
    const double s = std::sin(1.0), c = std::cos(1.0);
    const Mat3 turn_z{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, turn_x{{1, 0, 0}, {0, c, -s}, {0, s, c}};
    const Mat3 turn = planar ? turn_z : turn_x * turn_z;
    const Mat3 affine = planar ? Mat3{{1.2, 0.3, 0}, {-0.1, 0.9, 0}, {0, 0, 1}}
                               : Mat3{{1.2, 0.3, -0.1}, {-0.1, 0.9, 0.2}, {0.05, 0.1, 1.1}};
    PatchErrors errors;
    std::vector<Vec3> places;
    for (int k = 0; k < (planar ? 1 : across); ++k)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i) {
                const std::uint64_t n = 3 * places.size();
                places.push_back(spacing * Vec3{i + 0.25 * scatter(n), j + 0.25 * scatter(n + 1),
                                                planar ? 0 : k + 0.25 * scatter(n + 2)});
            }
    for (const bool is_turned : {false, true}) {
        Solid solid;
        solid.materials = {{1000, NeoHookean::from(m)}};
        place_particles(solid, places, planar ? spacing * spacing : spacing * spacing * spacing);
        SolidNumerics numerics;
        numerics.spacing = spacing, numerics.planar = planar, numerics.precision = precision;
        const auto body = make_solid_body(solid, numerics);
        SolidParticles& p = body->particles();
        const Mat3& F = is_turned ? turn : affine;
        for (std::size_t i = 0; i < p.size(); ++i) p.position[i] = F * p.reference[i];
        body->drift(0, 0);
        body->compute_force(0);
        for (std::size_t i = 0; i < p.size(); ++i) {
            if (is_turned)
                errors.rotation = std::max(errors.rotation, size(body->cauchy(i)) / m.young());
            else
                errors.affine = std::max(errors.affine, size(body->deformation(i) - F));
        }
    }
    return errors;
}

void patch_figures(const Results&, FigureList& figures) {
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
        PatchErrors worst;
        for (const bool planar : {true, false}) {
            const PatchErrors e = measure_patch(precision, planar);
            worst = {std::max(worst.affine, e.affine), std::max(worst.rotation, e.rotation)};
        }
        const bool is_mixed = precision == Precision::mixed;
        const std::string tail = is_mixed ? "_mixed" : "";
        const std::optional<Bar> bar = is_mixed ? std::nullopt : std::optional(Bar{1e-10});
        figures.add({"affine_error" + tail, "1", bar}, {}, [&] { return worst.affine; });
        figures.add({"rotation_stress" + tail, "1", bar}, {}, [&] { return worst.rotation; });
    }
}

}   // namespace

std::vector<VerifyCase> solid_point_cases() {
    return {{.name = "material_points",
             .title = "Laws of solids at a material point: moduli, routes of stress, a metal's path",
             .is_full = {},
             .measure = {},
             .figures = material_figures,
             .pictures = {}},
            {.name = "patch",
             .title = "The deformation gradient of disordered particles under a linear deformation and a rotation",
             .is_full = {},
             .measure = {},
             .figures = patch_figures,
             .pictures = {}}};
}

}   // namespace patency
