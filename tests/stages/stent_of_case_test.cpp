// SPDX-License-Identifier: Apache-2.0
// The deck's stent is the pattern it says, where it says.
#include "patency/stages/stent_of_case.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/stent_library.h"

namespace patency {
namespace {

TEST(StentOfCase, ADesignIsTheLibrarysWithTheDecksAlloy) {
    deck::Stent stent;
    stent.design = "closed_cell";
    EXPECT_EQ(make_stent_pattern(stent).rings, find_stent("closed_cell").pattern.rings);
    EXPECT_EQ(make_stent_pattern(stent).alloy, "316L");
    stent.alloy = "L605";
    EXPECT_EQ(make_stent_pattern(stent).alloy, "L605");
    stent.alloy = "tin";
    EXPECT_THROW(make_stent_pattern(stent), DeckError);
    stent = {};
    stent.surface = "a.stl";
    EXPECT_THROW(make_stent_pattern(stent), DeckError);
    stent.length = 10e-3;   // before the file is looked for
    EXPECT_THROW(make_stent(stent), DeckError);
}

TEST(StentOfCase, AMisspeltNameIsAMistakeOfTheDeck) {
    deck::Stent stent;
    stent.design = "open_cel";
    try {
        expect_known_names(stent);
        FAIL() << "no error";
    } catch (const DeckError& e) {
        EXPECT_EQ(std::string(e.what()).find("stent.design: "), 0u) << e.what();
        EXPECT_NE(std::string(e.what()).find("did you mean open_cell?"), std::string::npos) << e.what();
    }
    stent.design = "open_cell";
    expect_known_names(stent);
    stent.alloy = "tin";
    EXPECT_THROW(expect_known_names(stent), DeckError);
}

// The library's design, key by key, makes the same struts.
TEST(StentOfCase, APatternIsTheDecks) {
    const StentPattern p = find_stent("two_link").pattern;
    deck::Stent stent;
    stent.pattern = {.layout = deck::StentLayout::rings,
                     .rings = p.rings,
                     .crowns = p.crowns,
                     .length = p.length,
                     .diameter = p.diameter,
                     .crimped_diameter = p.crimped_diameter,
                     .nominal_diameter = p.nominal_diameter,
                     .strut_width = p.strut_width,
                     .strut_thickness = p.strut_thickness,
                     .crown_radius = p.crown_radius,
                     .gap = p.gap,
                     .connectors = p.connectors,
                     .connector_shift = p.connector_shift,
                     .connector_shape = deck::ConnectorShape::flex,
                     .facing = deck::CrownFacing::staggered,
                     .connector_width = {},
                     .connector_swing = p.connector_swing};
    const StrutCurves own = make_strut_curves(make_stent_pattern(stent)), library = make_strut_curves(p);
    ASSERT_EQ(own.struts.size(), library.struts.size());
    for (std::size_t k = 0; k < own.struts.size(); ++k)
        EXPECT_EQ(own.struts[k].points.back().along, library.struts[k].points.back().along);
}

TEST(StentOfCase, PlacementsByTranslationAndAlongALineAgree) {
    const StentPattern& pattern = find_stent("paper").pattern;
    const std::vector<Vec3> line{{0, 0, 0}, {0, 10e-3, 0}, {0, 30e-3, 0}};
    deck::StentPlacement along, by_translation;
    along.arc_length = 12e-3, along.rotation = 0.7;
    by_translation.translation = Vec3{0, 12e-3, 0}, by_translation.direction = {0, 5, 0}, by_translation.rotation = 0.7;
    const StentAxis a = make_stent_axis(along, pattern, line), b = make_stent_axis(by_translation, pattern);
    for (const StentPoint& p : {StentPoint{1e-3, 0.3, 2e-3}, StentPoint{0.5e-3, -2, -4e-3}})
        EXPECT_LT(norm(a.place(p) - b.place(p)), 1e-15);
    EXPECT_THROW(make_stent_axis(along, pattern), DeckError);
}

}   // namespace
}   // namespace patency
