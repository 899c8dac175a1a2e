// SPDX-License-Identifier: Apache-2.0
// Decks that are wrong, one kind each: what is said, and where.
#include "tests/config/mistakes.h"

#include <gtest/gtest.h>

namespace patency::deck {
namespace {

TEST(Mistakes, MissingKey) {
    EXPECT_EQ(mistakes_in(pipe_with("  spacing: \"0.2 mm\"\n", "")),
              only("16:3: numerics: needs either spacing or across"));
}

TEST(Mistakes, SpacingThatFollowsTheVessel) {
    EXPECT_EQ(mistakes_in(pipe_with("  spacing: \"0.2 mm\"", "  scheme: sph\n  across: 12")),
              only("17:11: numerics.across: is for scheme cells; moving particles need one spacing everywhere, "
                   "numerics.spacing"));
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  largest_spacing: \"0.3 mm\"\n  spacing:")),
              only("16:20: numerics.largest_spacing: means something with numerics.across only"));
    EXPECT_EQ(mistakes_in(pipe_with(
                  "  spacing: \"0.2 mm\"",
                  "  scheme: cells\n  across: 12\n  largest_spacing: \"0.1 mm\"\n  smallest_spacing: \"0.2 mm\"")),
              only("19:21: numerics.smallest_spacing: is more than numerics.largest_spacing, 0.1 mm"));
}

TEST(Mistakes, ASettledFlowWithoutOpenings) {
    const std::string report = mistakes_in(R"(version: 1
geometry: {shape: {type: box, size: [1 mm, 1 mm, 0 mm], periodic: [true, true, false], planar: true}}
blood: {density: 1060 kg/m^3, viscosity: 3.5 mPa s}
initial: {velocity: taylor_green, speed: 0.33 m/s}
numerics: {scheme: sph, spacing: 0.05 mm, reference_speed: 0.33 m/s, duration: 3 ms, convergence: {tolerance_percent: 1}}
)");
    EXPECT_NE(report.find("numerics.convergence: watches the openings, and this domain has none"), report.npos)
        << report;
}

TEST(Mistakes, PeriodsThatAreNotTheCases) {
    const auto with = [](const std::string& waveform) {
        return mistakes_in(R"(version: 1
case: {name: pulse, mode: periodic, period: 0.8 s}
geometry: {shape: {type: tube, diameter: 3 mm, length: 12 mm}}
blood: {density: 1060 kg/m^3, viscosity: 3.5 mPa s}
openings:
  inlet: {type: flow, waveform: )" +
                           waveform + R"(}
  outlet: {type: pressure, pressure: 0 Pa}
numerics: {scheme: cells, spacing: 0.3 mm, duration: 1.6 s}
)");
    };
    const std::string says = "period: is not the case's period, 0.8 s, nor a whole part of it";
    const std::string table = "{times: [0 s, 0.1 s], values: [0 mL/min, 60 mL/min], period: ";
    EXPECT_NE(with(table + "1.2 s}").find(says), std::string::npos);
    EXPECT_NE(with("{fourier: {mean: 1e-6, period: 0.5 s, cosines: [1e-7], sines: [0]}}").find(says),
              std::string::npos);
    EXPECT_EQ(with(table + "0.4 s}").find(says), std::string::npos) << with(table + "0.4 s}");
}

TEST(Mistakes, AnInletAboveTheAorta) {
    const std::string report = mistakes_in(R"(version: 1
geometry: {network: a.json}
blood: {density: 1060 kg/m^3, viscosity: 3.5 mPa s}
aorta: {pressure: 93 mmHg}
openings: {inlet: {type: pressure, pressure: 186 mmHg}, outlet: {type: pressure, pressure: 0 Pa}}
numerics: {scheme: cells, across: 12, duration: 1 s}
)");
    EXPECT_NE(report.find("openings.inlet.pressure: is more than aorta.pressure, 93 mmHg"), report.npos) << report;
}

TEST(Mistakes, FlowsThatNobodyFollows) {
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  scheme: sph\n  without_rest: follow\n  spacing:")),
              only("17:17: numerics.without_rest: is for a steady flow of scheme cells"));
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  scheme: cells\n  without_rest: follow\n  spacing:")),
              mistakes_in(pipe_with("  spacing:", "  scheme: cells\n  spacing:")));
}

