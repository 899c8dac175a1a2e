// SPDX-License-Identifier: Apache-2.0
// What is kept of a flow: the state that a run goes on from, means and the audit of mass, tables, the summary.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/stages/build.h"
#include "patency/stages/flow.h"
#include "patency/stages/flow_recorder.h"
#include "patency/stages/run_flow.h"
#include "patency/stages/scene_state.h"
#include "tests/stages/decks.h"
#include "tests/stages/results_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

constexpr double mean_flow = 2.0 / 3 * 0.165 * 1e-3;   // m2/s of ChannelDeck's inlet

deck::Case parsed(const ChannelDeck& deck) { return deck::parse_case(deck.text()); }

/// All kept fields, as a checkpoint would hold them.
void copy_particles(const ParticleSet& from, ParticleSet& to) {
    to.resize(from.size());
    for (std::size_t f = 0; f < from.fields().size(); ++f) {
        if (from.fields()[f]->keep() != Keep::state) continue;
        const auto bytes = std::as_const(*from.fields()[f]).bytes();
        std::copy(bytes.begin(), bytes.end(), to.fields()[f]->bytes().begin());
    }
}

TEST(SceneState, a_restored_scene_goes_on_with_the_same_bits) {
    ChannelDeck deck;
    deck.outlet =
        "{type: rcr, proximal_resistance: \"1e6 Pa s/m^3\", distal_resistance: \"1e7 Pa s/m^3\", compliance: \"1e-9 "
        "m^3/Pa\"}";
    const deck::Case config = parsed(deck);
    const double middle = 1e-3, end = 2e-3;

    const auto first = build_scene(config);
    advance(*first, {.until = middle});
    const auto second = build_frame(config);
    copy_particles(first->fluid, second->fluid);
    copy_particles(first->wall, second->wall);
    restore_numbers(*second, numbers_of(*first));
    start_scheme(*second);
    // A step and a half: how it is divided depends on the step before the restart.
    const double soon = middle + 1.5 * first->last_dt;
    advance(*second, {.until = end, .exact_times = {soon}});

    const auto whole = build_scene(config);
    advance(*whole, {.until = end, .exact_times = {middle, soon}});

    ASSERT_EQ(second->fluid.size(), whole->fluid.size());
    EXPECT_TRUE(std::equal(whole->fluid.position.begin(), whole->fluid.position.end(), second->fluid.position.begin()));
    EXPECT_TRUE(std::equal(whole->fluid.velocity.begin(), whole->fluid.velocity.end(), second->fluid.velocity.begin()));
    EXPECT_TRUE(std::equal(whole->fluid.pressure.begin(), whole->fluid.pressure.end(), second->fluid.pressure.begin()));
    EXPECT_EQ(numbers_of(*whole), numbers_of(*second));
}

TEST(SceneState, numbers_of_another_case_are_refused) {
    const auto scene = build_frame(parsed({}));
    NamedNumbers numbers = numbers_of(*scene);
    numbers.reals.erase("law_volume_out");
    EXPECT_THROW(restore_numbers(*scene, numbers), CheckpointError);
    numbers = numbers_of(*scene);
    numbers.reals["end_flow"].push_back(0);   // a third opening
    EXPECT_THROW(restore_numbers(*scene, numbers), CheckpointError);
}

TEST(FlowMeans, what_flows_in_flows_out_or_is_compressed) {
    const auto scene = build_scene(parsed({}));
    advance(*scene, {.until = 5e-3});
    const FlowMark from = mark_flow(*scene);
    advance(*scene, {.until = 10e-3});
    const FlowMark to = mark_flow(*scene);
    EXPECT_NEAR(mean_between(from, to, 0, 1e-3).flow, -mean_flow, 0.005 * mean_flow);
    EXPECT_LT(mass_imbalance_percent(from, to), 0.2);   // the bar of design: steady states
}

TEST(FlowMeans, a_mark_knows_a_flow_that_only_compresses) {
    FlowMark from{.time = 0, .volume_out = {0, 0}, .pressure_time = {0, 0}}, to = from;
    to.time = 1;
    to.volume_out = {-3, 1};   // three in, one out: two stay
    EXPECT_EQ(mass_imbalance_percent(from, to), 100);
    to.compressed = 2;
    EXPECT_EQ(mass_imbalance_percent(from, to), 0);
}

