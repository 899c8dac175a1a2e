// SPDX-License-Identifier: Apache-2.0
// Solids by their measures: particles and surface fill the same space; and a surface that particles carry.
#include "patency/bodies/solid_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/bodies/solid_shape.h"

using namespace patency;
using std::numbers::pi;

namespace {

constexpr double spacing = 1e-3;
const Mat3 F{{1.3, 0.2, 0.1}, {-0.1, 0.8, 0.05}, {0.3, 0, 1.1}};
const Mat3 plane_F{{1.3, 0.2, 0}, {-0.1, 0.8, 0}, {0, 0, 1}};

struct Shape {
    const char* name;
    SolidFill fill;
    bool planar;
    double volume, area;   // planar: area, length
    double mesh_error;     // of a surface of triangles with sides of a spacing: they are chords
};

std::vector<Shape> shapes() {
    return {
        {"box", fill_box({0, 0, 0}, {5e-3, 4e-3, 3e-3}, spacing, false), false, 60e-9, 94e-6, 1e-12},
        {"rectangle", fill_box({0, 0, 0}, {5e-3, 4e-3, 3e-3}, spacing, true), true, 20e-6, 18e-3, 1e-12},
        {"cylinder", fill_cylinder({1e-3, 0, 0}, {1e-3, 2e-3, 6e-3}, 0, 4e-3, spacing, false), false,
         pi * 16e-6 * std::sqrt(40e-6), 2 * pi * 16e-6 + 2 * pi * 4e-3 * std::sqrt(40e-6), 0.015},
        {"tube", fill_cylinder({0, 0, 0}, {0, 0, 6e-3}, 3e-3, 6e-3, spacing, false), false, pi * 27e-6 * 6e-3,
         2 * pi * 27e-6 + 2 * pi * 9e-3 * 6e-3, 0.015},
        {"ring", fill_cylinder({0, 0, 7}, {0, 0, 7}, 3e-3, 6e-3, spacing, true), true, pi * 27e-6, 2 * pi * 9e-3, 0.01},
        {"sphere", fill_sphere({1e-3, 2e-3, 3e-3}, 5e-3, spacing), false, 4 * pi / 3 * 125e-9, 4 * pi * 25e-6, 0.02}};
}

void make_solid(const Shape& shape, Solid& solid) {
    solid.materials = {{1000, NeoHookean{1, 1}}};
    place_particles(solid, shape.fill.places, 0);
    for (std::size_t i = 0; i < solid.particles.size(); ++i) {
        solid.particles.volume[i] = shape.fill.volumes[i];
        solid.particles.mass[i] = 1000 * shape.fill.volumes[i];
    }
}

/// Area vectors and enclosed volume of a mesh.
Vec3 area_of(const SurfaceElements& m, std::size_t e, bool planar) {
    const auto& [a, b, c] = m.elements[e];
    const Vec3 ab = m.vertices[b] - m.vertices[a];
    return planar ? Vec3{ab.y, -ab.x, 0} : 0.5 * cross(ab, m.vertices[c] - m.vertices[a]);
}

}   // namespace

TEST(SolidShape, ParticlesFillTheVolumeAndTheSurfaceClosesAroundIt) {
    for (const Shape& s : shapes()) {
        double sum = 0, area = 0, enclosed = 0;
        for (const double v : s.fill.volumes) sum += v;
        EXPECT_NEAR(sum, s.volume, 1e-9 * s.volume) << s.name;
        Vec3 open{};
        for (std::size_t e = 0; e < s.fill.surface.elements.size(); ++e) {
            const Vec3 A = area_of(s.fill.surface, e, s.planar);
            const auto& t = s.fill.surface.elements[e];
            const Vec3 middle =
                s.planar
                    ? 0.5 * (s.fill.surface.vertices[t[0]] + s.fill.surface.vertices[t[1]])
                    : (s.fill.surface.vertices[t[0]] + s.fill.surface.vertices[t[1]] + s.fill.surface.vertices[t[2]]) /
                          3.0;
            open += A, area += norm(A);
            enclosed += dot(A, middle) / (s.planar ? 2 : 3);
        }
        EXPECT_LT(norm(open), 1e-12 * area) << s.name;
        EXPECT_NEAR(area, s.area, s.mesh_error * s.area) << s.name;
        EXPECT_NEAR(enclosed, s.volume, 2 * s.mesh_error * s.volume + 1e-12 * s.volume) << s.name << ": outward";
        EXPECT_EQ(s.fill.surface.face.size(), s.fill.surface.elements.size());
    }
}