TEST(Mistakes, OfSolids) {
    const auto with = [](const std::string& part, const std::string& replacement) {
        std::string text = solid_deck;
        return text.replace(text.find(part), part.size(), replacement);
    };
    const auto says = [&](const std::string& deck, const std::string& words) {
        const std::string report = mistakes_in(deck);
        EXPECT_NE(report.find(words), std::string::npos) << report;
    };
    says(solid_deck + "aorta: {pressure: 93 mmHg}\n", "aorta: does not go together with solids");
    says(with("inner_diameter: 3 mm", "inner_diameter: 4 mm"), "must be less than the diameter");
    says(with("inner_diameter: 3 mm", "inner_diameter: 3 mm, low: [0 mm, 0 mm, 0 mm]"),
         "shape.low: low and high go together");
    says(with("inner_diameter: 3 mm", "inner_diameter: 3 mm, low: [0 mm, 0 mm, 0 mm], high: [1 mm, 1 mm, 0 mm]"),
         "shape.high: must lie above `low`");
    says(with("solid: pin", "solid: pen"), "there is no solid \"pen\"");
    says(with("name: pin", "name: wall"), "a second \"wall\"; names must differ");
    says(with("pressures: [0 mmHg, 100 mmHg]", "pressures: [0 mmHg]"), "there must be one for each of times");
    says(with("high: [3 mm, 3 mm, 0.1 mm]", "high: [3 mm, 3 mm, -2 mm]"), "is below low");
    says(with("{name: 316L}", "{name: 316L, law: yeoh}"), "stands beside name");
    says(with("normal: [0, 0, 1]", "normal: [0, 0, 0]"), "must not be zero");
}

TEST(Mistakes, MissingRecord) {
    EXPECT_EQ(mistakes_in(pipe_with("blood:\n  density: \"1060 kg/m^3\"\n  viscosity: \"3.5 mPa s\"\n", "")),
              only("1:1: blood is missing: the blood's properties; it needs density"));
}

TEST(Mistakes, LesionThatCannotBe) {
    const auto with_lesion = [](const std::string& geometry, const std::string& lesion) {
        return mistakes_in(pipe_with(
            "  shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}\n",
            "  " + geometry +
                "\n  lesion: {branch: lad, position: \"20 mm\", length: \"10 mm\", diameter_stenosis_percent: " +
                lesion + "}\n"));
    };
    EXPECT_EQ(with_lesion("network: t.json", "40"), "accepted");
    EXPECT_EQ(with_lesion("network: t.json", "98"),
              only("5:88: geometry.lesion.diameter_stenosis_percent: 98 is out of range: 0 to 95"));
    EXPECT_EQ(with_lesion("network: t.json", "40, position: \"4 mm\"").substr(0, 9), "case.yaml");   // twice
    EXPECT_EQ(with_lesion("network: t.json", "40, lenth: \"4 mm\""),
              only("5:92: geometry.lesion.lenth: unknown key. Did you mean \"length\"?"));
    EXPECT_EQ(with_lesion("network: t.json", "40, side: [0, 0, 0]"),
              only("5:98: geometry.lesion.side: must not be zero"));
    EXPECT_EQ(
        with_lesion("network: t.swc", "40"),
        only("4:12: geometry.network: needs geometry.unit: only a JSON network says whether it counts in mm or in m"));
    EXPECT_EQ(with_lesion("shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}", "40"),
              only("5:11: geometry.lesion: can narrow a network only, not a surface or a shape"));
}

TEST(Mistakes, MisspelledKey) {
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  threds: 2\n  spacing:")),
              only("16:3: numerics.threds: unknown key. Did you mean \"threads\"?"));
    EXPECT_EQ(mistakes_in(pipe_with("case:", "csae:")), only("2:1: csae: unknown key. Did you mean \"case\"?"));
}

TEST(Mistakes, KeyInTheWrongPlace) {
    EXPECT_EQ(mistakes_in(pipe_and("seed: 3\n")),
              only("18:1: seed: unknown key; a key of this name stands at numerics.seed"));
}

