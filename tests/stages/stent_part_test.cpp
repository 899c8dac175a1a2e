// SPDX-License-Identifier: Apache-2.0
// A stent as a solid: its mass, its faces, and that no particle sees another strut across a gap.
#include "patency/stages/stent_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "patency/base/errors.h"
#include "patency/bodies/stent.h"
#include "patency/bodies/stent_skin.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/stent_form.h"
#include "patency/shape/stent_metal.h"

using namespace patency;

namespace {

constexpr double um = 1e-6, mm = 1e-3;

StentPattern ring() {
    return {.layout = StentLayout::rings,
            .rings = 1,
            .crowns = 6,
            .length = 1.075 * mm,
            .diameter = 2 * mm,
            .crimped_diameter = 1.2 * mm,
            .nominal_diameter = 3.3 * mm,
            .strut_width = 100 * um,
            .strut_thickness = 100 * um,
            .crown_radius = 150 * um,
            .gap = 200 * um,
            .connectors = 3,
            .edge_radius = 5 * um,
            .alloy = "316L"};
}

SolidMaterial steel() {
    return {8000, J2Plastic{elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}}),
                            {.yield = 172e6, .slope = 1e9, .saturation = 0, .rate = 0}}};
}

SolidNumerics numerics(double spacing) {
    SolidNumerics n;
    n.spacing = spacing;
    return n;
}

}   // namespace

TEST(StentPart, HasTheMassOfItsMetalAndTheScaling) {
    const StrutCurves curves = make_strut_curves(ring());
    const auto part = make_stent_part("stent", curves, StentAxis(), steel(), numerics(25 * um), 50);
    double mass = 0;
    for (const double m : part->body->particles().mass) mass += m;
    EXPECT_NEAR(mass, 50 * 8000 * measure_stent(curves).volume, 1e-9 * mass);
    EXPECT_EQ(part->mass_scaling, 50);
    const auto light = make_stent_part("stent", curves, StentAxis(), steel(), numerics(25 * um));
    EXPECT_NEAR(part->body->stable_step(), std::sqrt(50.0) * light->body->stable_step(),
                1e-9 * part->body->stable_step());
}

TEST(StentPart, ItsFacesAreClosedAndLookWhereTheyShould) {
    const StrutCurves curves = make_strut_curves(ring());
    const auto part = make_stent_part("stent", curves, StentAxis(), steel(), numerics(25 * um));
    part->surface->follow(part->body->particles());
    const SurfaceElements& mesh = part->surface->mesh();
    Vec3 closed{};
    double area[3] = {}, turned[3] = {}, volume = 0;   // and its part along the radius
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        const auto& [a, b, c] = mesh.elements[e];
        const Vec3 &p = part->surface->position[a], &q = part->surface->position[b], &r = part->surface->position[c];
        const Vec3 A = 0.5 * cross(q - p, r - p), middle = (p + q + r) / 3.0;
        closed += A, volume += dot(A, middle) / 3;
        area[mesh.face[e]] += norm(A), turned[mesh.face[e]] += dot(A, normalized(Vec3{0, middle.y, middle.z}));
    }
    EXPECT_LT(norm(closed), 1e-12 * area[0]);
    EXPECT_NEAR(volume, measure_stent(curves).volume, 0.01 * volume);
    EXPECT_GT(turned[stent_outer], 0.99 * area[stent_outer]);
    EXPECT_LT(turned[stent_inner], -0.99 * area[stent_inner]);
    EXPECT_LT(std::abs(turned[stent_side]), 0.02 * area[stent_side]);
    EXPECT_NEAR(area[stent_outer] / area[stent_inner], 1.0 / 0.9, 0.01) << "as the radii";
}

TEST(StentPart, MeasuresAreThoseOfItsPattern) {
    const auto part = make_stent_part("stent", make_strut_curves(ring()), StentAxis(), steel(), numerics(25 * um));
    part->surface->follow(part->body->particles());
    const StentShape shape = measure_stent_shape(*part, StentAxis());
    EXPECT_NEAR(shape.outer_diameter, 2 * mm, 0.002 * mm);
    EXPECT_NEAR(shape.length, 1.075 * mm, 0.01 * mm);
    EXPECT_NEAR(shape.least_diameter, shape.largest_diameter, 0.002 * mm);
}

TEST(StentPart, StrutsDoNotPullEachOtherAcrossAGap) {
    // A fork of two prongs with 25 um between them: their particles lie within each other's reach of 57 um.
    const auto strut = [](FlatPoint from, FlatPoint to) { return Strut{{from, to}, 50 * um}; };
    const double apart = 125 * um, half = 0.5 * mm;
    const StrutCurves fork{.middle_radius = 1 * mm,
                           .thickness = 100 * um,
                           .edge_radius = 0,
                           .length = 1.1 * mm,
                           .cells = -1,
                           .struts = {strut({0, -half}, {0, half}), strut({apart, -half}, {apart, half}),
                                      strut({0, -half}, {apart, -half})}};
    const auto part = make_stent_part("stent", fork, StentAxis(), steel(), numerics(25 * um));
    SolidParticles& p = part->body->particles();
    const double middle = 0.5 * apart / fork.middle_radius, bent = -0.3 * mm;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < p.size(); ++i)   // the end of one prong goes 10 um ahead as it is
        if (p.reference[i].x > bent && StentAxis().coordinates(p.reference[i]).angle > middle)
            p.position[i] = p.reference[i] + Vec3{10 * um, 0, 0}, ++moved;
    ASSERT_GT(moved, p.size() / 4);
    part->body->compute_deformation();
    double worst = 0, at_the_bend = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Mat3 H = part->body->deformation(i) - identity<double>();
        double& here = p.reference[i].x > bent + 100 * um ? worst : at_the_bend;
        here = std::max(here, std::sqrt(double_dot(H, H)));
    }
    EXPECT_LT(worst, 1e-10);
    EXPECT_GT(at_the_bend, 0.1);
}

