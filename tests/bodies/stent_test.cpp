// SPDX-License-Identifier: Apache-2.0
// Particles of a stent: in the metal, four across, evenly dense, with its volume.
#include "patency/bodies/stent.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/stent_library.h"

namespace patency {
namespace {

StentPattern short_stent() {   // two rings of the paper's, an open cell between them
    StentPattern p = find_stent("paper").pattern;
    p.rings = 2, p.length = 2.4e-3;
    return p;
}

TEST(StentParticles, FillTheMetalEvenly) {
    const StrutCurves curves = make_strut_curves(short_stent());
    const double spacing = largest_stent_spacing(curves);
    EXPECT_NEAR(spacing, 25e-6, 1e-15);
    StentParticles particles;
    make_stent_particles(curves, {}, spacing, particles);
    const double volume = measure_stent(curves).volume;
    double sum = 0;
    const SignedDistance metal = make_stent_metal(curves);
    double deepest_outside = -1, nearest = 1;
    std::vector<std::vector<Vec3>> layers(4);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const Vec3 x = particles.position[i];
        sum += particles.volume[i];
        EXPECT_NEAR(particles.volume[i], volume / double(particles.size()), 0.05 * particles.volume[i]);
        deepest_outside = std::max(deepest_outside, metal.value(x));
        const double layer = (std::hypot(x.y, x.z) - 0.9e-3) / spacing - 0.5;   // 0, 1, 2, 3
        ASSERT_NEAR(layer, std::round(layer), 1e-9);
        layers[std::size_t(std::lround(layer))].push_back(x);
    }
    EXPECT_NEAR(sum, volume, 1e-9 * volume);
    EXPECT_LT(deepest_outside, -0.4 * spacing);   // half a spacing is the rule
    for (const auto& layer : layers) EXPECT_EQ(layer.size(), particles.size() / 4);
    // No two particles of a layer coincide.
    auto& layer = layers[1];
    std::sort(layer.begin(), layer.end(), [](const Vec3& a, const Vec3& b) { return a.x < b.x; });
    for (std::size_t i = 0; i < layer.size(); ++i)
        for (std::size_t j = i + 1; j < layer.size() && layer[j].x - layer[i].x < spacing; ++j)
            nearest = std::min(nearest, norm(layer[j] - layer[i]));
    EXPECT_GT(nearest, 0.7 * spacing);
}

// Four across: along straight struts, the particles' distances from the edge come in two rows on either side.
TEST(StentParticles, AreFourAcrossAStrut) {
    StentPattern p = short_stent();
    p.rings = 1, p.connectors = 0, p.crowns = 4, p.length = 2e-3;
    p.crown_radius = M_PI * (p.diameter - p.strut_thickness) / 16;   // struts along the axis
    p.nominal_diameter = 2.1e-3;
    const StrutCurves curves = make_strut_curves(p);
    const StrutMap map(curves);
    StentParticles particles;
    make_stent_particles(curves, {}, 25e-6, particles);
    int outer = 0, inner = 0, between = 0;
    for (const Vec3& x : particles.position) {
        if (std::abs(x.x) > 0.4e-3) continue;   // the straight parts
        const double depth = -map.value({curves.middle_radius * std::atan2(x.z, x.y), x.x}) / 25e-6;
        (depth < 0.8 ? outer : depth > 1.2 ? inner : between) += 1;
    }
    EXPECT_NEAR(double(outer) / double(inner), 1, 0.05);
    EXPECT_LT(between, 0.05 * outer);
}

TEST(StentParticles, BentOnesAreInTheBentMetal) {
    const StrutCurves curves = make_strut_curves(short_stent());
    std::vector<Vec3> line;
    for (int k = 0; k <= 100; ++k) line.push_back({5e-3 * std::sin(0.01 * k), 5e-3 * (1 - std::cos(0.01 * k)), 0});
    const StentAxis axis(line, 2.5e-3, 0, curves.length, outer_radius(curves));
    StentParticles bent, straight;
    make_stent_particles(curves, axis, 25e-6, bent);
    make_stent_particles(curves, {}, 25e-6, straight);
    ASSERT_EQ(bent.size(), straight.size());
    const SignedDistance metal = make_stent_metal(curves, axis);
    double sum = 0, smallest = 1, largest = 0;
    for (std::size_t i = 0; i < bent.size(); ++i) {
        ASSERT_LT(metal.value(bent.position[i]), -0.3 * 25e-6);
        sum += bent.volume[i];
        smallest = std::min(smallest, bent.volume[i]), largest = std::max(largest, bent.volume[i]);
    }
    EXPECT_NEAR(sum, measure_stent(curves).volume, 1e-9 * sum);
    EXPECT_NEAR(largest / smallest, (1 + 1 / 5.0) * 1.0 / (1 - 1 / 5.0), 0.1);   // curvature x radius = 1/5
}

TEST(StentParticles, OfAnyMetalHaveItsVolume) {
    StentPattern p = short_stent();
    p.rings = 1, p.connectors = 0, p.length = 1.2e-3;
    const StrutCurves curves = make_strut_curves(p);
    const double volume = measure_stent(curves).volume;
    StentParticles particles;
    make_stent_particles(make_stent_metal(curves), volume, 25e-6, particles);
    const SignedDistance metal = make_stent_metal(curves);
    double sum = 0;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        sum += particles.volume[i];
        outside += metal.value(particles.position[i]) > -0.2 * 25e-6;
    }
    EXPECT_NEAR(sum, volume, 1e-9 * volume);
    EXPECT_NEAR(double(particles.size()), volume / std::pow(25e-6, 3), 1);
    EXPECT_LT(double(outside), 0.005 * double(particles.size()));
}

TEST(StentParticles, AreTheSameBitsForAnyNumberOfThreads) {
    StentPattern p = short_stent();
    p.rings = 1, p.connectors = 0, p.length = 1.2e-3;
    const StrutCurves curves = make_strut_curves(p);
    const int threads = omp_get_max_threads();
    StentParticles one, three;
    omp_set_num_threads(1);
    make_stent_particles(curves, {}, 25e-6, one);
    omp_set_num_threads(3);
    make_stent_particles(curves, {}, 25e-6, three);
    omp_set_num_threads(threads);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i)
        ASSERT_TRUE(one.position[i] == three.position[i] && one.volume[i] == three.volume[i]);
}

TEST(StentParticles, TooFewAcrossAreRefused) {
    const StrutCurves curves = make_strut_curves(short_stent());
    StentParticles particles;
    EXPECT_THROW(make_stent_particles(curves, {}, 26e-6, particles), GeometryError);
    EXPECT_THROW(make_stent_particles(curves, {}, 0, particles), GeometryError);
}

}   // namespace
}   // namespace patency
