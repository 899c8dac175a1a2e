// SPDX-License-Identifier: Apache-2.0
// A vessel's flow to its results: the end when it has settled, what is told along the branches.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <sstream>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/csv.h"
#include "patency/stages/build.h"
#include "patency/stages/flow.h"
#include "patency/stages/flow_window.h"
#include "patency/stages/run_flow.h"
#include "patency/stages/scene_sampling.h"
#include "patency/stages/vessel_results.h"
#include "tests/stages/decks.h"
#include "tests/stages/results_folder.h"
#include "tests/stages/vessel_decks.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

TEST(VesselFlow, IsTheSameToTheBitAtAnotherLevel) {
    const auto gauge = build_scene(bifurcation());
    const auto raised = build_scene(
        bifurcation({"openings.outlet_large.pressure=80 mmHg", "openings.outlet_medium.distal_pressure=80 mmHg",
                     "openings.outlet_small.distal_pressure=80 mmHg"}));
    constexpr double level = 80 * 133.322387415;
    for (Scene* s : {gauge.get(), raised.get()}) advance(*s, {.until = 5e-4});
    ASSERT_EQ(gauge->fluid.size(), raised->fluid.size());
    for (std::size_t i = 0; i < gauge->fluid.size(); ++i) {
        ASSERT_EQ(gauge->fluid.velocity[i], raised->fluid.velocity[i]);
        ASSERT_NEAR(gauge->pressure_of(i) + level, raised->pressure_of(i), 1e-6);
    }
    for (std::size_t k = 0; k < gauge->laws.size(); ++k)
        EXPECT_NEAR(gauge->laws[k].pressure_time + level * gauge->time, raised->laws[k].pressure_time, 1e-8);
}

/// Two windows of four parts: what flows in and out of two openings during each part, at pressures.
std::vector<FlowMark> marks_of(const std::vector<double>& flows, const std::vector<double>& pressures) {
    std::vector<FlowMark> marks{{.time = 0, .volume_out = {0, 0}, .pressure_time = {0, 0}}};
    for (std::size_t p = 0; p < flows.size(); ++p) {
        FlowMark next = marks.back();
        next.time += 1;
        next.volume_out[0] -= flows[p], next.volume_out[1] += flows[p];
        next.pressure_time[0] += pressures[p];
        marks.push_back(next);
    }
    return marks;
}

TEST(FlowWindow, TellsADriftFromATremble) {
    const std::vector<double> constant(8, 100);
    EXPECT_EQ(change_of_windows(marks_of(constant, constant), 4, 0.5, 0).change, 0);
    EXPECT_LE(change_of_windows(marks_of(constant, constant), 4, 0.5, 0).excess, 0);
    // A step of 1 %: more than may be, and certain.
    const WindowChange step =
        change_of_windows(marks_of({100, 100, 100, 100, 101, 101, 101, 101}, constant), 4, 0.5, 0);
    EXPECT_NEAR(step.change, 100.0 / 101, 1e-9);
    EXPECT_GT(step.excess, 0.4);
    // A steady drift of 1 % per window is certain too, though its parts differ.
    EXPECT_GT(change_of_windows(marks_of({100, 100.25, 100.5, 100.75, 101, 101.25, 101.5, 101.75}, constant), 4, 0.5, 0)
                  .excess,
              0);
    // The same 1 % between parts that scatter by 2 % is none.
    EXPECT_LE(change_of_windows(marks_of({98, 102, 98.5, 101.5, 99, 103, 98, 104}, constant), 4, 0.5, 0).excess, 0);
    // But not all can be put down to scatter.
    EXPECT_GT(change_of_windows(marks_of({80, 120, 85, 115, 90, 130, 80, 140}, constant), 4, 0.5, 0).excess, 0);
    // Of a period there are no parts.
    EXPECT_GT(change_of_windows(marks_of({100, 101}, {100, 100}), 1, 0.5, 0).excess, 0);
    // Pressures count as well, above the datum.
    EXPECT_GT(change_of_windows(marks_of(constant, {100, 100, 100, 100, 102, 102, 102, 102}), 4, 0.5, 0).excess, 0);
    // What rises at all openings at once is the level, which counts by what it is above the datum.
    std::vector<FlowMark> low = marks_of(constant, {100, 100, 100, 100, 102, 102, 102, 102}), high = low;
    for (FlowMark& mark : low) mark.pressure_time[1] = mark.pressure_time[0];
    for (std::size_t k = 0; k < low.size(); ++k)
        for (const std::size_t opening : {0, 1})
            high[k].pressure_time[opening] = low[k].pressure_time[opening] + 900 * low[k].time;
    EXPECT_NEAR(change_of_windows(low, 4, 0.5, 0).change, 100 * 2 / 102.0, 1e-9);
    EXPECT_NEAR(change_of_windows(high, 4, 0.5, 900).change, 100 * 2 / 102.0, 1e-9);
}

