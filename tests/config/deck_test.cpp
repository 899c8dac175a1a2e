// SPDX-License-Identifier: Apache-2.0
// Valid decks: what is read, and that writing and reading are inverse.
#include "patency/config/deck.h"

#include <cmath>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <algorithm>

#include "patency/base/errors.h"
#include "tests/config/decks.h"

namespace patency::deck {
namespace {

TEST(Deck, ValuesAreInSIAndTheRestHasDefaults) {
    const Case c = parse_case(pipe_deck);
    EXPECT_EQ(c.about.name, "pipe");
    ASSERT_TRUE(c.geometry.shape);
    EXPECT_EQ(c.geometry.shape->type, ShapeType::tube);
    EXPECT_DOUBLE_EQ(c.geometry.shape->diameter, 0.003);
    EXPECT_EQ(c.geometry.shape->axis, (Vec3{1, 0, 0}));
    EXPECT_DOUBLE_EQ(c.blood.viscosity, 0.0035);
    EXPECT_EQ(c.openings.at("inlet").type, OpeningType::velocity);
    EXPECT_DOUBLE_EQ(*c.openings.at("inlet").velocity, 0.1);
    EXPECT_DOUBLE_EQ(*c.openings.at("outlet").pressure, 0);
    EXPECT_DOUBLE_EQ(c.numerics.spacing, 0.0002);
    EXPECT_DOUBLE_EQ(c.numerics.smoothing_ratio, 1.3);
    EXPECT_FALSE(c.numerics.sound_speed);
    EXPECT_EQ(c.output.fields, (std::vector<std::string>{"velocity", "pressure"}));
}

TEST(Deck, AWaveformHasTheDimensionOfItsOpening) {
    const Case c = parse_case(valid_decks[1]);
    const Fourier& flow = *c.openings.at("inlet").waveform->fourier;
    EXPECT_DOUBLE_EQ(flow.mean, 1e-6);
    EXPECT_DOUBLE_EQ(flow.sines[0], 1e-6);
    EXPECT_DOUBLE_EQ(flow.sines[1], 3e-9);
    EXPECT_DOUBLE_EQ(c.openings.at("side").waveform->values[1], 0.2);
}

TEST(Deck, AStentHasItsMeasuresAndItsPlace) {
    const Stent named = *parse_case(valid_decks[1]).stent;
    EXPECT_EQ(named.design, "open_cell");
    EXPECT_EQ(named.placement->branch, "left");
    EXPECT_DOUBLE_EQ(*named.placement->arc_length, 14.2e-3);
    EXPECT_NEAR(named.placement->rotation, 3.14159265358979 / 6, 1e-14);
    const auto deck_of_own = std::find_if(std::begin(valid_decks), std::end(valid_decks),
                                          [](const std::string& d) { return d.find("pattern:") != d.npos; });
    ASSERT_NE(deck_of_own, std::end(valid_decks));
    const Stent own = *parse_case(*deck_of_own).stent;
    EXPECT_EQ(own.pattern->crowns, 6);
    EXPECT_EQ(own.pattern->connector_shape, ConnectorShape::flex);
    EXPECT_DOUBLE_EQ(own.pattern->strut_thickness, 1e-4);
    EXPECT_EQ(own.placement->direction, (Vec3{0, 1, 1}));
    EXPECT_FALSE(parse_case(pipe_deck).stent);
}

TEST(Deck, SolidsStandWithoutAFlow) {
    const Case c = parse_case(solid_deck);
    ASSERT_EQ(c.solids.size(), 2u);
    EXPECT_EQ(c.solids[0].shape.type, SolidShapeType::cylinder);
    EXPECT_DOUBLE_EQ(c.solids[0].shape.inner_diameter, 3e-3);
    EXPECT_NEAR(*c.solids[0].material.fibre_angle, 40 * 3.14159265358979 / 180, 1e-14);
    EXPECT_EQ(c.solids[0].holds[0].axes, (std::array<bool, 3>{false, false, true}));
    EXPECT_NEAR(c.solids[0].pressures[0].pressures[1], 13332.24, 0.01);
    EXPECT_EQ(c.solids[1].material.name, "316L");
    EXPECT_DOUBLE_EQ(c.contacts[0].friction, 0.1);
    EXPECT_EQ(c.contacts[1].plane->normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(c.numerics.solid.relaxation, Relaxation::adaptive);
}

TEST(Deck, WhatIsWrittenReadsBackToTheIdenticalCase) {
    for (const std::string& deck : valid_decks) {
        const Case c = parse_case(deck, "deck", "/decks/a");
        const std::string resolved = format_case(c, "/decks/b/out");
        EXPECT_TRUE(parse_case(resolved, "resolved", "/decks/b/out") == c) << resolved;
        EXPECT_EQ(format_case(parse_case(resolved, "resolved", "/decks/b/out"), "/decks/b/out"), resolved);
    }
}

// Property: numbers of any size and digits survive the trip through the units that are written.
TEST(Deck, AnyNumberReadsBackToTheSameBits) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> exponent(-6, -1), fraction(0, 1);
    Case c = parse_case(valid_decks[1], "deck", "/");
    const auto any = [&] { return std::pow(10.0, exponent(random)) * (1 + fraction(random)); };
    for (int i = 0; i < 300; ++i) {
        c.blood.mu_inf = any();
        c.blood.mu_0 = c.blood.mu_inf + any();
        c.numerics.spacing = any();
        c.openings.at("inlet").waveform->fourier->cosines = {any(), -any()};
        c.openings.at("c").compliance = any() * 1e-3;
        c.openings.at("c").proximal_resistance = any() * 1e12;
        c.aorta.pressure = any() * 1e5;
        c.output.probes[0].point = {any(), -any(), any()};
        const std::string resolved = format_case(c, "/");
        ASSERT_TRUE(parse_case(resolved, "resolved", "/") == c) << resolved;
    }
}

TEST(Deck, PathsAreRelativeToTheDeck) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "patency_deck_paths";
    std::filesystem::create_directories(folder / "out");
    std::ofstream(folder / "case.yaml") << valid_decks[1];
    const Case c = read_case(folder / "case.yaml");
    EXPECT_EQ(*c.geometry.surface, folder / "lumen.stl");
    EXPECT_EQ(*c.openings.at("a").waveform->file, folder / "waves/p.csv");
    write_case(c, folder / "out" / "case.resolved.yaml");
    EXPECT_TRUE(read_case(folder / "out" / "case.resolved.yaml") == c);
    std::filesystem::remove_all(folder);
}

TEST(Deck, SettingsGoOverTheFile) {
    const Case c = parse_case(pipe_deck, "deck", "",
                              {"numerics.spacing=0.1 mm", "numerics.threads=3",
                               "openings.outlet={type: rcr, proximal_resistance: 1 Wood, "
                               "distal_resistance: 9 Wood, compliance: 1 mL/mmHg}",
                               "output.fields=[density]"});
    EXPECT_DOUBLE_EQ(c.numerics.spacing, 1e-4);
    EXPECT_EQ(c.numerics.threads, 3);
    EXPECT_EQ(c.openings.at("outlet").type, OpeningType::rcr);
    EXPECT_EQ(c.output.fields, std::vector<std::string>{"density"});
}

TEST(Deck, ASettingOfNullTakesAKeyAway) {
    const Settings cells{"numerics.spacing=null", "numerics.across=16"};
    const Case c = parse_case(pipe_deck, "deck", "", cells);
    EXPECT_EQ(c.numerics.spacing, 0);
    EXPECT_EQ(c.numerics.across, 16);
    EXPECT_EQ(parse_case(format_case(c)), c);   // with one of the two only
    EXPECT_EQ(parse_case(pipe_deck, "deck", "", {"numerics.across=null"}), parse_case(pipe_deck));   // was not there
}

TEST(Deck, FlowInAStillVesselIsSolvedOnCellsUnlessItSaysOtherwise) {
    Case c = parse_case(pipe_deck);
    EXPECT_EQ(c.scheme(), SchemeName::sph);   // a shape
    c.geometry.shape.reset();
    c.geometry.network = "tube.json";
    c.about.mode = Mode::steady;
    EXPECT_EQ(c.scheme(), SchemeName::cells);
    c.about.mode = Mode::periodic;
    EXPECT_EQ(c.scheme(), SchemeName::cells);
    c.about.mode = Mode::steady, c.wall.motion = WallMotion::deformable;
    EXPECT_EQ(c.scheme(), SchemeName::sph);
    c.wall.motion = WallMotion::rigid, c.numerics.scheme = SchemeName::paper;
    EXPECT_EQ(c.scheme(), SchemeName::paper);
}

TEST(Deck, TheMusclesPressureIsAPressureAndComesBackFromText) {
    const Case c =
        parse_case(pipe_deck, "deck", "",
                   {"openings.outlet={type: coronary, proximal_resistance: 1 Wood, microvascular_resistance: 3 Wood, "
                    "distal_resistance: 1 Wood, compliance: 1e-3 mL/mmHg, myocardial_compliance: 1e-2 mL/mmHg, "
                    "myocardial_pressure: {times: [0 s, 0.3 s], values: [0 mmHg, 100 mmHg], period: 0.8 s}}"});
    EXPECT_NEAR(c.openings.at("outlet").myocardial_pressure->values[1], 13332.2387415, 1e-6);
    EXPECT_EQ(parse_case(format_case(c)), c);
    EXPECT_THROW(
        parse_case(pipe_deck, "deck", "",
                   {"openings.outlet={type: coronary, proximal_resistance: 1 Wood, microvascular_resistance: 3 Wood, "
                    "distal_resistance: 1 Wood, compliance: 1e-3 mL/mmHg, myocardial_compliance: 1e-2 mL/mmHg, "
                    "myocardial_pressure: {times: [0 s, 0.3 s], values: [0 mL/s, 100 mL/s]}}"}),
        DeckError);
}

TEST(Deck, SettingsReachItemsOfLists) {
    const Case c = parse_case(valid_decks[4], "deck", "", {"geometry.shape.sections.1.diameter=5 mm"});
    EXPECT_DOUBLE_EQ(c.geometry.shape->sections[1].diameter, 0.005);
}

TEST(Deck, ALesionNarrowsABranchOfANetwork) {
    const Case c = parse_case(valid_decks.back(), "deck", "/decks");
    EXPECT_EQ(*c.geometry.network, "/decks/tree.json");
    EXPECT_EQ(c.geometry.lesion->branch, "lad");
    EXPECT_DOUBLE_EQ(c.geometry.lesion->position, 0.023);
    EXPECT_DOUBLE_EQ(c.geometry.lesion->length, 0.01);
    EXPECT_DOUBLE_EQ(c.geometry.lesion->diameter_stenosis_percent, 39.4);
    EXPECT_DOUBLE_EQ(c.geometry.lesion->eccentricity, 0.5);
    EXPECT_EQ(*c.geometry.lesion->side, (Vec3{0, 0, 1}));
}

TEST(Runs, AreTheDeckWithWhatTheySet) {
    const auto runs = parse_runs(valid_decks[2]);
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_EQ(runs[0].name, "d12");
    EXPECT_DOUBLE_EQ(runs[0].resolved.numerics.spacing, 1e-3 / 12);
    EXPECT_EQ(runs[0].resolved.scheme(), SchemeName::sph);
    EXPECT_EQ(runs[1].resolved.scheme(), SchemeName::paper);
    EXPECT_DOUBLE_EQ(runs[1].resolved.geometry.shape->gap, 0.002);
    EXPECT_TRUE(runs[1].resolved.runs.empty());
    EXPECT_EQ(parse_case(valid_decks[2]).runs.size(), 2u);
}

TEST(Runs, ADeckWithoutRunsIsOneUnderItsName) {
    const auto runs = parse_runs(pipe_deck);
    ASSERT_EQ(runs.size(), 1u);
    EXPECT_EQ(runs[0].name, "pipe");
    EXPECT_TRUE(runs[0].resolved == parse_case(pipe_deck));
}

TEST(Runs, SettingsGoOverRuns) {
    for (const NamedCase& run : parse_runs(valid_decks[2], "deck", "", {"numerics.spacing=0.05 mm"}))
        EXPECT_DOUBLE_EQ(run.resolved.numerics.spacing, 5e-5);
}

TEST(Runs, MayCompleteTheDeck) {
    const std::string deck =
        pipe_with("  spacing: \"0.2 mm\"\n", "") + "runs: [{name: a, set: {numerics.spacing: \"0.3 mm\"}}]\n";
    EXPECT_THROW(parse_case(deck), DeckError);
    EXPECT_DOUBLE_EQ(parse_runs(deck)[0].resolved.numerics.spacing, 3e-4);
}

TEST(Deck, AliasesAreFollowed) {
    const Case c = parse_case(pipe_with("pressure: \"0 mmHg\"",
                                        "pressure: \"0 mmHg\"\n  second: &o\n    type: resistance\n"
                                        "    resistance: \"1 Wood\"\n  third: *o"));
    EXPECT_TRUE(c.openings.at("third") == c.openings.at("second"));
}

}   // namespace
}   // namespace patency::deck