TEST(Mistakes, KeyOfAnotherType) {
    EXPECT_EQ(mistakes_in(pipe_with("length: \"15 mm\"", "length: \"15 mm\", gap: \"1 mm\"")),
              only("4:63: geometry.shape.gap: belongs to type channel or step, not to tube"));
    EXPECT_EQ(
        mistakes_in(pipe_with("    pressure: \"0 mmHg\"", "    pressure: \"0 mmHg\"\n    resistance: \"1 Wood\"")),
        only("15:17: openings.outlet.resistance: belongs to type resistance, not to pressure"));
}

TEST(Mistakes, AStepThatIsNone) {
    const auto with_step = [](const std::string& height, const std::string& at) {
        return mistakes_in(pipe_with(
            "shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}",
            "shape: {type: step, gap: 3 mm, length: 15 mm, step_height: " + height + ", step_at: " + at + "}"));
    };
    EXPECT_EQ(with_step("1.5 mm", "5 mm"), "accepted");
    EXPECT_NE(with_step("3 mm", "5 mm").find("geometry.shape.step_height: must be less than the gap"),
              std::string::npos);
    EXPECT_NE(with_step("1.5 mm", "15 mm").find("geometry.shape.step_at: must be less than the length"),
              std::string::npos);
    EXPECT_NE(with_step("2.5 mm", "5 mm").find("fewer than 4 particles across"), std::string::npos);
}

TEST(Mistakes, MisspelledWord) {
    EXPECT_EQ(mistakes_in(pipe_with("type: velocity", "type: velocty")),
              only("10:11: openings.inlet.type: \"velocty\" is not one of velocity, flow, pressure, resistance, rcr or "
                   "coronary. "
                   "Did you mean \"velocity\"?"));
}

TEST(Mistakes, BareNumber) {
    EXPECT_EQ(mistakes_in(pipe_with("\"0.2 mm\"", "0.2")),
              only("16:12: numerics.spacing: 0.2 has no unit; a length is needed, for example \"0.2 mm\""));
}

TEST(Mistakes, WrongDimension) {
    EXPECT_EQ(
        mistakes_in(pipe_with("\"0 mmHg\"", "\"100 mm\"")),
        only("14:15: openings.outlet.pressure: 100 mm is a length; a pressure is needed, for example \"100 mmHg\""));
}

TEST(Mistakes, UnknownUnit) {
    EXPECT_EQ(mistakes_in(pipe_with("3.5 mPa s", "3.5 mPas")),
              only("7:14: blood.viscosity: there is no unit \"mPas\". Did you mean \"mPa s\"?; a viscosity is needed, "
                   "for example "
                   "\"3.5 mPa s\""));
}

TEST(Mistakes, NotANumber) {
    EXPECT_EQ(
        mistakes_in(pipe_with("1 s", "nan s")),
        only("17:13: numerics.duration: \"nan s\" is not a finite number; a time is needed, for example \"2 s\""));
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  smoothing_ratio: .nan\n  spacing:")),
              only("16:20: numerics.smoothing_ratio: \".nan\" does not start with a number"));
}

TEST(Mistakes, OutOfRange) {
    EXPECT_EQ(mistakes_in(pipe_with("1060", "1.06")),
              only("6:12: blood.density: \"1.06 kg/m^3\" is out of range: 500 kg/m^3 to 2000 kg/m^3"));
    EXPECT_EQ(mistakes_in(pipe_with("\"0.2 mm\"", "\"0 mm\"")),
              only("16:12: numerics.spacing: \"0 mm\" is out of range: above 0 mm, at most 1000 mm"));
    EXPECT_EQ(mistakes_in(pipe_with("version: 1", "version: 2")), only("1:10: version: 2 is out of range: only 1"));
}