TEST(FlowRecorder, rows_of_waveforms_add_up_to_what_flowed) {
    const auto scene = build_scene(parsed({}));
    FlowRecorder recorder(*scene);
    ASSERT_EQ(recorder.tables().front().columns,
              (std::vector<std::string>{"time_s", "inlet_flow_m2_per_s", "inlet_mean_pressure_pa",
                                        "outlet_flow_m2_per_s", "outlet_mean_pressure_pa"}));
    double volume = 0, last = 0;
    recorder.write_row = [&](std::size_t, std::span<const double> row) {
        const double end = 2 * row[0] - last;   // the time is the middle of the row's interval
        volume += row[3] * (end - last);
        last = end;
    };
    advance(*scene,
            {.until = 0.01, .observe = [&](const Scene& s, const FlowStep&) { recorder.observe(s, s.time >= 0.01); }});
    EXPECT_NEAR(last, 0.01, 1e-12);                                   // rounded once a row
    EXPECT_NEAR(volume, scene->laws[1].volume_out, 1e-12 * volume);   // sums of as many differences as rows
}

/// A row stands at the middle of what it is a mean of, which may lie before a checkpoint that knows nothing of it.
TEST(FlowRecorder, a_state_tells_which_rows_it_has_written) {
    ChannelDeck deck;
    deck.duration = "4 s";   // so that steps are many in a row
    const auto scene = build_scene(parsed(deck));
    FlowRecorder recorder(*scene);
    std::vector<double> rows;
    recorder.write_row = [&](std::size_t, std::span<const double> row) { rows.push_back(row[0]); };
    std::vector<std::pair<double, std::size_t>> states;   // after every step
    advance(*scene, {.until = 0.02, .observe = [&](const Scene& s, const FlowStep&) {
                         recorder.observe(s, s.time >= 0.02);
                         states.push_back({recorder.last_row_of(0, s.time), rows.size()});
                     }});
    ASSERT_GT(rows.size(), 2u);
    ASSERT_GT(states.size(), 4 * rows.size());
    for (const auto& [last, written] : states)
        EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [&](double time) { return time <= last; }), written);
}

TEST(FlowRecorder, a_profile_is_written_at_its_time_and_only_inside) {
    ChannelDeck deck;
    deck.more = R"(output:
  profiles: [{name: middle, from: ["2 mm", "-0.5 mm", "0 mm"], to: ["2 mm", "1.5 mm", "0 mm"], points: 9, times: ["0 s", "3 ms"]}]
)";
    const auto scene = build_scene(parsed(deck));
    FlowRecorder recorder(*scene);
    std::vector<std::vector<double>> rows;
    recorder.write_row = [&](std::size_t table, std::span<const double> row) {
        if (table == 1) rows.emplace_back(row.begin(), row.end());
    };
    recorder.begin(*scene);
    ASSERT_EQ(rows.size(), 5u);
    EXPECT_EQ(rows.front()[0], 0);
    rows.clear();
    FlowRun run{.until = 0.01, .exact_times = recorder.exact_times()};
    run.observe = [&](const Scene& s, const FlowStep&) { recorder.observe(s, s.time >= 0.01); };
    advance(*scene, run);
    ASSERT_EQ(rows.size(), 5u);   // of nine places a quarter millimetre apart, y = 0, 0.25, .. 1 mm are in the gap
    for (const auto& row : rows) {
        const double y = row[3], exact = 4 * 0.165 * y * (1e-3 - y) / 1e-6;
        EXPECT_EQ(row[0], 3e-3);
        EXPECT_NEAR(row[5], exact, 0.01 * 0.165) << y;   // the flow's own accuracy, as in flow_test.cpp
    }
}

TEST(FlowRecorder, probes_outside_the_blood_are_refused) {
    ChannelDeck deck;
    deck.more = "output: {probes: [{name: lost, point: [\"2 mm\", \"1.2 mm\", \"0 mm\"]}]}\n";
    const auto scene = build_scene(parsed(deck));
    EXPECT_THROW(FlowRecorder{*scene}, DeckError);
}

