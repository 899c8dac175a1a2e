// SPDX-License-Identifier: Apache-2.0
// The operators of the default scheme on fields whose derivatives are known: the gradient of a linear pressure, the
// divergence of a linear velocity, the Laplacian of a quadratic one; on a lattice and off it, in the plane and in space.
// Read from one step of the scheme that is too short to move anything.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "patency/verify/verify_case.h"

namespace patency {

namespace {

constexpr double spacing = 1e-4;   // m
constexpr int across = 16;         // particles along a side; those within a kernel's support of the border are left out
constexpr double disorder = 0.2;   // spacings, largest displacement along an axis

struct Errors {
    double gradient = 0, divergence = 0, laplacian = 0;
};

/// A number in -1..1 that looks random and is the same everywhere.
double scatter(std::uint64_t n) {
    n = (n + 1) * 0x9E3779B97F4A7C15u;
    n = (n ^ (n >> 30)) * 0xBF58476D1CE4E5B9u;
    n = (n ^ (n >> 27)) * 0x94D049BB133111EBu;
    return double((n ^ (n >> 31)) >> 11) / double(1ULL << 52) - 1;
}

Errors measure_operators(Precision precision, bool planar, bool is_disordered) {
    FluidParticles fluid;
    WallParticles wall;
    std::vector<OpenEnd> ends;
    const double half = 0.5 * across * spacing;
    const int layers = planar ? 1 : across;
    const FluidMaterial material{.density = 1000, .viscosity = 1e-3, .sound_speed = 1, .viscosity_at = {}};
    // Velocities of the order 1 over the block; the quadratic part is smaller, so that both are seen.
    const Vec3 slope{3, -2, planar ? 0.0 : 1.0};                               // of p, 1/half
    const Mat3 linear{{0.7, -0.3, 0.2}, {0.4, 0.5, -0.6}, {-0.2, 0.8, 0.9}};   // of v, 1/half
    const Mat3 bend_u{{0.6, 0.2, 0.1}, {0.2, 0.3, -0.2}, {0.1, -0.2, 0.4}};    // of u, 1/half^2: u += x.A x
    const auto quadratic = [&](const Vec3& x, double share) { return share * dot(x, bend_u * x); };
    fluid.resize(std::size_t(across) * across * layers);
    std::size_t n = 0;
    for (int k = 0; k < layers; ++k)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i, ++n) {
                Vec3 x{(i + 0.5) * spacing - half, (j + 0.5) * spacing - half, planar ? 0 : (k + 0.5) * spacing - half};
                if (is_disordered)
                    x += disorder * spacing * Vec3{scatter(3 * n), scatter(3 * n + 1), planar ? 0 : scatter(3 * n + 2)};
                fluid.position[n] = x;
                fluid.volume[n] = planar ? spacing * spacing : spacing * spacing * spacing;
                fluid.viscosity[n] = material.viscosity;
                fluid.pressure[n] = dot(slope, x / half);
                const Vec3 q = x / half;
                const Vec3 v = linear * q;
                fluid.velocity[n] = {v.x + quadratic(q, 1), v.y + quadratic(q, -0.5),
                                     planar ? 0 : v.z + quadratic(q, 0.8)};
            }
    const WendlandC2 kernel{1.3 * spacing, planar};
    const Vec3 corner = (half + 6 * spacing) * Vec3{1, 1, 1};
    const Frame frame(-1.0 * corner, corner, kernel.support());
    FlowNumerics numerics;
    numerics.spacing = spacing;
    numerics.planar = planar;
    numerics.reference_speed = 1;
    numerics.shift = 0;
    const auto scheme =
        make_flow_scheme(precision, {fluid, wall, ends, frame, [](const Vec3&) { return -1.0; }}, material, numerics);
    scheme->step(0, 1e-15);

    const double trace = planar ? bend_u.x.x + bend_u.y.y : bend_u.x.x + bend_u.y.y + bend_u.z.z;
    const Vec3 exact_laplacian = 2 * trace / (half * half) * Vec3{1, -0.5, planar ? 0 : 0.8};
    const Vec3 exact_gradient = slope / half;
    Errors errors;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vec3& x = fluid.position[i];
        const double inside = half - std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        if (inside < kernel.support() + spacing) continue;
        errors.gradient =
            std::max(errors.gradient, norm(fluid.pressure_gradient[i] - exact_gradient) / norm(exact_gradient));
        const Vec3 laplacian = fluid.slow_acceleration[i] / material.kinematic_viscosity();
        errors.laplacian = std::max(errors.laplacian, norm(laplacian - exact_laplacian) / norm(exact_laplacian));
    }
    // The divergence again with the linear part alone: a first-order operator is exact for no more off the lattice.
    FluidParticles other;
    other.resize(fluid.size());
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        other.position[i] = fluid.position[i];
        other.volume[i] = fluid.volume[i];
        other.viscosity[i] = material.viscosity;
        const Vec3 v = linear * (fluid.position[i] / half);
        other.velocity[i] = {v.x, v.y, planar ? 0 : v.z};
    }
    const auto again =
        make_flow_scheme(precision, {other, wall, ends, frame, [](const Vec3&) { return -1.0; }}, material, numerics);
    again->step(0, 1e-15);
    const double exact = (linear.x.x + linear.y.y + (planar ? 0 : linear.z.z)) / half;
    for (std::size_t i = 0; i < other.size(); ++i) {
        const Vec3& x = other.position[i];
        if (half - std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) < kernel.support() + spacing) continue;
        const Mat3& g = other.velocity_gradient[i];
        errors.divergence = std::max(errors.divergence, std::abs(g.x.x + g.y.y + g.z.z - exact) / std::abs(exact));
    }
    return errors;
}

void operator_figures(const Results&, FigureList& figures) {
    for (const bool is_disordered : {false, true})
        for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
            Errors worst;
            for (const bool planar : {true, false}) {
                const Errors e = measure_operators(precision, planar, is_disordered);
                worst = {std::max(worst.gradient, e.gradient), std::max(worst.divergence, e.divergence),
                         std::max(worst.laplacian, e.laplacian)};
            }
            const std::string tail =
                std::string(is_disordered ? "_disordered" : "") + (precision == Precision::mixed ? "_single" : "");
            const Bar bar{precision == Precision::mixed ? 1e-5 : 1e-10};
            figures.add({"gradient_error" + tail, "1", bar}, {}, [&] { return worst.gradient; });
            figures.add({"divergence_error" + tail, "1", bar}, {}, [&] { return worst.divergence; });
            figures.add({"laplacian_error" + tail, "1", is_disordered ? std::nullopt : std::optional(bar)}, {},
                        [&] { return worst.laplacian; });
        }
}

}   // namespace

std::vector<VerifyCase> operator_cases() {
    return {{.name = "lattice_operators",
             .title = "Gradient, divergence and Laplacian of polynomials, on a lattice and off it",
             .is_full = {},
             .measure = {},
             .figures = operator_figures,
             .pictures = {}}};
}

}   // namespace patency
