// SPDX-License-Identifier: Apache-2.0
// A flow on cells in time, from a deck to its results.
#include "patency/stages/cell_build.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/stages/build.h"
#include "patency/stages/flow.h"
#include "patency/stages/run_flow.h"
#include "tests/stages/results_folder.h"

namespace patency {
namespace {

constexpr double radius = 2e-3, length = 6e-3, density = 1060, mu = 3.5e-3, period = 0.3, push = 15,
                 area = std::numbers::pi * radius * radius;

/// A tube between a pressure that swings and `outlet`.
deck::Case pulsed(const std::string& outlet, const std::string& duration, const std::string& more = "") {
    return deck::parse_case(R"(version: 1
case: {name: pulse, mode: periodic, period: "0.3 s"}
geometry: {shape: {type: tube, diameter: "4 mm", length: "6 mm", axis: [1, 2, -0.5]}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlet: {type: pressure, waveform: {fourier: {mean: "1 Pa", period: "0.3 s", cosines: ["15 Pa"], sines: ["0 Pa"]}}}
  outlet: )" + outlet + R"(
numerics: {scheme: cells, spacing: "0.5 mm", duration: ")" +
                            duration + R"(", steps_per_period: 40}
)" + more);
}
const std::string open = R"({type: pressure, pressure: "0 Pa"})";
const std::string bed =
    R"({type: rcr, proximal_resistance: "1e6 Pa s/m^3", distal_resistance: "1e7 Pa s/m^3", compliance: "1e-8 m^3/Pa"})";

TEST(CellMarch, FollowsAPulseThatTurns) {
    const auto scene = build_scene(pulsed(open, "1.8 s"));
    const double omega = 2 * std::numbers::pi / period;
    double lowest = 0;
    std::complex<double> seen = 0;
    advance(*scene, {.until = 5 * period});   // the start decays in a period and a half
    advance(*scene, {.until = 6 * period, .observe = [&](const Scene& now, const FlowStep& step) {
                         lowest = std::min(lowest, now.ends[1].flow);
                         seen += 2 / period * step.dt * now.ends[1].flow * std::polar(1.0, -omega * now.time);
                     }});
    const WomersleyMode mode(Section::circular, womersley_number(radius, omega, density, mu));
    const std::complex<double> exact = area * radius * radius * push / length / mu * mode.mobility();
    EXPECT_LT(lowest, -0.3 * std::abs(exact));   // it does turn
    EXPECT_NEAR(std::abs(seen / exact), 1, 0.03);
    EXPECT_NEAR(std::arg(seen / exact), 0, 0.03);
    EXPECT_LT(std::abs(scene->ends[0].flow + scene->ends[1].flow), 1e-3 * std::abs(exact));
}

// What the model says of the flow that passed, integrated finely, is the pressure at the outlet.
TEST(CellMarch, HandsItsFlowToTheModelBehindAnOutlet) {
    const auto scene = build_scene(pulsed(bed, "0.6 s"));
    const OutletModel model = Rcr{1e6, 1e-8, 1e7, 0};
    OutletState state = scene->laws[1].state;
    double flow = scene->ends[1].flow, time = 0, highest = 0;
    advance(*scene, {.until = 2 * period, .observe = [&](const Scene& now, const FlowStep&) {
                         state = advanced(model, state, {time, now.time - time}, flow, now.ends[1].flow);
                         flow = now.ends[1].flow, time = now.time;
                         const double wanted = outlet_pressure(model, state, flow);
                         highest = std::max(highest, wanted);
                         EXPECT_NEAR(now.ends[1].mean_pressure, wanted, 1e-3 * push);
                     }});
    EXPECT_GT(highest, 1);
}

// Blood is pushed before it moves: the pressure that starts a flow from rest is its inertia.
TEST(CellMarch, StartsFromRest) {
    deck::Case config = deck::parse_case(R"(version: 1
case: {name: start, mode: periodic, period: "1 s"}
geometry: {shape: {type: tube, diameter: "20 mm", length: "60 mm"}}
blood: {density: "1060 kg/m^3", viscosity: "4 mPa s"}
openings:
  inlet: {type: flow, profile: plug, waveform: {fourier: {mean: "50 mL/s", period: "1 s", cosines: ["-50 mL/s"], sines: ["0 mL/s"]}}}
  outlet: {type: rcr, proximal_resistance: "1e7 Pa s/m^3", distal_resistance: "1e8 Pa s/m^3", compliance: "1e-9 m^3/Pa", initial_pressure: "0 Pa"}
initial: {velocity: rest}
numerics: {scheme: cells, spacing: "2.5 mm", duration: "0.1 s", steps_per_period: 100}
)");
    const auto scene = build_scene(config);
    const double section = std::numbers::pi * 1e-4;
    advance(*scene, {.until = 0.1, .observe = [&](const Scene& now, const FlowStep&) {
                         if (now.time < 0.05) return;
                         const double omega = 2 * std::numbers::pi, rise = 50e-6 * omega * std::sin(omega * now.time);
                         const double drop = now.ends[0].mean_pressure - now.ends[1].mean_pressure;
                         EXPECT_NEAR(drop / (density * rise * 60e-3 / section), 1, 0.08)
                             << now.time;   // friction is the rest
                     }});
}

TEST(CellMarch, StartsFromTheSteadyFlowOfWhatTheOpeningsDoAtFirst) {
    const auto scene = build_scene(pulsed(open, "0.3 s"));
    const double exact = area * radius * radius * 16 / length / (8 * mu);
    EXPECT_NEAR(scene->ends[1].flow / exact, 1, 0.1);   // eight cells across
    EXPECT_NEAR(scene->laws[1].known_flow, scene->ends[1].flow, 0);
}

// What a step does not come to the end of it does in shorter ones, from where it began, and then lengthens them again.
TEST(CellMarch, TakesAStepThatFailsByHalves) {
    const auto whole = build_scene(pulsed(open, "0.3 s")), halved = build_scene(pulsed(open, "0.3 s"));
    const double step = period / 40;
    whole->scheme->step(0, step), halved->scheme->step(0, step);
    const auto impose = halved->scheme->update_ends;
    halved->scheme->update_ends = [&](std::span<OpenEnd> ends, double time, double dt) {
        impose(ends, time, dt);
        if (dt > 0.3 * step) ends[1].pressure = NAN;   // the solution is lost on its way
    };
    EXPECT_EQ(halved->scheme->step(step, step).dt, 0.25 * step);
    whole->scheme->step(step, 0.25 * step);
    EXPECT_EQ(halved->ends[1].flow, whole->ends[1].flow);
    EXPECT_TRUE(std::equal(whole->fluid.velocity.begin(), whole->fluid.velocity.end(), halved->fluid.velocity.begin()));
    EXPECT_EQ(halved->scheme->state(), whole->scheme->state());
    halved->scheme->update_ends = impose;
    EXPECT_EQ(halved->scheme->step(1.25 * step, step).dt, 0.5 * step);   // twice the last one at most
    halved->scheme->update_ends = [](std::span<OpenEnd> ends, double, double) { ends[1].pressure = NAN; };
    EXPECT_THROW(halved->scheme->step(1.75 * step, step), DivergedError);
}

TEST(RunFlow, APulseOnCellsGoesOnToTheSameBytes) {
    const deck::Case config =
        pulsed(bed, "0.12 s",
               "output: {interval: \"0.05 s\", probes: [{name: middle, point: [\"1 mm\", \"2 mm\", \"-0.5 mm\"]}]}");
    const Folder folder;
    const OutputFolder whole(folder.path / "whole"), out(folder.path / "parts");
    const int threads = omp_get_max_threads();
    ASSERT_EQ(run_flow(config, {.folder = whole}), Outcome::done);
    int steps = 0, runs = 1;
    while (run_flow(config, {.folder = out, .interrupted = [&] { return ++steps % 5 == 0; }}) == Outcome::interrupted)
        omp_set_num_threads(1 + ++runs % 2);
    omp_set_num_threads(threads);
    EXPECT_GT(runs, 2);
    for (const char* name : {"summary.json", "waveforms.csv", "probes.csv", "fluid.pvd"})
        EXPECT_EQ(text_of(whole.file(name)), text_of(out.file(name))) << name;
    for (int frame = 0; frame < 4; ++frame) {
        const auto file = fmt::format("frames/fluid_{:06d}.vtp", frame);
        EXPECT_FALSE(text_of(whole.file(file)).empty());
        EXPECT_EQ(text_of(whole.file(file)), text_of(out.file(file))) << file;
    }
}

// What stays in the vessel is compared with what passes; where a pulse rests nothing does.
TEST(RunFlow, APulseMayRestBetweenBeats) {
    const deck::Case config = deck::parse_case(R"(version: 1
case: {name: rest, mode: periodic, period: "0.4 s"}
geometry: {shape: {type: tube, diameter: "2 mm", length: "6 mm"}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlet: {type: flow, waveform: {times: ["0 s", "0.1 s", "0.2 s", "0.4 s"], values: ["0 mL/min", "30 mL/min", "0 mL/min", "0 mL/min"]}}
  outlet: {type: pressure, pressure: "0 Pa"}
numerics: {scheme: cells, spacing: "0.3 mm", duration: "0.8 s", steps_per_period: 40}
)");
    const Folder folder;
    const OutputFolder out(folder.path);
    EXPECT_EQ(run_flow(config, {.folder = out}), Outcome::done);
    const auto summary = nlohmann::json::parse(text_of(out.file("summary.json")));
    EXPECT_NEAR(double(summary["openings"]["outlet"]["flow_m3_per_s"]), 0.5e-6 * 0.2 / (2 * 0.4), 0.01e-6);
}

// A jet over a step at a Reynolds number of 3000: no steady flow is found, and its means over time are.
TEST(RunFlow, FollowsAFlowWithoutRestInTime) {
    const deck::Case config = deck::parse_case(R"(version: 1
case: {name: jet}
geometry: {shape: {type: step, gap: "2 mm", length: "12 mm", step_height: "1 mm", step_at: "3 mm"}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlet: {type: velocity, profile: parabola, velocity: "5 m/s"}
  outlet: {type: pressure, pressure: "0 Pa"}
numerics: {scheme: cells, spacing: "0.25 mm", duration: "1 s", without_rest: follow}
)");
    const Folder folder;
    const OutputFolder whole(folder.path / "whole"), out(folder.path / "parts");
    ASSERT_EQ(run_flow(config, {.folder = whole}), Outcome::done);
    const auto summary = nlohmann::json::parse(text_of(whole.file("summary.json")));
    EXPECT_TRUE(summary["convergence"]["is_converged"]);
    EXPECT_TRUE(summary["convergence"]["is_mean_over_time"]);
    const double in = -double(summary["openings"]["inlet"]["flow_m3_per_s"]);
    EXPECT_NEAR(in, 5 * 1e-3, 1e-12);   // per metre of depth
    EXPECT_NEAR(double(summary["openings"]["outlet"]["flow_m3_per_s"]) / in, 1, 1e-3);
    // Borda and Carnot: where a section doubles the jet's momentum raises the pressure.
    EXPECT_LT(double(summary["openings"]["inlet"]["mean_pressure_pa"]), 0);
    int steps = 0, runs = 1;   // and it goes on to the same bytes
    while (run_flow(config, {.folder = out, .interrupted = [&] {
                                 return out.has_checkpoint("flow") ? ++steps % 150 == 0 : ++steps % 500 == 0;
                             }}) == Outcome::interrupted)
        ++runs;
    EXPECT_GT(runs, 2);
    EXPECT_EQ(text_of(whole.file("summary.json")), text_of(out.file("summary.json")));
    EXPECT_EQ(text_of(whole.file("waveforms.csv")), text_of(out.file("waveforms.csv")));
}

deck::Case jet(const std::string& speed) {
    return deck::parse_case(R"(version: 1
case: {name: jet}
geometry: {shape: {type: step, gap: "2 mm", length: "12 mm", step_height: "1 mm", step_at: "3 mm"}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlet: {type: velocity, profile: parabola, velocity: ")" +
                            speed + R"("}
  outlet: {type: pressure, pressure: "0 Pa"}
numerics: {scheme: cells, spacing: "0.25 mm", duration: "1 s"}
)");
}

// A slower one is left to come to rest. In how many steps is chance at 3 m/s, 230 to 920 of either kind as its speed differs by some
// percent: in as many as a run may take, here.
TEST(CellScene, FindsTheRestOfAJet) {
    const auto scene = make_solved_scene(jet("3 m/s"));
    EXPECT_TRUE(scene->solution.is_converged);
    EXPECT_LT(scene->solution.history.size(), 400u);
}

// Slower ones come to it the sooner as their last steps are mixed.
TEST(CellScene, FindsTheRestOfSlowerJetsSoonerByMixedSteps) {
    const auto count_steps = [](double mixes_below) {
        std::size_t steps = 0;
        for (const char* speed : {"0.4 m/s", "0.6 m/s", "0.8 m/s", "1 m/s"}) {
            const deck::Case config = jet(speed);
            const Lumen lumen = make_cell_lumen(config);
            const auto scene = make_cell_scene(config, lumen, make_cell_points(lumen, config.numerics.spacing));
            CellSolverSettings settings;
            settings.mixes_below = mixes_below;
            solve_scene(*scene, nullptr, settings);
            EXPECT_TRUE(scene->solution.is_converged) << speed;
            steps += scene->solution.history.size();
        }
        return double(steps);
    };
    EXPECT_LT(count_steps(CellSolverSettings{}.mixes_below), 0.85 * count_steps(0));   // 378 and 491
}

// What rests goes on resting: the march begins with the steady flow's pressures and keeps them.
TEST(CellMarch, KeepsASteadyFlow) {
    const deck::Case config = deck::parse_case(R"(version: 1
case: {name: tube}
geometry: {shape: {type: tube, diameter: "2 mm", length: "6 mm", axis: [1, 2, -0.5]}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlet: {type: velocity, profile: parabola, velocity: "0.05 m/s"}
  outlet: {type: resistance, resistance: "2e8 Pa s/m^3"}
numerics: {scheme: cells, spacing: "0.2 mm", duration: "1 s"}
)");
    const auto solved = make_solved_scene(config);
    const auto scene = build_cell_scene(config, *solved);
    const double drop = scene->ends[0].mean_pressure - scene->ends[1].mean_pressure, flow = scene->ends[1].flow;
    advance(*scene, {.until = 20 * 2e-3 / 0.1,
                     .observe = [&](const Scene& now, const FlowStep&) {   // twenty passages of the diameter
                         EXPECT_NEAR(now.ends[1].flow / flow, 1, 1e-3) << now.time;
                         EXPECT_NEAR((now.ends[0].mean_pressure - now.ends[1].mean_pressure) / drop, 1, 0.02)
                             << now.time;
                     }});
    EXPECT_NEAR(scene->ends[1].flow / flow, 1, 1e-4);
    EXPECT_NEAR((scene->ends[0].mean_pressure - scene->ends[1].mean_pressure) / drop, 1, 0.01);
}

}   // namespace
}   // namespace patency