TEST(SolidSurface, ALinearMotionCarriesItExactly) {
    for (const Shape& s : shapes()) {
        Solid solid;
        make_solid(s, solid);
        SolidSurface surface(s.fill.surface, solid.particles, 2.3 * spacing, s.planar);
        const Mat3& A = s.planar ? plane_F : F;
        for (std::size_t i = 0; i < solid.particles.size(); ++i) {
            solid.particles.position[i] = A * solid.particles.reference[i] + Vec3{1, 2, 0};
            solid.particles.velocity[i] = A * solid.particles.reference[i];
        }
        surface.follow(solid.particles);
        for (std::size_t v = 0; v < surface.size(); ++v) {
            EXPECT_LT(norm(surface.position[v] - (A * s.fill.surface.vertices[v] + Vec3{1, 2, 0})), 1e-12) << s.name;
            EXPECT_LT(norm(surface.velocity(v) - A * s.fill.surface.vertices[v]), 1e-12) << s.name;
        }
    }
}

TEST(SolidSurface, APushArrivesWithItsForceAndItsTorque) {
    for (const Shape& s : shapes()) {
        Solid solid;
        make_solid(s, solid);
        SolidSurface surface(s.fill.surface, solid.particles, 2.3 * spacing, s.planar);
        for (std::size_t i = 0; i < solid.particles.size(); ++i) {
            const Vec3& X = solid.particles.reference[i];
            solid.particles.position[i] = X + Vec3{1e-4 * std::sin(2000 * X.y), 2e-4 * std::cos(1000 * X.x), 0};
        }
        surface.follow(solid.particles);
        Vec3 force{}, torque{}, arrived{}, turned{};
        double size = 0;
        for (std::size_t v = 0; v < surface.size(); ++v) {
            surface.force[v] = {std::sin(double(v)), std::cos(3.0 * double(v)),
                                s.planar ? 0 : std::sin(2.0 * double(v))};
            force += surface.force[v], torque += cross(surface.position[v], surface.force[v]),
                size += norm(surface.force[v]);
        }
        surface.push(solid.particles);
        for (std::size_t i = 0; i < solid.particles.size(); ++i)
            arrived += solid.particles.load[i], turned += cross(solid.particles.position[i], solid.particles.load[i]);
        EXPECT_LT(norm(arrived - force), 1e-13 * size) << s.name;
        EXPECT_LT(norm(turned - torque), 1e-13 * size * 0.01) << s.name;
    }
}

TEST(SolidSurface, PressureActsOnTheDeformedArea) {
    const double p = 3e4;
    for (const Shape& s : shapes()) {
        if (s.fill.surface.faces.size() < 4) continue;
        Solid solid;
        make_solid(s, solid);
        SolidSurface surface(s.fill.surface, solid.particles, 2.3 * spacing, s.planar);
        const Mat3& A = s.planar ? plane_F : F;
        for (std::size_t i = 0; i < solid.particles.size(); ++i)
            solid.particles.position[i] = A * solid.particles.reference[i];
        for (std::uint16_t face = 0; face < s.fill.surface.faces.size(); ++face) {
            surface.follow(solid.particles);
            surface.add_pressure(face, p);
            Vec3 total{}, reference{};
            for (const Vec3& f : surface.force) total += f;
            for (std::size_t e = 0; e < s.fill.surface.elements.size(); ++e)
                if (s.fill.surface.face[e] == face) reference += area_of(s.fill.surface, e, s.planar);
            // Nanson: n da = J F^-T N dA.
            const Vec3 expected = -p * determinant(A) * (transpose(inverse(A)) * reference);
            EXPECT_LT(norm(total - expected), 1e-11 * p * s.area) << s.name << " " << s.fill.surface.faces[face];
        }
        // All around, it pushes nowhere.
        surface.follow(solid.particles);
        for (std::uint16_t face = 0; face < s.fill.surface.faces.size(); ++face) surface.add_pressure(face, p);
        Vec3 total{};
        for (const Vec3& f : surface.force) total += f;
        EXPECT_LT(norm(total), 1e-12 * p * s.area) << s.name;
    }
}

TEST(SolidSurface, ASharpCornerIsCarriedByWhatIsNearest) {
    const Shape box = shapes()[0];
    Solid solid;
    make_solid(box, solid);
    SurfaceElements sharp = box.fill.surface;
    const std::size_t corner =
        std::size_t(std::min_element(sharp.vertices.begin(), sharp.vertices.end(),
                                     [](const Vec3& a, const Vec3& b) { return norm(a) < norm(b); }) -
                    sharp.vertices.begin());
    sharp.vertices[corner] = -0.8 * spacing * Vec3{1, 1, 1};   // one particle lies within 2.3 spacings
    SolidSurface surface(sharp, solid.particles, 2.3 * spacing, false);
    for (std::size_t i = 0; i < solid.particles.size(); ++i)
        solid.particles.position[i] = F * solid.particles.reference[i];
    surface.follow(solid.particles);
    EXPECT_LT(norm(surface.position[corner] - F * sharp.vertices[corner]), 1e-12);
}

TEST(SolidSurface, AVertexWithoutParticlesIsASentence) {
    const Shape s = shapes()[0];
    Solid solid;
    make_solid(s, solid);
    SurfaceElements far = s.fill.surface;
    far.vertices[3] += Vec3{0.1, 0, 0};
    EXPECT_THROW(SolidSurface(far, solid.particles, 2.3 * spacing, false), GeometryError);
}
