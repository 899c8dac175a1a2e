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

std::string with(std::string text, const std::string& part, const std::string& other) { return text.replace(text.find(part), part.size(), other); }

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
        EXPECT_TRUE(std::holds_alternative<J2Plastic>(make_solid_material(alloy, "m").law)) << design.name << ": by contact it could not be implanted";
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
    EXPECT_THROW(build_solids(deck::parse_case(with(block, "{face: x_low}", "{low: [1 m, 1 m, 0 m], high: [2 m, 2 m, 1 m]}"))), DeckError);
    EXPECT_THROW(build_solids(deck::parse_case(with(block, "law: neo_hookean", "law: fibre_artery, fibre_stiffness: 1 kPa, fibre_growth: 1"))), DeckError);
}