TEST(Mistakes, WrongKindOfValue) {
    EXPECT_EQ(mistakes_in(pipe_with("\"0.2 mm\"", "[\"0.2 mm\"]")),
              only("16:12: numerics.spacing: is a list; a length is needed"));
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  threads: 2.5\n  spacing:")),
              only("16:12: numerics.threads: 2.5 is not a whole number"));
    EXPECT_EQ(mistakes_in(pipe_with("  spacing:", "  smoothing_ratio: \"1.3\"\n  spacing:")),
              only("16:20: numerics.smoothing_ratio: \"1.3\" is text; a number without quotes is needed"));
    EXPECT_EQ(mistakes_in(pipe_and("output: 3\n")),
              only("18:9: output: is 3; a record of keys is needed: interval, fields, probes, profiles, average_from, "
                   "checkpoint_interval"));
    EXPECT_EQ(mistakes_in(pipe_and("deployment: [{mode: balloon}, {mode: balloon}]\n")),
              only("18:13: deployment: is a list; one record of keys is needed: mode, diameter, crimped_diameter, "
                   "predilation, friction, balloon_friction, load, ramp, steps, slowing, mass_scaling, region, "
                   "tethering, shoulder, frames"));
    EXPECT_EQ(mistakes_in(pipe_and("body_force: [\"1 m/s^2\", \"0 m/s^2\"]\n")),
              only("18:13: body_force: a list of three is needed, for example [\"9.81 m/s^2\", \"9.81 m/s^2\", \"9.81 "
                   "m/s^2\"]"));
    EXPECT_EQ(mistakes_in(pipe_and("output: {fields: []}\n")),
              only("18:18: output.fields: is an empty list; leave the key out or list something, for example "
                   "[velocity, pressure]"));
    EXPECT_EQ(mistakes_in(pipe_with("name: pipe", "name: ~")), only("2:14: case.name: is empty; text is needed"));
    EXPECT_EQ(mistakes_in(pipe_with("type: tube, diameter: \"3 mm\"", "type: cone, diameters: [\"3 mm\"]")),
              only("4:34: geometry.shape.diameters: has 1 items; 2 are needed, for example [\"1 mm\", \"1 mm\"]"));
    EXPECT_EQ(mistakes_in(pipe_with("type: tube, diameter: \"3 mm\", length: \"15 mm\"",
                                    "type: box, size: [\"1 m\", \"1 m\", \"1 m\"], planar: yes")),
              only("4:59: geometry.shape.planar: yes is neither true nor false"));
}

TEST(Mistakes, RepeatedKey) {
    EXPECT_EQ(mistakes_in(pipe_with("  viscosity:", "  density: \"1000 kg/m^3\"\n  viscosity:")),
              only("7:3: blood.density: repeated; it stands already in line 6"));
    EXPECT_EQ(mistakes_in(pipe_with("  outlet:", "  inlet:")),
              only("12:3: openings.inlet: repeated; it stands already in line 9"));
}

TEST(Mistakes, KeysThatExcludeEachOther) {
    EXPECT_EQ(mistakes_in(pipe_with("velocity: \"0.1 m/s\"", "velocity: \"0.1 m/s\"\n    peak_velocity: \"0.2 m/s\"")),
              only("12:20: openings.inlet.peak_velocity: stands beside velocity; only one of velocity, peak_velocity "
                   "and waveform "
                   "may be given"));
    EXPECT_EQ(mistakes_in(pipe_with("    velocity: \"0.1 m/s\"\n", "")),
              only("10:5: openings.inlet: needs one of velocity, peak_velocity or waveform"));
}

TEST(Mistakes, PeriodicWithoutPeriod) {
    EXPECT_EQ(mistakes_in(pipe_with("name: pipe", "name: pipe, mode: periodic")),
              only("2:7: case.period is missing: the time of one heart beat, for example \"0.8 s\""));
}