TEST(FlowWindow, EndsARunThatHasSettled) {
    ChannelDeck deck;
    deck.duration = "20 ms";
    deck.numerics = "convergence: {tolerance_percent: 1, window: \"1 ms\"}";
    const auto made = build_scene(deck::parse_case(deck.text()));
    FlowWindow window(*made);
    EXPECT_TRUE(window.is_watched());
    FlowRun run{.until = 0.02, .exact_times = window.exact_times()};
    std::vector<double> block_begins{0};
    run.observe = [&](const Scene& now, const FlowStep&) {
        if (window.observe(now)) block_begins.push_back(now.time);
        EXPECT_TRUE(window.begin() || window.block_begin() == block_begins.back());
    };
    run.interrupted = [&] { return made->time >= window.end(); };
    advance(*made, run);
    EXPECT_TRUE(window.is_settled());
    EXPECT_LE(window.change_percent(), 1);
    EXPECT_LT(made->time, 0.013);
    EXPECT_NEAR(made->time - window.begin()->time, 2e-3, 1e-12);   // the means are those of the two windows that agreed
    EXPECT_NEAR(std::remainder(made->time, 0.5e-3), 0, 1e-12);
    ASSERT_GE(block_begins.size(), FlowWindow::blocks);
    EXPECT_EQ(block_begins[block_begins.size() - FlowWindow::blocks], window.begin()->time);
}

// What is quiet once may be a swing that turns, where no end lets sound out.
TEST(FlowWindow, WaitsLongerWhereSoundStays) {
    const auto quiet_at = [](const std::string& ramp) {
        ChannelDeck deck;
        deck.duration = "20 ms";
        deck.inlet = "{type: velocity, profile: parabola, peak_velocity: \"0.165 m/s\"" + ramp + "}";
        deck.outlet = "{type: pressure, pressure: \"0 Pa\"" + ramp + "}";
        deck.numerics = "convergence: {window: \"2 ms\"}";
        deck::Case config = deck::parse_case(deck.text());
        config.numerics.convergence->tolerance_percent = 1e6;   // everything is quiet
        const auto made = build_scene(config);
        FlowWindow window(*made);
        FlowRun run{.until = 0.02, .exact_times = window.exact_times()};
        run.observe = [&](const Scene& now, const FlowStep&) { window.observe(now); };
        run.interrupted = [&] { return made->time >= window.end(); };
        advance(*made, run);
        return made->time;
    };
    EXPECT_NEAR(quiet_at(""), 4e-3, 1e-12);
    EXPECT_NEAR(quiet_at(", ramp: \"1 us\""), 6e-3, 1e-12);   // two comparisons that share no part
}

TEST(FlowWindow, OneThatDoesNotSettleEndsWithItsDuration) {
    ChannelDeck deck;
    deck.duration = "10 ms";
    deck.initial = "{velocity: rest}";
    deck.numerics = "convergence: {tolerance_percent: 1e-6, window: \"2 ms\"}";
    const auto made = build_scene(deck::parse_case(deck.text()));
    FlowWindow window(*made);
    FlowRun run{.until = 0.01, .exact_times = window.exact_times()};
    run.observe = [&](const Scene& now, const FlowStep&) { window.observe(now); };
    run.interrupted = [&] { return made->time >= window.end(); };
    advance(*made, run);
    EXPECT_EQ(made->time, 0.01);
    EXPECT_FALSE(window.is_settled());
    EXPECT_NEAR(window.begin()->time, 6e-3, 1e-12);
}