TEST(Summary, refuses_numbers_that_are_none) {
    const auto scene = build_scene(parsed({}));
    const FlowMark from = mark_flow(*scene);
    advance(*scene, {.until = 1e-3});
    EXPECT_NO_THROW(make_summary(*scene, from));
    scene->laws[0].volume_out = NAN;
    EXPECT_THROW(make_summary(*scene, from), DivergedError);
}

TEST(RunFlow, threads_do_not_change_the_summary) {
    Folder folder;
    ChannelDeck deck;
    deck.duration = "2 ms";
    std::string first;
    for (const int threads : {1, 2, 3, 4}) {
        omp_set_num_threads(threads);
        const OutputFolder out(folder.path);
        out.clear();
        EXPECT_EQ(run_flow(parsed(deck), {.folder = out}), Outcome::done);
        const std::string text = text_of(folder.path / "summary.json");
        EXPECT_FALSE(text.empty());
        if (first.empty()) first = text;
        EXPECT_EQ(text, first) << threads << " threads";
    }
    omp_set_num_threads(omp_get_num_procs());
}

TEST(RunFlow, keeps_the_contract_of_its_files) {
    Folder folder;
    ChannelDeck deck;
    deck.duration = "2 ms";
    run_flow(parsed(deck), {.folder = OutputFolder(folder.path)});
    const auto summary = nlohmann::json::parse(text_of(folder.path / "summary.json"));
    for (const char* key :
         {"pressure_datum", "gauge_pressure_ratio", "mass_imbalance_percent", "acoustic_steps", "scheme"})
        EXPECT_TRUE(summary.contains(key)) << key;
    EXPECT_EQ(summary["pressure_datum"], "gauge");
    EXPECT_TRUE(summary["ffr"]["lesion"].is_null());
    EXPECT_FALSE(summary["ffr"]["reason"].get<std::string>().empty());
    for (const char* key : {"flow_m3_per_s", "mean_pressure_pa", "mean_velocity_m_per_s"})
        EXPECT_TRUE(summary["openings"]["outlet"].contains(key)) << key;
    for (const char* key : {"fluid", "wall", "across_narrowest"})
        EXPECT_TRUE(summary["particles"].contains(key)) << key;
    const auto timing = nlohmann::json::parse(text_of(folder.path / "timing.json"));
    EXPECT_TRUE(timing["flow"].contains("cpu_s") && timing["flow"].contains("wall_s"));
    for (const char* name : {"fluid.pvd", "frames/fluid_000000.vtp", "checkpoint/flow.h5", "waveforms.csv"})
        EXPECT_TRUE(fs::exists(folder.path / name)) << name;
    // The resolved deck is the case again.
    EXPECT_EQ(deck::read_case(folder.path / "case.resolved.yaml"), parsed(deck));
}

/// A deck whose results have everything that a resumed run must go on with.
ChannelDeck busy_deck() {
    ChannelDeck deck;
    deck.duration = "3 ms";
    deck.outlet =
        "{type: rcr, proximal_resistance: \"1e6 Pa s/m^3\", distal_resistance: \"1e7 Pa s/m^3\", compliance: \"1e-9 "
        "m^3/Pa\"}";
    deck.more = R"(output:
  interval: "0.7 ms"
  average_from: "1 ms"
  probes: [{name: middle, point: ["2 mm", "0.5 mm", "0 mm"]}]
  profiles: [{name: middle, from: ["2 mm", "0 mm", "0 mm"], to: ["2 mm", "1 mm", "0 mm"], points: 5, times: ["0.5 ms", "2.5 ms"]}]
)";
    return deck;
}

const std::vector<std::string> compared_files{"summary.json",
                                              "waveforms.csv",
                                              "probes.csv",
                                              "profile_middle.csv",
                                              "fluid.pvd",
                                              "frames/fluid_000000.vtp",
                                              "frames/fluid_000003.vtp",
                                              "frames/fluid_000005.vtp"};