TEST(Mistakes, AcrossKeys) {
    EXPECT_EQ(mistakes_in(pipe_with("\"0.2 mm\"", "\"1 mm\"")),
              only("16:12: numerics.spacing: leaves fewer than 4 particles across the narrowest place, 3 mm; at least "
                   "12 give a "
                   "sensible answer"));
    EXPECT_EQ(mistakes_in(pipe_with("type: pressure\n    pressure: \"0 mmHg\"", "type: flow\n    flow: \"-1 mL/s\"")),
              only("9:3: openings: every opening prescribes a flow; one of them must set the pressure (pressure, "
                   "resistance, rcr "
                   "or coronary)"));
    EXPECT_EQ(mistakes_in(pipe_and("output: {average_from: \"2 s\"}\n")),
              only("18:24: output.average_from: is not before the end, 1 s"));
    EXPECT_EQ(
        mistakes_in(pipe_with("shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}", "surface: lumen.stl")),
        only("4:12: geometry.surface: needs geometry.unit: a surface file does not say whether it counts in mm or in "
             "m"));
    EXPECT_EQ(mistakes_in(pipe_with("velocity: \"0.1 m/s\"", "profile: womersley\n    velocity: \"0.1 m/s\"")),
              only("11:14: openings.inlet.profile: womersley needs a waveform: it is the profile of a pulse"));
    EXPECT_EQ(mistakes_in(pipe_with("velocity: \"0.1 m/s\"",
                                    "waveform: {times: [\"0 s\", \"0 s\"], values: [\"1 m/s\", \"2 m/s\"]}")),
              only("11:31: openings.inlet.waveform.times.1: must be greater than the one before, 0 s"));
    EXPECT_EQ(
        mistakes_in(pipe_with("velocity: \"0.1 m/s\"", "waveform: {times: [\"0 s\", \"1 s\"], values: [\"1 m/s\"]}")),
        only("11:47: openings.inlet.waveform.values: there are 1 values at 2 times; as many are needed, at least two"));
    EXPECT_EQ(mistakes_in(pipe_and(
                  "output: {probes: [{name: a, point: [\"0 m\", \"0 m\", \"0 m\"]}, {name: a, point: [\"0 m\", "
                  "\"0 m\", \"0 m\"]}]}\n")),
              only("18:67: output.probes.1.name: a second \"a\"; names must differ"));
    EXPECT_EQ(mistakes_in(pipe_with("length: \"15 mm\"", "length: \"15 mm\", axis: [0, 0, 0]")),
              only("4:64: geometry.shape.axis: must not be zero"));
    EXPECT_EQ(
        mistakes_in(pipe_and("stent: {surface: a.stl}\n")),
        only("18:18: stent.surface: needs stent.unit: a surface file does not say whether it counts in mm or in m"));
    EXPECT_EQ(mistakes_in(pipe_and("stent: {surface: a.stl, unit: inch}\n")),
              only("18:31: stent.unit: \"inch\" is not one of m, cm, mm or um"));
    EXPECT_EQ(
        mistakes_in(pipe_and(
            "stent: {design: paper, placement: {translation: [\"0 m\", \"0 m\", \"0 m\"], direction: [0, 0, 0]}}\n")),
        only("18:83: stent.placement.direction: must not be zero"));
}

TEST(Mistakes, WaveformOfAnotherDimension) {
    EXPECT_EQ(mistakes_in(pipe_with("velocity: \"0.1 m/s\"",
                                    "waveform: {times: [\"0 s\", \"1 s\"], values: [\"1 Pa\", \"2 m/s\"]}")),
              only("11:48: openings.inlet.waveform.values.0: 1 Pa is a pressure; a velocity is needed, for example "
                   "\"0.1 m/s\""));
}

TEST(Mistakes, AllAtOnceInTheOrderOfTheDeck) {
    std::string deck = pipe_with("version: 1", "version: 3");
    for (const auto& [part, replacement] :
         std::vector<std::pair<std::string, std::string>>{{"type: tube", "type: tueb"},
                                                          {"1060", "1"},
                                                          {"viscosity", "vicosity"},
                                                          {"0.1 m/s", "0.1 mm"},
                                                          {"\"1 s\"", "1"}})
        deck.replace(deck.find(part), part.size(), replacement);
    const std::string report = mistakes_in(deck);
    std::size_t at = 0;
    for (const std::string start : {"case.yaml:1:10: version:", "case.yaml:4:17: geometry.shape.type:",
                                    "case.yaml:6:3: blood.viscosity is missing", "case.yaml:6:12: blood.density:",
                                    "case.yaml:7:3: blood.vicosity:", "case.yaml:11:15: openings.inlet.velocity:",
                                    "case.yaml:17:13: numerics.duration:"}) {
        const std::size_t found = report.find(start, at);
        ASSERT_NE(found, std::string::npos) << start << "\n" << report;
        at = found;
    }
    EXPECT_TRUE(report.ends_with("\n7 mistakes; nothing was run.")) << report;
}

