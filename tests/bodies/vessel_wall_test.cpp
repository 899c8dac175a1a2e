// SPDX-License-Identifier: Apache-2.0
// Particles of a vessel's wall: between its faces, with its volume, evenly dense, in their layers; its surface is carried.
#include "patency/bodies/vessel_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi, R = 1.5e-3, narrow = 1.0e-3, t = 0.8e-3, length = 5e-3, spacing = 0.2e-3;

/// Of a tube narrowed to 1 mm whose healthy radius is 1.5 mm; plaque between.
VesselWall plaque_wall() {
    Centreline line{"outlet"};
    for (int k = 0; k <= 40; ++k) line.points.push_back({{0.5e-3 * k, 0, 0}, {1, 0, 0}, narrow, 0.5e-3 * k});
    const BranchedLines lines = find_branches({line});
    const WallField field(lines, {std::vector<double>(41, 2 * R)}, {{-1, 0, 0}, {1, 0, 0}}, round_tube(narrow),
                          {.thickness = t, .is_filled = true, .line = 0, .from = 9e-3, .to = 11e-3, .reach = 1.6e-3});
    return make_vessel_wall(field, spacing, 0.25);
}

TEST(VesselWall, HasTheVolumeOfTheWallInItsLayers) {
    const VesselWall wall = plaque_wall();
    const double whole = pi * ((R + t) * (R + t) - narrow * narrow) * length;
    EXPECT_NEAR(wall.volume * double(wall.places.size()), whole, 2e-3 * whole);
    EXPECT_NEAR(std::cbrt(wall.volume), spacing, 0.01 * spacing);
    const auto share = [&](WallLayer layer) {
        return double(std::count(wall.layer.begin(), wall.layer.end(), layer)) / double(wall.layer.size());
    };
    const double adventitia = (R + t) * (R + t) - (R + 0.75 * t) * (R + 0.75 * t), plaque = R * R - narrow * narrow,
                 all = (R + t) * (R + t) - narrow * narrow;
    EXPECT_NEAR(share(WallLayer::plaque), plaque / all, 0.04);   // layers of particles are 0.2 mm
    EXPECT_NEAR(share(WallLayer::adventitia), adventitia / all, 0.04);
    for (std::size_t i = 0; i < wall.places.size(); ++i) {
        const Vec3& x = wall.places[i];
        const double r = std::hypot(x.y, x.z);
        ASSERT_GT(r, narrow + 0.4 * spacing);   // half a spacing from every face
        ASSERT_LT(r, R + t - 0.4 * spacing);
        ASSERT_EQ(wall.layer[i] == WallLayer::plaque, r < R);
        ASSERT_EQ(wall.is_at_end[i] != 0, std::min(x.x - 7.5e-3, 12.5e-3 - x.x) < 2.5 * spacing);
    }
}

TEST(VesselWall, CanBeASolidThatCarriesItsSurface) {
    const VesselWall wall = plaque_wall();
    Solid solid{.particles = {},
                .materials = {{1080, NeoHookean::from(elastic_moduli({1e6, 0.45, {}, {}}))}},
                .constraints = {}};
    place_particles(solid, wall.places, wall.volume);
    SolidSurface surface(wall.surface, solid.particles, 2 * 1.15 * spacing, false);
    // Any linear motion of the particles moves the surface exactly so.
    const Mat3 F{{1.1, 0.2, 0}, {0, 0.9, -0.1}, {0.05, 0, 1.2}};
    for (std::size_t i = 0; i < solid.particles.size(); ++i)
        solid.particles.position[i] = F * solid.particles.reference[i];
    surface.follow(solid.particles);
    for (std::size_t v = 0; v < surface.size(); ++v)
        ASSERT_LT(norm(surface.position[v] - F * wall.surface.vertices[v]), 1e-12);
}

TEST(VesselWall, NeedsThreeParticlesThroughIt) {
    Centreline line{"outlet"};
    for (int k = 0; k <= 40; ++k) line.points.push_back({{0.5e-3 * k, 0, 0}, {1, 0, 0}, R, 0.5e-3 * k});
    const BranchedLines lines = find_branches({line});
    const WallField field(lines, {std::vector<double>(41, 2 * R)}, {{-1, 0, 0}, {1, 0, 0}}, round_tube(R),
                          {.thickness = 0.4e-3, .line = 0, .from = 9e-3, .to = 11e-3});
    EXPECT_THROW(make_vessel_wall(field, 0.2e-3, 0), GeometryError);
}

}   // namespace
}   // namespace patency