TEST(VesselResults, TellTheFlowThatIsThere) {
    deck::Case config = bifurcation();
    config.aorta.pressure = 12400;
    const auto made = build_scene(config);   // its flow is the estimate's field
    VesselRecorder recorder(*made);
    recorder.sample(*made);
    const Estimate& e = *made->estimate;
    const VesselFlow flow = evaluate_vessel(*made, recorder, e.flow.inlet_pressure, 0);
    ASSERT_GT(flow.stations.size(), 40u);
    EXPECT_NEAR(flow.level, 12400 - e.flow.inlet_pressure, 1e-9);
    double worst = 0;
    for (const StationFlow& s : flow.stations) {
        const VesselStation& station = recorder.stations()[s.station];
        const BranchedLines& lines = made->vessel->along->lines;
        if (station.branch > 0 &&
            station.arc < lines.start_arc(lines.branches[station.branch]) + 2 * station.plane.radius)
            continue;
        // Coarse particles do not see the bends of the field: flow and pressure of a section within some per cent.
        EXPECT_NEAR(s.flow.flow / e.flow.flow[station.branch], 1, 0.12) << station.branch << " at " << station.arc;
        worst = std::max(worst, std::abs(*s.ffr * 12400 - flow.level - s.flow.pressure));
        EXPECT_EQ(s.deviation.flow, 0);   // one instant
    }
    EXPECT_LT(worst, 1e-9);
    ASSERT_EQ(flow.lesions.size(), 1u);
    EXPECT_NEAR(flow.lesions[0].drop / e.lesions[0].drop, 1, 0.1);
    EXPECT_NEAR(*flow.lesions[0].ffr, *e.lesions[0].ffr, 0.002);
    EXPECT_EQ(flow.worst_ffr, flow.lesions[0].ffr);
    EXPECT_LT(*flow.lesions[0].gauge_ratio, 1);
    EXPECT_LT(flow.lesions[0].across, fewest_across);   // and so it is marked
}

TEST(VesselResults, WithoutAnAortaThereIsNoFfr) {
    VesselRecorder recorder(scene());
    recorder.sample(scene());
    nlohmann::ordered_json summary;
    add_vessel_summary(summary, scene(), recorder, evaluate_vessel(scene(), recorder, 170, 0));
    EXPECT_TRUE(summary["ffr"]["lesion"].is_null());
    EXPECT_FALSE(summary["ffr"]["reason"].get<std::string>().empty());
    EXPECT_TRUE(summary["gauge_pressure_ratio"].is_number());
    EXPECT_TRUE(summary["lesions"][0]["is_under_resolved"]);
    EXPECT_EQ(summary["branches"].size(), 5u);
}

TEST(VesselResults, SayWhyThereIsNoFfr) {
    const auto frame =
        build_frame(bifurcation({"aorta.pressure=93 mmHg"}));   // it has a lesion, and no section of it was seen
    nlohmann::ordered_json summary;
    add_vessel_summary(summary, *frame, VesselRecorder(*frame), {});
    EXPECT_TRUE(summary["ffr"]["lesion"].is_null());
    EXPECT_NE(summary["ffr"]["reason"].get<std::string>().find("too short or too coarse"), std::string::npos);
}

TEST(VesselResults, TheMeansOfARecorderSurviveItsState) {
    VesselRecorder recorder(scene()), other(scene());
    recorder.sample(scene()), recorder.sample(scene());
    other.restore(recorder.state());
    EXPECT_EQ(other.instants(), 2u);
    EXPECT_EQ(other.shear().tawss(), recorder.shear().tawss());
    EXPECT_EQ(other.wall_pressure(), recorder.wall_pressure());
    EXPECT_EQ(other.cut().state(), recorder.cut().state());
    for (std::size_t k = 0; k < recorder.stations().size(); ++k)
        EXPECT_EQ(other.flows().mean()[k].pressure, recorder.flows().mean()[k].pressure);
}

