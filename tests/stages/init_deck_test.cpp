// SPDX-License-Identifier: Apache-2.0
// What init decides and writes: the deck is read back as it was meant, and its words and its forecast are those of the
// commands that come after it.
#include "patency/stages/init_deck.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/base/units.h"
#include "patency/config/deck.h"
#include "patency/io/surface_file.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/stages/bed.h"
#include "patency/stages/build.h"
#include "patency/stages/init_text.h"
#include "patency/stages/stent_of_case.h"
#include "patency/stages/stent_placement.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"
#include "tests/stages/vessels.h"

namespace patency {
namespace {

constexpr double mm = 1e-3;

const Surface& y_surface() {
    static const Surface surface = make_y_surface(0.5);
    return surface;
}
const Vessel& y() {
    static const Vessel vessel = followed(y_surface());
    return vessel;
}

InitSettings settings_of(double hours = 1, const std::filesystem::path& surface = "/v/y.vtp") {
    InitSettings settings{.geometry = {}, .name = "y", .budget = {3600 * hours, 8e9, 2}};
    settings.geometry.surface = surface;
    settings.geometry.unit = "mm";
    return settings;
}
const InitPlan& plan() {
    static const InitPlan made = plan_case(y(), settings_of());
    return made;
}

TEST(InitDeck, IsReadBackAsItWasDecided) {
    const deck::Case read = deck::parse_case(deck_text(y(), plan(), "/v"), "deck", "/v");
    EXPECT_EQ(deck::format_case(read), deck::format_case(plan().config));
    EXPECT_EQ(read, plan().config);
    EXPECT_EQ(*read.geometry.surface, "/v/y.vtp");
    EXPECT_TRUE(has(deck_text(y(), plan(), "/decks/mine"), "surface: \"../../v/y.vtp\""));
}

TEST(InitDeck, SameInputSameBytes) {
    EXPECT_EQ(deck_text(y(), plan_case(y(), settings_of()), "/v"), deck_text(y(), plan(), "/v"));
}

/// What turns the deck into the one of moving particles that it tells the price of.
deck::Settings moving_instead(const InitPlan& plan) {
    return {"numerics.scheme=sph", "numerics.across=null",
            "numerics.spacing=" + format_quantity(plan.moving_spacing, "mm")};
}

TEST(InitDeck, ItsForecastIsChecks) {
    const Surface severe =
        make_stenosed_tube(1.5 * mm, 30 * mm, 0.8);   // so narrow that the pressure binds, not the bed
    for (const Surface& surface : {y_surface(), severe}) {
        const ScratchFolder folder;
        write_surface(folder / "v.vtp", surface);
        const InitSettings settings = settings_of(0.02, folder / "v.vtp");
        deck::Case config;
        config.geometry = settings.geometry;
        const Vessel vessel = read_vessel(config);
        const InitPlan made = plan_case(vessel, settings);
        put(folder / "case.yaml", deck_text(vessel, made, folder.path()));
        EXPECT_EQ(plan_cells(deck::read_case(folder / "case.yaml"), 2).cells, made.cells.cells);
        const FlowPlan check = plan_flow(*build_frame(deck::read_case(folder / "case.yaml", moving_instead(made))), 2);
        EXPECT_EQ(check.seconds, made.price.seconds);
        EXPECT_EQ(check.sound_speed, made.price.sound_speed);
        EXPECT_EQ(check.fluid_particles, made.price.fluid_particles);
        EXPECT_EQ(check.acoustic_steps, made.price.acoustic_steps);
    }
}

TEST(InitDeck, MoreBudgetIsNeverCoarser) {
    double before = 1;
    for (double hours : {1e-6, 1e-3, 0.01, 0.1, 1.0, 10.0}) {
        const InitPlan made = plan_case(y(), settings_of(hours));
        EXPECT_LE(made.moving_spacing, before);
        EXPECT_EQ(made.is_within_budget(), made.budget_spacing <= made.moving_spacing) << hours;
        for (const SurfaceOpening& o : y().openings) EXPECT_GE(2 * o.opening.radius, 4 * made.moving_spacing);
        before = made.moving_spacing;
    }
    EXPECT_TRUE(plan().is_within_budget());
}

TEST(InitDeck, ACoronaryArteryIsHyperaemicAndSharedByMurray) {
    const deck::Case& c = plan().config;
    EXPECT_EQ(c.bed.state, deck::BedState::hyperaemic);
    EXPECT_FALSE(c.bed.flow);
    EXPECT_NEAR(*c.aorta.pressure, 93 * 133.322387415, 1e-6);
    EXPECT_EQ(c.openings.at("inlet").type, deck::OpeningType::pressure);
    EXPECT_EQ(c.openings.at("inlet").pressure, c.aorta.pressure);
    EXPECT_EQ(c.openings.at("inlet").ramp, 0);   // it starts from the estimate, which has the pressure
    EXPECT_TRUE(c.numerics.convergence);
    for (const char* name : {"outlet_1", "outlet_2"})
        EXPECT_EQ(c.openings.at(name).type, deck::OpeningType::resistance);
    EXPECT_NEAR(plan().bed_flow, flow_of_bed(deck::BedState::hyperaemic, y().openings[0].opening.area), 1e-15);
    // The comment's shares are those that check tunes to.
    const auto shares = murray_shares({2 * y().openings[1].opening.radius, 2 * y().openings[2].opening.radius}, 3);
    EXPECT_TRUE(has(deck_text(y(), plan(), "/v"),
                    fmt::format("{:.1f} %, {:.1f} mL/min", 100 * shares[0], 6e7 * shares[0] * plan().bed_flow)));
}

TEST(InitDeck, LargerVesselsRest) {
    EXPECT_EQ(inlet_default(3 * mm).state, deck::BedState::hyperaemic);
    for (double d : {1.0, 7.0, 15.0, 24.0}) EXPECT_EQ(inlet_default(d * mm).state, deck::BedState::resting);
    const auto flow = [](double d) {
        return 6e7 * inlet_default(d * mm).velocity * 0.25 * std::numbers::pi * d * d * mm * mm;
    };
    EXPECT_NEAR(flow(6.3), 415, 0.1 * 415);   // mL/min: the common carotid artery
    EXPECT_NEAR(flow(17), 900, 300);          // the aorta below the kidneys,
    EXPECT_NEAR(flow(23), 2300, 400);         // and above the coeliac artery
    const Vessel wide = followed(make_stenosed_tube(5 * mm, 40 * mm, 0));
    InitSettings settings = settings_of();
    const InitPlan made = plan_case(wide, settings);
    EXPECT_NEAR(*made.config.bed.flow, made.inlet->velocity * wide.openings[0].opening.area,
                0.05 * *made.config.bed.flow);
    EXPECT_NEAR(made.estimate.opening_flows[1], *made.config.bed.flow, 0.02 * *made.config.bed.flow);
    EXPECT_EQ(deck::parse_case(deck_text(wide, made, "/v"), "deck", "/v"), made.config);
}

TEST(InitDeck, SettlesWithItsSlowestModeOrWithTheBlood) {
    constexpr double radius = 1.5e-3;
    const auto settling = [](double length) {
        return plan_case(followed(make_stenosed_tube(radius, length, 0)), settings_of()).settling;
    };
    const double viscous = std::log(100.0) * radius * radius * 1060 / (2.404825557695773 * 2.404825557695773 * 3.5e-3);
    EXPECT_NEAR(settling(20 * mm), 2 * 20 * mm / hyperaemic_velocity, 0.02 * 2 * 20 * mm / hyperaemic_velocity);
    EXPECT_NEAR(settling(120 * mm), viscous, 0.02 * viscous);
}

TEST(InitDeck, MarksWhatIsUnderResolved) {
    const double throat = y().along->assessment.lesions.at(0).minimum_diameter;
    InitPlan coarse = plan();
    coarse.moving_spacing = throat / 6;
    std::string lines;
    for (const std::string& line : describe_plan(y(), coarse)) lines += line + "\n";
    EXPECT_TRUE(has(lines, "6.0 moving particles across  under-resolved")) << lines;
    coarse.moving_spacing = throat / 3;
    EXPECT_TRUE(has(deck_text(y(), coarse, "/v"), "3.0 moving particles across  not resolved"));
    coarse.moving_spacing = throat / 9;
    EXPECT_FALSE(has(deck_text(y(), coarse, "/v"), "moving particles across  under"));
    EXPECT_NEAR(plan().fine_spacing, throat / 8, 0.06 * throat / 8);
}

TEST(InitDeck, SaysWhatABudgetWouldHaveToCut) {
    EXPECT_TRUE(plan().cuts.empty());
    const InitPlan poor = plan_case(y(), settings_of(1e-5));
    ASSERT_EQ(poor.cuts.size(), 2u);
    EXPECT_FALSE(poor.is_within_budget());
    EXPECT_GT(poor.budget_spacing, poor.moving_spacing);
    for (const Cut& cut : poor.cuts) {
        const Centreline& line = y().along->lines.lines[cut.opening - 1];
        EXPECT_LT(cut.arc, cut.end_arc);
        EXPECT_GE(2 * point_at(line, cut.arc).radius, std::min(4 * poor.budget_spacing, 2 * line.points[0].radius));
    }
    EXPECT_TRUE(has(deck_text(y(), poor, "/v"), "would need outlet_2 cut back"));
    EXPECT_TRUE(has(deck_text(y(), poor, "/v"), "geometry.cut_back: {outlet_2: \""));
    for (const Cut& cut : poor.cuts) {
        EXPECT_GE(cut.cut_back, cut.end_arc - cut.arc);
        EXPECT_LE(cut.cut_back, 1.01 * (cut.end_arc - cut.arc));
    }
    // What is cut already, of a vessel as it is then, comes on top.
    InitSettings settings = settings_of(1e-5);
    settings.oblique_ends = {{.name = "outlet_2", .angle = 0.4, .cut_back = 1 * mm, .why_not = {}}};
    const InitPlan again = plan_case(y(), settings);
    ASSERT_EQ(again.cuts.size(), poor.cuts.size());
    for (std::size_t k = 0; k < poor.cuts.size(); ++k) {
        const bool is_cut = y().openings[poor.cuts[k].opening].opening.name == "outlet_2";
        EXPECT_NEAR(again.cuts[k].cut_back, poor.cuts[k].cut_back + (is_cut ? 1 * mm : 0), 0.1 * mm);
    }
}

TEST(InitDeck, ProposesAStentThatFitsTheHealthyLumen) {
    ASSERT_TRUE(plan().stent);
    const Lesion& lesion = y().along->assessment.lesions.at(0);
    const double misfit = std::abs(plan().stent->design->pattern.nominal_diameter - lesion.interpolated.diameter);
    for (const StentDesign& d : stent_library())
        EXPECT_GE(std::abs(d.pattern.nominal_diameter - lesion.interpolated.diameter), misfit);
    EXPECT_GT(plan().stent->pattern.length, lesion.length() + 3 * mm);   // half a ring may lack of 2 mm at both ends
    EXPECT_LT(plan().stent->pattern.length, lesion.length() + 5.5 * mm);
    // With its comment signs taken away it is a deck too.
    std::string text = deck_text(y(), plan(), "/v");
    for (const char* line :
         {"# stent:", "#   design:", "#   length:", "#   placement:", "# deployment:", "#   mode:"}) {
        const std::size_t at = text.find(std::string("\n") + line);
        ASSERT_NE(at, text.npos) << line;
        text.erase(at + 1, 2);
    }
    EXPECT_EQ(*deck::parse_case(text, "deck", "/v").stent->design, plan().stent->design->name);
    EXPECT_EQ(make_stent_pattern(*deck::parse_case(text, "deck", "/v").stent).rings, plan().stent->pattern.rings);
    EXPECT_FALSE(
        plan_case(followed(make_stenosed_tube(5 * mm, 60 * mm, 0.5)), settings_of()).stent);   // of 10 mm there is none
}

TEST(InitDeck, PutsTheStentIntoTheDeckIfAsked) {
    InitSettings settings = settings_of();
    settings.with_stent = true;
    const Vessel tight = followed(make_stenosed_tube(1.5 * mm, 60 * mm, 0.7));   // 0.9 mm: nothing crimped passes
    const std::string text = deck_text(tight, plan_case(tight, settings), "/v");
    const deck::Case config = deck::parse_case(text, "deck", "/v");
    ASSERT_TRUE(config.stent);
    EXPECT_EQ(config.deployment.mode, deck::DeploymentMode::geometric);
    EXPECT_TRUE(has(text, "#   predilation: "));
    EXPECT_NO_THROW(place_stent(config, tight));
    const Vessel wide = followed(make_stenosed_tube(1.5 * mm, 60 * mm, 0.3));
    EXPECT_FALSE(has(deck_text(wide, plan_case(wide, settings), "/v"), "predilation"));
    EXPECT_THROW(plan_case(followed(make_stenosed_tube(1.5 * mm, 60 * mm, 0)), settings), GeometryError);
}

TEST(InitDeck, OddNamesAreQuoted) {
    InitSettings settings = settings_of(1, "/v/a \"b\" #1: {x}.stl");
    settings.name = "two\nlines: # \"quoted\" \\ yes";
    const InitPlan made = plan_case(y(), settings);
    const deck::Case read = deck::parse_case(deck_text(y(), made, "/v"), "deck", "/v");
    EXPECT_EQ(read.about.name, settings.name);
    EXPECT_EQ(*read.geometry.surface, *settings.geometry.surface);

    Network network = make_y();
    network.tubes[2].end->name = "null";
    Vessel vessel = check_vessel(network);
    follow_vessel(vessel);
    vessel.along->lines.branches.back().name = "right\n# end";
    const InitPlan odd = plan_case(vessel, settings_of());
    const deck::Case again = deck::parse_case(deck_text(vessel, odd, "/v"), "deck", "/v");
    EXPECT_EQ(again, odd.config);
    EXPECT_TRUE(again.openings.contains("null"));
    vessel.openings[1].opening.name = "outlet: #1 \"left\"\n";   // no key of a deck
    EXPECT_THROW(plan_case(vessel, settings_of()), GeometryError);
}

TEST(InitDeck, AnotherInletIsAKeyOfTheDeck) {
    const ScratchFolder folder;
    write_surface(folder / "y.vtp", y_surface());
    InitSettings settings = settings_of(0.02, folder / "y.vtp");
    settings.geometry.inlet = "3";
    deck::Case config;
    config.geometry = settings.geometry;
    const Vessel vessel = read_vessel(config);
    EXPECT_NEAR(2 * vessel.openings[0].opening.radius, 2.2 * mm, 0.02 * mm);
    const InitPlan made = plan_case(vessel, settings);
    put(folder / "case.yaml", deck_text(vessel, made, folder.path()));
    const auto scene = build_frame(deck::read_case(folder / "case.yaml", moving_instead(made)));
    EXPECT_NEAR(2 * scene->lumen.openings[0].radius, 2.2 * mm, 0.02 * mm);
    EXPECT_EQ(scene->lumen.openings[0].name, "inlet");
    config.geometry.inlet = "4";
    EXPECT_THROW(read_vessel(config), DeckError);
}

}   // namespace
}   // namespace patency
