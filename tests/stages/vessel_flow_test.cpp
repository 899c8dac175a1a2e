// SPDX-License-Identifier: Apache-2.0
// A vessel's flow from its estimate to its results: the start, the end when it has settled, what is told along the branches.
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
#include "patency/stages/estimated_field.h"
#include "patency/stages/flow.h"
#include "patency/stages/flow_window.h"
#include "patency/stages/initial_state.h"
#include "patency/stages/run_flow.h"
#include "patency/stages/scene_sampling.h"
#include "patency/stages/vessel_results.h"
#include "tests/stages/decks.h"
#include "tests/stages/results_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

/// The bifurcation that comes with the program, coarse: the least that its lesion allows.
deck::Case bifurcation(deck::Settings more = {}) {
    deck::Settings settings{"numerics.scheme=sph", "numerics.across=null", "numerics.spacing=0.48 mm", "numerics.convergence.tolerance_percent=0.5",
                            "initial={velocity: estimate, pressure: estimate}"};
    settings.insert(settings.end(), more.begin(), more.end());
    return deck::read_case(fs::path(PATENCY_SOURCE_DIR) / "cases/coronary_bifurcation.yaml", settings);
}

/// One narrowed vessel, small and quick; its network lies in the folder.
deck::Case narrowed_tube(const fs::path& folder, const std::string& numerics) {
    fs::create_directories(folder);
    std::ofstream(folder / "tube.json") << R"({"unit": "mm", "blend_width_k": 0.1,
  "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.5], [3, 0, 0, 1.5], [9, 0, 0, 1.5], [14, 0, 0, 1.5]]}],
  "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.5},
           "outlet": {"point": [12, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.5}}})";
    std::ofstream(folder / "tube.yaml") << fmt::format(R"(version: 1
case: {{name: tube}}
geometry: {{network: tube.json, lesion: {{branch: tube, position: "6 mm", length: "4 mm", diameter_stenosis_percent: 40}}}}
blood: {{density: "1060 kg/m^3", viscosity: "3.5 mPa s"}}
openings:
  inlet: {{type: flow, flow: "60 mL/min", profile: parabola}}
  outlet: {{type: rcr, proximal_resistance: "1e8 Pa s/m^3", distal_resistance: "9e8 Pa s/m^3", compliance: "1e-10 m^3/Pa"}}
numerics: {{spacing: "0.4 mm", {}{}}}
)", numerics.find("scheme") == std::string::npos ? "scheme: sph, " : "", numerics);
    return deck::read_case(folder / "tube.yaml");
}

