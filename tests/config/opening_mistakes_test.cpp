// SPDX-License-Identifier: Apache-2.0
// Openings that are wrong: their names, which of a vessel's they are, and what is behind them.
#include "tests/config/mistakes.h"

#include <gtest/gtest.h>

#include <optional>

namespace patency::deck {
namespace {

TEST(Mistakes, MissingForAType) {
    EXPECT_EQ(mistakes_in(pipe_with(", length: \"15 mm\"", "")),
              only("4:10: geometry.shape.length is missing: the length along the axis, for example \"20 mm\""));
    EXPECT_EQ(mistakes_in(pipe_with("type: pressure\n    pressure: \"0 mmHg\"", "type: resistance")),
              only("13:5: openings.outlet: needs a resistance, or aorta.pressure, from which it is tuned to the bed"));
}

TEST(Mistakes, AnOutletHasAllOfItsNumbersOrNone) {
    const auto with = [](const std::string& outlet, const std::string& more = "") {
        return mistakes_in(pipe_with("type: pressure\n    pressure: \"0 mmHg\"", outlet) + more);
    };
    const std::string aorta = "aorta: {pressure: 93 mmHg}\n";
    EXPECT_EQ(with("type: rcr", aorta), "accepted");
    EXPECT_EQ(with("type: coronary", aorta), "accepted");
    EXPECT_EQ(with("type: pressure", aorta), "accepted");
    EXPECT_EQ(with("type: rcr"),
              only("13:5: openings.outlet: needs its resistances and compliances, or aorta.pressure, from "
                   "which it is tuned to the bed"));
    EXPECT_EQ(with("type: pressure"),
              only("13:5: openings.outlet: needs a pressure or a waveform, or aorta.pressure, which it has then"));
    EXPECT_EQ(
        with("type: rcr\n    distal_resistance: 1 Wood", aorta),
        only("13:5: openings.outlet: has not all of its numbers: compliance is missing; without any it is tuned to "
             "the bed"));
    EXPECT_EQ(with("type: coronary\n    compliance: 1 mL/mmHg\n    proximal_resistance: 1 Wood", aorta),
              only("13:5: openings.outlet: has not all of its numbers: distal_resistance, microvascular_resistance and "
                   "myocardial_compliance are missing; without any it is tuned to the bed"));
}

TEST(Mistakes, ABeatThatIsNoHearts) {
    const auto with = [](const std::string& period, const std::string& pulse, const std::string& outlet) {
        std::string deck = pipe_with("type: pressure\n    pressure: \"0 mmHg\"", outlet);
        deck.replace(deck.find("{name: pipe}"), 12, "{name: pipe, mode: periodic, period: " + period + "}");
        return mistakes_in(deck + "aorta: {pressure: 93 mmHg, pulse: " + pulse + "}\n");
    };
    for (const std::string outlet : {"type: pressure", "type: rcr", "type: coronary"}) {
        EXPECT_EQ(with("0.8 s", "40 mmHg", outlet), "accepted") << outlet;
        EXPECT_EQ(with("0.8 s", "93 mmHg", outlet), only("17:35: aorta.pulse: is not less than the mean, 93 mmHg"))
            << outlet;
        for (const std::string period : {"0.3 s", "5 s"})
            EXPECT_EQ(with(period, "40 mmHg", outlet),
                      only("2:44: case.period: is no heartbeat's, 0.33 to 2 s, whose pressures openings leave to the "
                           "aorta; give them their own"))
                << outlet;
    }
    // Of openings that have their own nobody asks a heart.
    EXPECT_EQ(with("5 s", "40 mmHg", "type: pressure\n    pressure: \"0 mmHg\""), "accepted");
}

TEST(Mistakes, OnlyASurfacesInletCanBeChosen) {
    const auto with = [](const std::string& geometry) {
        return mistakes_in(
            pipe_with("  shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}\n", "  " + geometry + "\n"));
    };
    EXPECT_EQ(with("surface: t.stl\n  unit: mm\n  inlet: outlet_2"), "accepted");
    EXPECT_EQ(with("surface: t.stl\n  unit: mm\n  inlett: outlet_2"),
              only("6:3: geometry.inlett: unknown key. Did you mean \"inlet\"?"));
    EXPECT_EQ(with("surface: t.stl\n  unit: mm\n  cut_back: {outlet_2: 2.7 mm}"), "accepted");
    EXPECT_EQ(with("surface: t.stl\n  unit: mm\n  cut_back: {outlet_2: 0 mm}"),
              only("6:24: geometry.cut_back.outlet_2: 0 mm is out of range: above 0 mm, at most 10000 mm"));
    EXPECT_EQ(with("surface: t.stl\n  unit: mm\n  cut_bck: {outlet_2: 1 mm}"),
              only("6:3: geometry.cut_bck: unknown key. Did you mean \"cut_back\"?"));
    EXPECT_EQ(
        with("network: t.json\n  cut_back: {outlet_2: 1 mm}"),
        only("5:13: geometry.cut_back: can cut a surface only; the ends of a network and of a shape are square to "
             "their axes"));
    EXPECT_EQ(with("network: t.json\n  label: 2"),
              only("5:10: geometry.label: is one of a label map, which is a surface here"));
    EXPECT_EQ(with("surface: t.nii\n  unit: mm\n  label: two").substr(0, 9), "case.yaml");
    EXPECT_EQ(with("network: t.json\n  inlet: outlet_2"),
              only("5:10: geometry.inlet: can be chosen of a surface only; a network and a shape say it themselves"));
}

TEST(Mistakes, OpeningsThatTheLumenDoesNotHave) {
    int asked = 0;
    const auto report = [&](const std::string& deck, std::vector<std::string> names) {
        try {
            parse_runs(deck, "case.yaml", {}, {}, [&](const Case&) {
                ++asked;
                return names.empty() ? std::nullopt : std::optional(names);
            });
        } catch (const DeckError& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    const std::vector<std::string> both{"inlet", "outlet"};
    EXPECT_EQ(report(pipe_deck, both), "accepted");
    EXPECT_EQ(
        report(pipe_with("  inlet:", "  inlett:"), both),
        only("9:3: openings.inlett: the lumen has no such opening. Did you mean \"inlet\"? It has inlet and outlet"));
    // With the deck's other mistakes, in its order; of an opening that is wrong inside too.
    const std::string more = report(
        pipe_with("viscosity: \"3.5 mPa s\"\nopenings:\n  inlet:\n    type: velocity\n    velocity: \"0.1 m/s\"",
                  "viscocity: \"3.5 mPa s\"\nopenings:\n  inlett:\n    type: velocity\n    velocity: \"0.1 mm\""),
        both);
    EXPECT_NE(more.find("7:3: blood.viscocity"), more.npos) << more;
    EXPECT_NE(more.find("9:3: openings.inlett: the lumen has no such opening"), more.npos) << more;
    EXPECT_NE(more.find("11:15: openings.inlett.velocity"), more.npos) << more;
    EXPECT_NE(report(pipe_deck, {"inlet", "outlet", "side"}).find("9:3: openings.side is missing: what happens"),
              std::string::npos);
    EXPECT_EQ(report(pipe_with("  inlet:", "  qqqqqqqqqqqq:"), {"inlet", "outlet", "side"}).find("Did you mean"),
              std::string::npos);
    EXPECT_EQ(report(pipe_with("  inlet:", "  inlett:"), {}), "accepted");   // nobody knows
    // Nobody is asked of a geometry that is wrong itself, nor of a surface without need.
    const auto with = [&](const std::string& geometry, const std::string& name) {
        std::string deck = pipe_with("  shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}", "  " + geometry);
        return report(deck.replace(deck.find("  outlet:"), 9, "  " + name + ":"), {"inlet", "outlet_1"});
    };
    asked = 0;
    EXPECT_EQ(with("shape: {type: tube, diameter: \"-3 mm\", length: \"15 mm\"}", "outlet").find("no such"),
              std::string::npos);
    EXPECT_EQ(with("surface: t.stl\n  unit: mm", "outlet_1"), "accepted");
    EXPECT_EQ(with("surface: t.stl\n  unit: mm\n  names: {outlet_1: left}", "left"), "accepted");
    EXPECT_EQ(asked, 0);
    EXPECT_NE(with("surface: t.stl\n  unit: mm", "outlet")
                  .find("13:3: openings.outlet: the lumen has no such opening. "
                        "Did you mean \"outlet_1\"?"),
              std::string::npos);
    EXPECT_NE(with("surface: t.stl\n  unit: mm", "outlet_9")
                  .find("13:3: openings.outlet_9: the lumen has no such opening. "
                        "Did you mean \"outlet_1\"?"),
              std::string::npos);
}

TEST(Mistakes, OpeningNameThatIsNoName) {
    EXPECT_EQ(mistakes_in(pipe_with("  outlet:", "  out let:")),
              only("12:3: openings: \"out let\" is no name; names have letters, digits, _ and -, at most 64"));
}

}   // namespace
}   // namespace patency::deck