TEST(VesselResults, BlocksJoinToTheMeansOfTheLastOnes) {
    VesselRecorder blocks(scene()), at_once(scene());
    const double level = scene().reference_pressure;
    auto& moving = const_cast<Scene&>(scene());   // each instant at a level of its own
    const auto sample = [&](VesselRecorder& recorder, double more) {
        moving.reference_pressure = level + more;
        recorder.sample(scene());
        moving.reference_pressure = level;
    };
    for (const double more : {1e6, 10.0, 20.0}) sample(blocks, more), blocks.end_block(2);   // the first is forgotten
    EXPECT_EQ(blocks.instants(), 0u);
    sample(blocks, 30), sample(blocks, 40);
    VesselRecorder kept(scene());
    kept.restore(blocks.state(), blocks.finished());   // as a checkpoint does
    for (const double more : {10, 20, 30, 40}) sample(at_once, more);
    for (VesselRecorder* joined : {&blocks, &kept}) {
        joined->join_blocks();
        ASSERT_EQ(joined->instants(), 4u);
        EXPECT_TRUE(joined->finished().empty());
        EXPECT_NEAR(joined->wall_pressure()[7], at_once.wall_pressure()[7], 1e-9);
        EXPECT_NEAR(joined->flows().mean()[5].pressure, at_once.flows().mean()[5].pressure, 1e-9);
        EXPECT_NEAR(joined->shear().tawss()[7], at_once.shear().tawss()[7], 1e-12);
        EXPECT_NEAR(joined->cut().state()[4], at_once.cut().state()[4], 1e-6);
    }
    blocks.end_block(0);
    EXPECT_EQ(blocks.finished().size(), 0u);
}

TEST(VesselCut, LiesInTheLumenFromWallToWall) {
    const VesselCut cut(scene());
    const auto& distance = scene().lumen.distance;
    double deepest = 0;
    ASSERT_GT(cut.places().size(), 1000u);
    for (std::size_t k = 0; k < cut.places().size(); ++k) {
        EXPECT_LT(distance.value(cut.places()[k]), 0.05e-3) << k;
        deepest = std::min(deepest, distance.value(cut.places()[k]));
    }
    EXPECT_LT(deepest, -1.7e-3);   // the axis of a vessel of 4 mm
    EXPECT_NEAR(distance.value(cut.places().front()), 0, 0.05e-3);
}

TEST(RunFlow, AVesselThatIsInterruptedGoesOnToTheSameBytes) {
    Folder folder;
    const deck::Case config = narrowed_tube(
        folder.path / "deck", "duration: \"10 ms\", convergence: {tolerance_percent: 1e-3, window: \"2.5 ms\"}");
    const std::vector<std::string> names{"summary.json", "sections.csv",   "pullback.csv", "waveforms.csv",
                                         "wall.vtp",     "centerline.vtp", "cut.vtp",      "streamlines.vtp"};
    std::map<std::string, std::string> whole;
    const OutputFolder out(folder.path / "out");
    const Outcome outcome = run_flow(config, {.folder = out});
    EXPECT_EQ(outcome, Outcome::unsettled);   // it says so, and the results are there
    for (const std::string& name : names) {
        whole[name] = text_of(folder.path / "out" / name);
        EXPECT_FALSE(whole[name].empty()) << name;
    }
    const auto summary = nlohmann::json::parse(whole["summary.json"]);
    EXPECT_EQ(summary["instants_averaged"], 8);
    EXPECT_FALSE(summary["convergence"]["is_converged"]);
    EXPECT_EQ(read_csv(folder.path / "out/pullback.csv").names.front(), "arc_m");
    out.clear();
    // In the middle of the means and before them.
    int steps = 0, pauses = 0;
    while (run_flow(config, {.folder = out, .interrupted = [&] { return ++steps % 4 == 0; }}) == Outcome::interrupted)
        ++pauses;
    EXPECT_GT(pauses, 1);
    for (const std::string& name : names) EXPECT_EQ(text_of(folder.path / "out" / name), whole[name]) << name;
}

// Centrelines tell a network's narrowest place a little narrower than its file does: the cells must not depend on it.
TEST(RunFlow, APulseOnTheCellsOfANetworkGoesOnToTheSameBytes) {
    Folder folder;
    narrowed_tube(folder.path / "deck", "duration: \"20 ms\", scheme: cells");
    const deck::Case config = deck::read_case(
        folder.path / "deck/tube.yaml",
        {"case={name: pulse, mode: periodic, period: 20 ms}", "numerics.spacing=null", "numerics.across=6",
         "numerics.steps_per_period=20", "geometry.lesion.diameter_stenosis_percent=50"});
    const OutputFolder whole(folder.path / "whole"), parts(folder.path / "parts");
    run_flow(config, {.folder = whole});
    int steps = 0, pauses = 0;
    while (run_flow(config, {.folder = parts, .interrupted = [&] { return ++steps % 100 == 3 || steps % 100 == 6; }}) ==
               Outcome::interrupted &&
           pauses < 50)
        ++pauses;
    for (const char* name : {"summary.json", "waveforms.csv", "pullback.csv"})
        EXPECT_EQ(text_of(whole.file(name)), text_of(parts.file(name))) << name;
    EXPECT_GT(pauses, 0);
}

