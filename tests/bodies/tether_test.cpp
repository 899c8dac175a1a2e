// SPDX-License-Identifier: Apache-2.0
// Springs on a face: proportional to the way and the area, nothing on other faces, the slope of their energy.
#include "patency/bodies/tether.h"

#include <gtest/gtest.h>

#include "patency/bodies/solid_shape.h"

namespace patency {
namespace {

TEST(Tether, HoldsItsFaceByItsArea) {
    const SolidFill fill = fill_box({0, 0, 0}, {2e-3, 1e-3, 1e-3}, 0.25e-3, false);
    Solid solid{.particles = {},
                .materials = {{1000, NeoHookean::from(elastic_moduli({1e6, 0.3, {}, {}}))}},
                .constraints = {}};
    place_particles(solid, fill.places, fill.volumes[0]);
    SolidSurface surface(fill.surface, solid.particles, 0.6e-3, false);
    std::uint16_t face = 0;
    while (fill.surface.faces[face] != "z_high") ++face;
    const auto tether = make_tether(surface, face, 5e6);
    const Vec3 u = {1e-5, -2e-5, 3e-5};
    for (Vec3& x : solid.particles.position) x += u;
    surface.follow(solid.particles);
    tether->add_forces(0, 1e-6);
    const double k = 5e6 * 2e-6;   // the face has 2 mm^2
    Vec3 sum{};
    for (const Vec3& f : surface.force) sum += f;
    EXPECT_LT(norm(sum + k * u), 1e-9 * norm(k * u));
    EXPECT_LT(norm(tether->report().force + k * u), 1e-9 * norm(k * u));
    EXPECT_NEAR(tether->report().energy, 0.5 * k * dot(u, u), 1e-9 * k * dot(u, u));
    for (std::size_t v = 0; v < surface.size(); ++v)
        if (surface.mesh().vertices[v].z < 0.5e-3) {
            EXPECT_EQ(norm(surface.force[v]), 0);
        }
}

}   // namespace
}   // namespace patency