/// The files of a run that is interrupted every few steps are those of one that is not.
void expect_same_bytes_when_interrupted(const deck::Case& config, const std::vector<std::string>& files) {
    Folder folder;
    std::map<std::string, std::string> whole;
    {
        const OutputFolder out(folder.path);
        run_flow(config, {.folder = out});
        for (const std::string& name : files) {
            whole[name] = text_of(folder.path / name);
            EXPECT_FALSE(whole[name].empty()) << name;
        }
        out.clear();
    }
    const OutputFolder out(folder.path);
    int steps = 0;
    while (run_flow(config, {.folder = out, .interrupted = [&] { return ++steps % 4 == 0; }}) == Outcome::interrupted)
        EXPECT_FALSE(fs::exists(folder.path / "summary.json"));
    EXPECT_GT(steps, 8);   // it was interrupted more than once
    for (const std::string& name : files) EXPECT_EQ(text_of(folder.path / name), whole[name]) << name;
    // Again from the end: the same summary, nothing computed.
    run_flow(config, {.folder = out});
    EXPECT_EQ(text_of(folder.path / "summary.json"), whole["summary.json"]);
}

TEST(RunFlow, an_interrupted_run_goes_on_to_the_same_bytes) {
    expect_same_bytes_when_interrupted(parsed(busy_deck()), compared_files);
}

// Whose entrance has an excess of its own.
TEST(RunFlow, an_interrupted_run_with_an_entrance_goes_on_to_the_same_bytes) {
    expect_same_bytes_when_interrupted(deck::parse_case(PlugDeck{"4 mm", "0.25 mm", "6 ms"}.text()),
                                       {"summary.json", "waveforms.csv"});
}

TEST(RunFlow, what_was_written_after_the_checkpoint_is_dropped) {
    Folder folder;
    const deck::Case config = parsed(busy_deck());
    const OutputFolder out(folder.path);
    // Checkpoints at every step, of which an early one is put back: as if the rest of the run had been killed.
    int steps = 0;
    const FlowStage early{.folder = out, .interrupted = [&] { return ++steps == 5; }};
    EXPECT_EQ(run_flow(config, early), Outcome::interrupted);
    const std::string checkpoint = text_of(folder.path / "checkpoint/flow.h5");
    run_flow(config, {.folder = out});
    std::map<std::string, std::string> whole;
    for (const std::string& name : compared_files) whole[name] = text_of(folder.path / name);
    std::ofstream(folder.path / "checkpoint/flow.h5", std::ios::binary) << checkpoint;
    run_flow(config, {.folder = out});
    for (const std::string& name : compared_files) EXPECT_EQ(text_of(folder.path / name), whole[name]) << name;
}

TEST(RunFlow, a_checkpoint_of_another_deck_is_refused) {
    Folder folder;
    const OutputFolder out(folder.path);
    ChannelDeck deck;
    deck.duration = "1 ms";
    run_flow(parsed(deck), {.folder = out});
    deck.duration = "2 ms";
    EXPECT_THROW(run_flow(parsed(deck), {.folder = out}), CheckpointError);
    EXPECT_THROW(run_flow(parsed(ChannelDeck{.duration = "1 ms"}), {.folder = out, .binary_hash = "another"}),
                 CheckpointError);
}

TEST(RunFlow, an_interrupted_run_leaves_no_summary) {
    Folder folder;
    EXPECT_EQ(run_flow(parsed({}), {.folder = OutputFolder(folder.path), .interrupted = [] { return true; }}),
              Outcome::interrupted);
    EXPECT_FALSE(fs::exists(folder.path / "summary.json"));
    EXPECT_TRUE(fs::exists(folder.path / "checkpoint/flow.h5"));
}

TEST(RunFlow, a_flow_that_diverges_leaves_its_offenders) {
    Folder folder;
    ChannelDeck deck;
    deck.numerics = "reference_speed: \"1 mm/s\", sound_speed: \"2 m/s\"";
    EXPECT_THROW(run_flow(parsed(deck), {.folder = OutputFolder(folder.path)}), DivergedError);
    EXPECT_TRUE(fs::exists(folder.path / "offenders.vtp"));
    EXPECT_FALSE(fs::exists(folder.path / "summary.json"));
}

TEST(RunFlow, fields_that_the_blood_has_not_are_refused) {
    Folder folder;
    ChannelDeck deck;
    deck.more = "output: {fields: [velocity, colour]}\n";
    EXPECT_THROW(run_flow(parsed(deck), {.folder = OutputFolder(folder.path)}), DeckError);
}

}   // namespace
}   // namespace patency