// The ring as a pattern, and the same metal as a file would bring it, along a bent axis.
TEST(StentPart, OfASurfaceIsAsOfThePatternThatItWasMadeFrom) {
    const StrutCurves curves = make_strut_curves(ring());
    const ImportedStent imported = recognise_stent(
        make_stent_surface(curves, StentAxis(motion_along({0, 0.6, 0.8}, {3 * mm, -1 * mm, 0})), 20 * um));
    EXPECT_NEAR(least_strut(imported), 100 * um, 10 * um) << "of thickness and width";
    std::vector<Vec3> arc;
    for (int k = -20; k <= 20; ++k) arc.push_back(10 * mm * Vec3{std::sin(0.02 * k), 1 - std::cos(0.02 * k), 0});
    const StentAxis axis(arc, 4 * mm, 0, 1.1 * mm, 1 * mm);
    const auto part = make_stent_part("stent", imported, axis, steel(), numerics(25 * um)),
               own = make_stent_part("stent", curves, axis, steel(), numerics(25 * um));
    const auto mass_of = [](const SolidPart& p) {
        double mass = 0;
        for (const double m : p.body->particles().mass) mass += m;
        return mass;
    };
    EXPECT_NEAR(mass_of(*part), mass_of(*own), 0.005 * mass_of(*own));
    EXPECT_NEAR(double(part->body->particles().size()), double(own->body->particles().size()),
                0.05 * double(own->body->particles().size()));
    const auto faces_of = [](SolidPart& p) {
        p.surface->follow(p.body->particles());
        std::array<double, 4> areas{};   // of the faces, and the volume
        const SurfaceElements& mesh = p.surface->mesh();
        for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
            const Vec3 &a = p.surface->position[mesh.elements[e][0]], &b = p.surface->position[mesh.elements[e][1]],
                       &c = p.surface->position[mesh.elements[e][2]];
            areas[mesh.face[e]] += 0.5 * norm(cross(b - a, c - a));
            areas[3] += dot(a, cross(b, c)) / 6;
        }
        return areas;
    };
    const auto got = faces_of(*part), wanted = faces_of(*own);
    EXPECT_NEAR(got[3], wanted[3], 0.05 * wanted[3]) << "edges are cut";
    for (const std::size_t face : {stent_outer, stent_inner, stent_side})
        EXPECT_NEAR(got[face], wanted[face], 0.1 * wanted[face]) << face;
    const StentShape shape = measure_stent_shape(*part, axis), same = measure_stent_shape(*own, axis);
    EXPECT_NEAR(shape.outer_diameter, same.outer_diameter, 0.005 * same.outer_diameter);
    EXPECT_NEAR(shape.length, same.length, 0.01 * same.length);
}

TEST(StentPart, OfASurfaceTooCoarseIsRefused) {
    const ImportedStent imported = recognise_stent(make_stent_surface(make_strut_curves(ring()), StentAxis(), 20 * um));
    EXPECT_THROW(make_stent_part("stent", imported, StentAxis(), steel(), numerics(35 * um)), GeometryError);
}

// Particles relaxed in space bear the step of layers.
TEST(StentPart, OfASurfaceKeepsItsEnergyAtTheStepOfItsPattern) {
    const StrutCurves curves = make_strut_curves(ring());
    const ImportedStent imported = recognise_stent(make_stent_surface(curves, StentAxis(), 20 * um));
    SolidMaterial elastic = steel();
    elastic.law = StVenantKirchhoff::from(elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}}));
    SolidSystem system;
    system.parts.push_back(make_stent_part("stent", imported, StentAxis(), elastic, numerics(25 * um)));
    SolidBody& body = *system.parts[0]->body;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (Vec3& v : body.particles().velocity) v = 0.1 * Vec3{unit(random), unit(random), unit(random)};
    const double dt = stable_step(system);
    EXPECT_EQ(dt, make_stent_part("stent", curves, StentAxis(), elastic, numerics(25 * um))->body->stable_step());
    double least = INFINITY, most = 0;
    for (int k = 0; k < 300; ++k) {
        solid_step(system, k * dt, dt);
        if (k % 20 != 19) continue;
        const SolidEnergy e = body.energy();
        least = std::min(least, e.kinetic + e.internal()), most = std::max(most, e.kinetic + e.internal());
    }
    EXPECT_LT(most, 1.1 * least);
}