TEST(VesselFlow, IsTheSameToTheBitAtAnotherLevel) {
    const auto gauge = build_scene(bifurcation());
    const auto raised = build_scene(bifurcation({"openings.outlet_large.pressure=80 mmHg", "openings.outlet_medium.distal_pressure=80 mmHg",
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

const Scene& scene() {
    static const auto made = build_scene(bifurcation());
    return *made;
}

TEST(EstimatedField, CarriesTheEstimatesFlowThroughEverySection) {
    const EstimatedField field(*scene().vessel, *scene().estimate);
    const WallHint hint = wall_hint(scene());
    for (const VesselStation& station : make_stations(*scene().vessel, 1e-3)) {
        const SectionGrid grid = make_section_grid(station.plane, hint, 12);
        const BranchedLines& lines = scene().vessel->along->lines;
        const bool is_behind_a_bifurcation = station.arc < lines.start_arc(lines.branches[station.branch]) + 2 * station.plane.radius;
        if (!grid.closed || (station.branch > 0 && is_behind_a_bifurcation)) continue;   // where fields meet they jump
        double flow = 0;
        for (std::size_t k = 0; k < grid.place.size(); ++k)
            flow += grid.area[k] * dot(field.at(grid.place[k], -hint.distance(grid.place[k])).velocity, grid.normal);
        // The parabola over the wall's distance is that of a round section; these are round to some per cent.
        EXPECT_NEAR(flow / scene().estimate->flow.flow[station.branch], 1, 0.08) << station.branch << " at " << station.arc;
    }
}

TEST(EstimatedField, HasThePressureOfTheStationsAndRestAtTheWall) {
    const EstimatedField field(*scene().vessel, *scene().estimate);
    const Estimate& e = *scene().estimate;
    const VesselAlong& along = *scene().vessel->along;
    for (std::size_t b = 0; b < along.lines.branches.size(); ++b) {
        const Branch& branch = along.lines.branches[b];
        const std::size_t middle = (branch.first + branch.last) / 2;
        const CentrelinePoint& point = along.lines.point(branch, middle);
        const auto& pressure = e.flow.pressure[b];   // the last stations are the branch's points
        const double expected = pressure[pressure.size() - 1 - (branch.last - middle)];
        EXPECT_NEAR(field.at(point.place, point.radius).pressure, expected, 1e-9);
        EXPECT_EQ(norm(field.at(point.place, 0).velocity), 0);
        EXPECT_GT(dot(field.at(point.place, point.radius).velocity, point.tangent), 0);
    }
    EXPECT_GT(field.pressure_range(), 0);
}

TEST(VesselScene, ExpectsTheSpeedOfItsNarrowestPlace) {
    // Twice the mean of a parabola, where flow over area is largest along the estimate.
    double largest = 0;
    for (std::size_t b = 0; b < scene().estimate->tree.branches.size(); ++b)
        for (double area : scene().estimate->tree.branches[b].area) largest = std::max(largest, 2 * scene().estimate->flow.flow[b] / area);
    EXPECT_NEAR(scene().numerics.reference_speed, largest, 1e-12);
    EXPECT_NEAR(scene().lumen.narrowest, scene().vessel->along->assessment.lesions.at(0).minimum_diameter, 1e-6);
}

TEST(VesselScene, CompliancesBeginWhereTheEstimateLeavesThem) {
    Folder folder;
    const auto made = build_frame(narrowed_tube(folder.path, "duration: \"1 ms\""));
    const std::size_t k = 1;
    ASSERT_EQ(made->ends[k].name, "outlet");
    const Estimate& e = *made->estimate;
    EXPECT_NEAR(made->laws[k].state[0] + 1e8 * e.opening_flows[k], e.opening_pressures[k], 1e-9);
    EXPECT_GT(made->laws[k].state[0], 0);
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

std::vector<double> carried_by(const Scene& scene) {
    const FluidParticles& fluid = scene.fluid;
    return EstimatedField(*scene.vessel, *scene.estimate)
        .carried({&fluid.position[0], fluid.size()}, {&fluid.velocity[0], fluid.size()}, fluid.volume[0]);
}

TEST(EstimatedField, TellsWhatPlacesCarry) {   // a plug along every branch: area times speed
    const Scene& s = scene();
    const EstimatedField field(*s.vessel, *s.estimate);
    std::vector<Vec3> along;
    for (std::size_t i = 0; i < s.fluid.size(); ++i) {
        const Vec3 v = field.at(s.fluid.position[i], 1).velocity;
        along.push_back(v / norm(v));
    }
    const auto carried = field.carried({&s.fluid.position[0], s.fluid.size()}, along, s.fluid.volume[0]);
    EXPECT_NEAR(carried[0] / (std::numbers::pi * 4e-6), 1, 0.02);   // the left main is round, 4 mm wide
}

TEST(VesselFlow, StartsFromTheEstimateWithWhatItsBranchesCarry) {
    const std::vector<double> carried = carried_by(scene());
    for (std::size_t b = 0; b < carried.size(); ++b) EXPECT_NEAR(carried[b] / scene().estimate->flow.flow[b], 1, 1e-9) << b;
    for (std::size_t k = 1; k < scene().ends.size(); ++k)
        EXPECT_EQ(scene().ends[k].absorber.mean, scene().estimate->opening_flows[k]);
}

TEST(VesselFlow, StartsFromTheFlowOnCellsWhereOneIsWaitedFor) {
    deck::Case config = bifurcation();
    config.initial = {};
    const auto made = build_scene(config);
    EXPECT_NE(made->start_remark.find("from the flow on"), std::string::npos) << made->start_remark;
    const double inflow = 0.315 * made->ends[0].area;
    const std::vector<double> carried = carried_by(*made);
    EXPECT_NEAR(carried[0], inflow, 1e-4 * inflow);
    EXPECT_NEAR(carried[1] + carried[2], inflow, 1e-3 * inflow);
    EXPECT_NEAR(carried[3] + carried[4], carried[2], 1e-3 * inflow);
    EXPECT_NEAR(carried[2], 0.2345 * inflow, 0.005 * inflow);   // finite volumes; the estimate has 0.247
    // Ends see it at once, as far as five particles across tell: none waits for a flow that first must come to it.
    find_members(made->fluid, made->numerics.spacing, made->ends);
    for (std::size_t k = 1; k < made->ends.size(); ++k) {
        measure_flow(made->ends[k], made->fluid, 0, 0);
        EXPECT_NEAR(made->ends[k].flow / made->ends[k].absorber.mean, 1, 0.07) << made->ends[k].name;
    }
    EXPECT_NEAR(made->ends[1].absorber.mean, carried[1], 1e-3 * inflow);
    // At the inlet sound is heard against the pressure there, and the blood within has it.
    EXPECT_NEAR(made->ends[0].absorber.mean, 172, 8);
    // Kept by the deck's word, or where nothing waits.
    EXPECT_EQ(bifurcation().initial_velocity(), deck::InitialVelocity::estimate);
    config.numerics.convergence.reset();
    EXPECT_EQ(config.initial_velocity(), deck::InitialVelocity::estimate);
    EXPECT_EQ(config.initial_pressure(), deck::InitialPressure::estimate);
}

TEST(VesselFlow, StartsFromTheEstimateWhereCellsFindNone) {
    deck::Case config = bifurcation();
    const auto estimated = build_scene(config);
    config.initial = {};
    auto made = build_frame(config);
    made->fluid.resize(estimated->fluid.size());
    for (std::size_t i = 0; i < made->fluid.size(); ++i) made->fluid.position[i] = estimated->fluid.position[i], made->fluid.volume[i] = estimated->fluid.volume[i];
    made->reference_pressure = estimated->reference_pressure;
    const SolveOnCells lost = [](const Scene&) -> std::unique_ptr<const CellStart> { throw DivergedError("the flow on cells ran away"); };
    compute_initial_state(*made, lost);
    EXPECT_NE(made->start_remark.find("from the estimate"), std::string::npos);
    EXPECT_NE(made->start_remark.find("ran away"), std::string::npos);
    for (std::size_t i = 0; i < made->fluid.size(); i += 97) {
        EXPECT_EQ(norm(made->fluid.velocity[i] - estimated->fluid.velocity[i]), 0);
        EXPECT_EQ(made->fluid.pressure[i], estimated->fluid.pressure[i]);
    }
    made->config.initial = {.velocity = deck::InitialVelocity::cells, .speed = {}, .pressure = {}};   // asked for: no other will do
    EXPECT_THROW(compute_initial_state(*made, lost), DivergedError);
}

TEST(FlowWindow, TellsADriftFromATremble) {
    const std::vector<double> constant(8, 100);
    EXPECT_EQ(change_of_windows(marks_of(constant, constant), 4, 0.5, 0).change, 0);
    EXPECT_LE(change_of_windows(marks_of(constant, constant), 4, 0.5, 0).excess, 0);
    // A step of 1 %: more than may be, and certain.
    const WindowChange step = change_of_windows(marks_of({100, 100, 100, 100, 101, 101, 101, 101}, constant), 4, 0.5, 0);
    EXPECT_NEAR(step.change, 100.0 / 101, 1e-9);
    EXPECT_GT(step.excess, 0.4);
    // A steady drift of 1 % per window is certain too, though its parts differ.
    EXPECT_GT(change_of_windows(marks_of({100, 100.25, 100.5, 100.75, 101, 101.25, 101.5, 101.75}, constant), 4, 0.5, 0).excess, 0);
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
        for (const std::size_t opening : {0, 1}) high[k].pressure_time[opening] = low[k].pressure_time[opening] + 900 * low[k].time;
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
        if (station.branch > 0 && station.arc < lines.start_arc(lines.branches[station.branch]) + 2 * station.plane.radius) continue;
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
    const deck::Case config = narrowed_tube(folder.path / "deck", "duration: \"10 ms\", convergence: {tolerance_percent: 1e-3, window: \"2.5 ms\"}");
    const std::vector<std::string> names{"summary.json", "sections.csv", "pullback.csv", "waveforms.csv", "wall.vtp", "centreline.vtp", "cut.vtp", "streamlines.vtp"};
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
    while (run_flow(config, {.folder = out, .interrupted = [&] { return ++steps % 4 == 0; }}) == Outcome::interrupted) ++pauses;
    EXPECT_GT(pauses, 1);
    for (const std::string& name : names) EXPECT_EQ(text_of(folder.path / "out" / name), whole[name]) << name;
}

TEST(RunFlow, CellsTellAVesselsFlowLikeParticles) {
    Folder folder;
    deck::Case config = narrowed_tube(folder.path / "deck", "duration: \"1 s\", scheme: cells");
    config.aorta.pressure = 12400;
    EXPECT_EQ(run_flow(config, {.folder = OutputFolder(folder.path / "out")}), Outcome::done);
    const auto summary = nlohmann::json::parse(text_of(folder.path / "out/summary.json"));
    EXPECT_EQ(summary["scheme"], "cells");
    EXPECT_NEAR(summary["branches"][0]["flow_m3_per_s"].get<double>(), 1e-6, 0.03e-6);
    const auto& lesion = summary["lesions"][0];
    EXPECT_NEAR(lesion["drop_pa"].get<double>() / lesion["estimated_drop_pa"].get<double>(), 1, 0.25);
    EXPECT_LT(summary["ffr"]["lesion"].get<double>(), 1);
    EXPECT_GT(summary["ffr"]["lesion"].get<double>(), 0.98);   // 60 mL/min through 40 % of 3 mm are no limit
    for (const char* name : {"wall.vtp", "cut.vtp", "streamlines.vtp", "pullback.csv"}) EXPECT_TRUE(fs::exists(folder.path / "out" / name)) << name;
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
