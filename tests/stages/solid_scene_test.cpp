// SPDX-License-Identifier: Apache-2.0
// Solids of a deck: materials of the table and of laws, holds, pressures, and the energies that account for each other.
#include "patency/stages/solid_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/shape/stent_library.h"
#include "patency/stages/solid_material.h"

using namespace patency;

namespace {

const std::string block = R"(version: 1
solids:
  - name: block
    shape: {type: box, from: [0 mm, 0 mm, 0 mm], to: [10 mm, 6 mm, 0 mm]}
    material: {law: neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
    holds: [{face: x_low}]
    pressures: [{face: x_high, times: [0 ms, 1 ms], pressures: [0 kPa, 20 kPa]}]
numerics: {spacing: 1 mm, duration: 3 ms, precision: double, solid: {plane_strain: true}}
)";

std::string with(std::string text, const std::string& part, const std::string& other) {
    return text.replace(text.find(part), part.size(), other);
}

}   // namespace

TEST(SolidMaterial, TableAndLawsGiveWhatTheySay) {
    for (const TableMaterial& m : material_table()) {
        deck::SolidMaterialChoice choice;
        choice.name = std::string(m.name);
        EXPECT_GT(make_solid_material(choice, "m").density, 0) << m.name;
        EXPECT_FALSE(m.source.empty());
    }
    deck::SolidMaterialChoice steel;
    steel.name = "316L", steel.young = 100e9, steel.poisson = 0.25;
    const SolidMaterial m = make_solid_material(steel, "m");
    EXPECT_NEAR(m.moduli().shear, 40e9, 1);
    // True stress at necking: 485 MPa x 1.4 at ln 1.4.
    EXPECT_NEAR(std::get<J2Plastic>(m.law).hardening.stress(std::log(1.4)), 679e6, 1);
}

TEST(SolidMaterial, EveryDesignOfTheLibraryIsOfAMetalOfTheTable) {
    for (const StentDesign& design : stent_library()) {
        deck::SolidMaterialChoice alloy;
        alloy.name = design.pattern.alloy;
        EXPECT_TRUE(std::holds_alternative<J2Plastic>(make_solid_material(alloy, "m").law))
            << design.name << ": by contact it could not be implanted";
    }
}

TEST(SolidMaterial, WhatIsMissingIsSaid) {
    const auto says = [](const deck::SolidMaterialChoice& c, const std::string& words) {
        try {
            make_solid_material(c, "solids.0.material");
            ADD_FAILURE() << "accepted";
        } catch (const DeckError& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    deck::SolidMaterialChoice c;
    c.name = "316";
    says(c, "Did you mean \"316L\"?");
    c = {};
    c.law = deck::SolidLawName::yeoh, c.density = 1000;
    says(c, "c1 is missing");
    c.law = deck::SolidLawName::neo_hookean, c.young = 1e6;
    says(c, "exactly two");
}

// A slice of the plaque of a lesion, opened fourfold by a balloon: perfect plasticity resists nothing but the change of shape of a
// neighbourhood, so what keeps single particles in their places is hourglass control.
TEST(SolidScene, ParticlesOfPlaqueThatFlowsKeepTheirPlaces) {
    const auto scene = build_solids(deck::parse_case(R"(version: 1
solids:
  - name: plaque
    shape: {type: cylinder, from: [0 mm, 0 mm, 0 mm], to: [0 mm, 0 mm, 0.6 mm], diameter: 2.8 mm, inner_diameter: 0.6 mm}
    material: {name: fibrous_plaque}
    holds: [{face: from, axes: [false, false, true]}, {face: to, axes: [false, false, true]}]
contacts:
  - solid: plaque
    tool: {type: balloon, from: [0 mm, 0 mm, -2 mm], to: [0 mm, 0 mm, 2 mm], times: [0 ms, 2 ms], diameters: [0.6 mm, 2.4 mm]}
    damping: 0.2
numerics: {spacing: 0.17 mm, duration: 2 ms}
)"));
    while (scene->time < 2e-3) step_solids(*scene, 2e-3);
    const SolidParticles& p = scene->part("plaque").body->particles();
    double least = INFINITY, most = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto radius = [](const Vec3& x) { return std::hypot(x.x, x.y); };
        if (radius(p.reference[i]) > 0.42e-3) continue;   // the innermost particles, all at one radius
        least = std::min(least, radius(p.position[i])), most = std::max(most, radius(p.position[i]));
    }
    ASSERT_GT(most, 0);
    EXPECT_LT(most - least, 0.17e-3) << least << " to " << most;
}

TEST(SolidScene, EnergyIsWorkAndHeldParticlesStay) {
    const auto scene = build_solids(deck::parse_case(block));
    while (scene->time < 3e-3) step_solids(*scene, 3e-3);
    SolidBody& body = *scene->part("block").body;
    const SolidEnergy e = body.energy();
    EXPECT_GT(e.load_work, 0);
    EXPECT_NEAR(e.kinetic + e.elastic + e.hourglass, e.load_work, 2e-3 * e.load_work);
    EXPECT_EQ(e.constraint_work, 0);
    std::size_t held = 0;
    for (std::size_t i = 0; i < body.particles().size(); ++i) {
        if (body.particles().constraint[i] == 0) continue;
        ++held;
        EXPECT_EQ(body.particles().position[i], body.particles().reference[i]);
    }
    EXPECT_EQ(held, 6u);
}

TEST(SolidScene, ComputedTwiceItIsTheSame) {
    const auto end_of = [](double until) {
        auto scene = build_solids(deck::parse_case(block));
        while (scene->time < until) step_solids(*scene, until);
        return scene;
    };
    const auto a = end_of(1e-3), b = end_of(1e-3);
    const auto &x = a->part("block").body->particles().position, &y = b->part("block").body->particles().position;
    EXPECT_TRUE(std::equal(x.begin(), x.end(), y.begin()));
    EXPECT_EQ(a->time, 1e-3);
}

TEST(SolidScene, WrongFacesAndEmptyHoldsAreSentences) {
    EXPECT_THROW(build_solids(deck::parse_case(with(block, "face: x_high", "face: inner"))), DeckError);
    EXPECT_THROW(
        build_solids(deck::parse_case(with(block, "{face: x_low}", "{low: [1 m, 1 m, 0 m], high: [2 m, 2 m, 1 m]}"))),
        DeckError);
    EXPECT_THROW(build_solids(deck::parse_case(
                     with(block, "law: neo_hookean", "law: fibre_artery, fibre_stiffness: 1 kPa, fibre_growth: 1"))),
                 DeckError);
}