TEST(RunFlow, OneThatHasSettledIsNotComputedOn) {
    Folder folder;
    const deck::Case config = narrowed_tube(
        folder.path / "deck", "duration: \"1 s\", convergence: {tolerance_percent: 10, window: \"1 ms\"}");
    const OutputFolder out(folder.path / "out");
    EXPECT_EQ(run_flow(config, {.folder = out}), Outcome::done);
    const std::string summary = text_of(out.file("summary.json")), waveforms = text_of(out.file("waveforms.csv"));
    EXPECT_EQ(run_flow(config, {.folder = out}), Outcome::done);
    EXPECT_EQ(text_of(out.file("summary.json")), summary);
    EXPECT_EQ(text_of(out.file("waveforms.csv")), waveforms);
}

TEST(RunFlow, AVesselTooShortForSectionsHasResultsWithoutThem) {
    Folder folder;
    narrowed_tube(folder.path / "deck", "duration: \"1 s\", scheme: cells");
    std::ofstream(folder.path / "deck/tube.json") << R"({"unit": "mm", "blend_width_k": 0.1,
  "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.5], [1, 0, 0, 1.5], [4, 0, 0, 1.5]]}],
  "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.5},
           "outlet": {"point": [2, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.5}}})";
    const deck::Case config = deck::read_case(folder.path / "deck/tube.yaml",
                                              {"geometry.lesion=null", "numerics.spacing=null", "numerics.across=6"});
    EXPECT_EQ(run_flow(config, {.folder = OutputFolder(folder.path / "out")}), Outcome::done);
    EXPECT_TRUE(fs::exists(folder.path / "out/centerline.vtp"));
}

TEST(RunFlow, CellsTellAVesselsFlowLikeParticles) {
    Folder folder;
    deck::Case config = narrowed_tube(folder.path / "deck", "duration: \"1 s\", scheme: cells");
    config.aorta.pressure = 12400;
    EXPECT_EQ(run_flow(config, {.folder = OutputFolder(folder.path / "out")}), Outcome::done);
    const auto summary = nlohmann::json::parse(text_of(folder.path / "out/summary.json"));
    EXPECT_EQ(summary["scheme"], "cells");
    const double through = summary["openings"]["outlet"]["flow_m3_per_s"].get<double>();
    EXPECT_NEAR(through, 1e-6, 1e-11);
    EXPECT_NEAR(summary["branches"][0]["flow_m3_per_s"].get<double>(), through, 1e-18);   // cells store nothing
    const auto& lesion = summary["lesions"][0];
    EXPECT_NEAR(lesion["flow_m3_per_s"].get<double>(), through, 1e-18);
    EXPECT_NEAR(lesion["drop_pa"].get<double>() / lesion["estimated_drop_pa"].get<double>(), 1, 0.25);
    EXPECT_LT(summary["ffr"]["lesion"].get<double>(), 1);
    EXPECT_GT(summary["ffr"]["lesion"].get<double>(), 0.98);   // 60 mL/min through 40 % of 3 mm are no limit
    for (const char* name : {"wall.vtp", "cut.vtp", "streamlines.vtp", "pullback.csv"})
        EXPECT_TRUE(fs::exists(folder.path / "out" / name)) << name;
}

TEST(RunFlow, AnotherVesselUnderTheSameNameIsRefused) {
    Folder folder;
    const deck::Case config = narrowed_tube(folder.path / "deck", "duration: \"1 ms\"");
    const fs::path network = folder.path / "deck/tube.json";
    const OutputFolder out(folder.path / "out");
    EXPECT_EQ(run_flow(config, {.folder = out, .interrupted = [] { return true; }}), Outcome::interrupted);
    std::ofstream(network, std::ios::app) << "\n";
    EXPECT_THROW(run_flow(config, {.folder = out}), CheckpointError);
}

}   // namespace
}   // namespace patency