TEST(Mistakes, InSettings) {
    EXPECT_EQ(mistakes_in(pipe_deck, {"numerics.spacing=5"}),
              "--set numerics.spacing=5: numerics.spacing: 5 has no unit; a length is needed, for example \"0.2 mm\"\n"
              "1 mistake; nothing was run.");
    EXPECT_EQ(mistakes_in(pipe_deck, {"numerics.spacng=5 mm"}),
              "--set numerics.spacng=5 mm: numerics.spacng: unknown key. Did you mean \"spacing\"?\n1 mistake; nothing "
              "was run.");
    EXPECT_EQ(mistakes_in(pipe_deck, {"numerics.spacng=null"}),   // nothing to take away either
              "--set numerics.spacng=null: numerics.spacng: unknown key. Did you mean \"spacing\"?\n1 mistake; nothing "
              "was run.");
    EXPECT_NE(mistakes_in(pipe_deck, {"openings.outlet.presure="}), "accepted");
    for (const char* bad : {"", "=", "numerics", "numerics.spacing", "numerics..spacing=1 mm", "numerics.spacing=[",
                            "case.name.x=1", "version.1=2", ".=1"})
        EXPECT_NE(mistakes_in(pipe_deck, {bad}), "accepted") << bad;
}

TEST(Mistakes, InRuns) {
    const std::string runs = "runs:\n  - {name: a, set: {numerics.spacing: \"0.1 mm\"}}\n";
    EXPECT_EQ(
        run_mistakes_in(pipe_and(runs + "  - {name: b, set: {numerics.spacing: \"1 s\"}}\n")),
        only("20:39: numerics.spacing: 1 s is a time; a length is needed, for example \"0.2 mm\" (in run \"b\")"));
    EXPECT_EQ(run_mistakes_in(pipe_and(runs + "  - {name: a, set: {numerics.threads: 2}}\n")),
              only("20:12: runs.1.name: a second \"a\"; names must differ"));
    EXPECT_EQ(run_mistakes_in(pipe_and(runs + "  - {name: ../b, set: {numerics.threads: 2}}\n")),
              only("20:12: runs.1.name: \"../b\" is no name; names have letters, digits, _ and -, at most 64"));
    EXPECT_EQ(run_mistakes_in(pipe_with("1060", "1") + runs + "  - {name: b, set: {numerics.threads: 2}}\n"),
              only("6:12: blood.density: \"1 kg/m^3\" is out of range: 500 kg/m^3 to 2000 kg/m^3"))
        << "a mistake of the deck is said once";
}

TEST(Mistakes, AStartFromCellsNeedsAFlowThatCellsCanSolve) {
    EXPECT_EQ(mistakes_in(pipe_and("initial: {velocity: cells}\n")),
              only("18:21: initial.velocity: cells needs a surface or a network, walls at rest and a steady flow; "
                   "start from the estimate or from rest"));
    std::string vessel = pipe_deck;
    vessel.replace(vessel.find("shape: {type: tube, diameter: \"3 mm\", length: \"15 mm\"}"), 54, "network: tube.json");
    vessel.replace(vessel.find("duration: \"1 s\""), 15, "duration: \"1 s\"\n  scheme: sph");
    EXPECT_EQ(mistakes_in(vessel + "initial: {velocity: cells, pressure: cells}\n"), "accepted");
    for (const char* hindrance : {"body_force: [\"1 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]\n",
                                  "wall: {velocity: {all: [\"1 m/s\", \"0 m/s\", \"0 m/s\"]}}\n"})
        EXPECT_NE(
            mistakes_in(vessel + hindrance + "initial: {pressure: cells}\n").find("initial.pressure: cells needs"),
            std::string::npos)
            << hindrance;
}

}   // namespace
}   // namespace patency::deck
