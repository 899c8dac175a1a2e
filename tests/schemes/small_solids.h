// SPDX-License-Identifier: Apache-2.0
// Small blocks of a solid for tests, on a lattice or off it.
#pragma once

#include <random>
#include <vector>

#include "patency/schemes/solid_body.h"

namespace patency::testing_solids {

inline constexpr double spacing = 1e-3;

/// nx ny nz particles; planar if nz is 0. disorder: in spacings.
inline std::vector<Vec3> block(int nx, int ny, int nz, double disorder) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-disorder, disorder);
    std::vector<Vec3> x;
    for (int k = 0; k < std::max(nz, 1); ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                const double a = any(random), b = any(random), c = any(random);
                x.push_back(spacing * Vec3{i + a, j + b, nz == 0 ? 0 : k + c});
            }
    return x;
}

inline SolidNumerics numerics(bool planar, Precision precision = Precision::double_precision) {
    SolidNumerics n;
    n.spacing = spacing;
    n.planar = planar;
    n.precision = precision;
    return n;
}

inline SolidMaterial rubber(double poisson = 0.4) {
    return {1000, NeoHookean::from(elastic_moduli({.young = 1e6, .poisson = poisson, .shear = {}, .bulk = {}}))};
}

inline void fill(Solid& solid, const std::vector<Vec3>& places, const SolidMaterial& material, bool planar) {
    solid.materials = {material};
    place_particles(solid, places, planar ? spacing * spacing : spacing * spacing * spacing);
}

/// Moves particles somewhere no law of geometry explains, some percent of a spacing.
inline void shake(SolidParticles& p, double share, bool planar) {
    for (std::size_t i = 0; i < p.size(); ++i) {   // by place, so that it does not depend on the order
        const Vec3 q = p.reference[i] / spacing;
        p.position[i] = p.reference[i] + share * spacing *
                                             Vec3{std::sin(3.1 * q.x + 1.7 * q.y + 0.9 * q.z),
                                                  std::cos(2.3 * q.y - q.x + 1.3 * q.z),
                                                  planar ? 0 : std::sin(1.9 * q.z + 2.7 * q.x)};
    }
}

inline Vec3 total(const Field<Vec3>& field) {
    Vec3 sum{};
    for (const Vec3& f : field) sum += f;
    return sum;
}

}   // namespace patency::testing_solids
