// SPDX-License-Identifier: Apache-2.0
// The program from outside: exit codes and what it says.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "patency/io/surface_file.h"
#include "tests/app/program.h"
#include "tests/shape/surfaces.h"
#include "tests/stages/decks.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Commands : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  fmt::format("patency_app_{}", ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string write(const std::string& text) const {
        std::ofstream(folder_ / "case.yaml") << text;
        return (folder_ / "case.yaml").string();
    }
    std::string out() const { return (folder_ / "out").string(); }
    fs::path folder_;
};

TEST_F(Commands, version_and_schema_answer) {
    EXPECT_EQ(patency("version").exit_code, 0);
    EXPECT_EQ(patency("--version").exit_code, 0);
    const Result schema = patency("schema");
    EXPECT_EQ(schema.exit_code, 0);
    EXPECT_NE(schema.output.find("\"$schema\""), std::string::npos);
}

TEST_F(Commands, bound_threads_keep_all_cores) {
    // The program starts itself again; libgomp prints its places in both.
    const std::string output =
        run_command(fmt::format("OMP_PROC_BIND=true OMP_DISPLAY_ENV=true '{}' version", PATENCY_BINARY)).output;
    std::vector<std::string> places;
    for (std::size_t at = output.find("OMP_PLACES"); at != std::string::npos; at = output.find("OMP_PLACES", at + 1))
        places.push_back(output.substr(at, output.find('\n', at) - at));
    ASSERT_EQ(places.size(), 2u) << output;
    EXPECT_EQ(places[0], places[1]);
}

TEST_F(Commands, a_wrong_command_line_is_2) {
    EXPECT_EQ(patency("").exit_code, 2);
    EXPECT_EQ(patency("flwo").exit_code, 2);
    EXPECT_EQ(patency("flow").exit_code, 2);
    EXPECT_EQ(patency("stent show nix").exit_code, 2);
    EXPECT_EQ(patency("--help").exit_code, 0);
}

TEST_F(Commands, a_misspelt_opening_is_told_with_its_place_and_the_other_mistakes) {
    const std::string rest = R"(blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings:
  inlett: {type: velocity, velocity: "0.1 m/s"}
  outlet: {type: pressure, pressure: "0 mmHg"}
numerics: {scheme: sph, spacing: "0.2 mm", duration: "1 s"}
)";
    const std::string shape = "version: 1\ngeometry: {shape: {type: tube, diameter: \"3 mm\", length: \"9 mm\"}}\n";
    const std::string sentence = "5:3: openings.inlett: the lumen has no such opening. Did you mean \"inlet\"?";
    for (const char* command : {"check ", "flow -o out ", "estimate "}) {
        const Result alone = patency(command + write(shape + rest));
        EXPECT_EQ(alone.exit_code, 3) << command;
        EXPECT_NE(alone.output.find(sentence), std::string::npos) << alone.output;
        EXPECT_NE(alone.output.find("1 mistake;"), std::string::npos) << alone.output;
    }
    const Result two = patency("check --set numerics.duratoin=1s " + write(shape + rest));
    EXPECT_NE(two.output.find(sentence), std::string::npos) << two.output;
    EXPECT_NE(two.output.find("numerics.duratoin"), std::string::npos) << two.output;
    // Of a network and of a surface, whose openings are its own.
    std::ofstream(folder_ / "tube.json") << R"({"unit": "mm", "blend_width_k": 0.1,
  "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.5], [3, 0, 0, 1.5], [9, 0, 0, 1.5], [14, 0, 0, 1.5]]}],
  "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.5},
           "outlet": {"point": [12, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.5}}})";
    const Result network = patency("check " + write("version: 1\ngeometry: {network: tube.json}\n" + rest));
    EXPECT_EQ(network.exit_code, 3);
    EXPECT_NE(network.output.find(sentence), std::string::npos) << network.output;
    write_surface(folder_ / "tube.vtp", make_tube_mesh({.radius = 1.5e-3, .length = 9e-3}));
    const Result surface = patency("check " + write("version: 1\ngeometry: {surface: tube.vtp, unit: mm}\n" + rest));
    EXPECT_EQ(surface.exit_code, 3);
    EXPECT_NE(surface.output.find(sentence), std::string::npos) << surface.output;
    EXPECT_NE(surface.output.find("6:3: openings.outlet: the lumen has no such opening. Did you mean \"outlet_1\"?"),
              std::string::npos)
        << surface.output;
}

TEST_F(Commands, solids_are_computed_and_every_wrong_way_says_so) {
    const std::string text = R"(version: 1
solids:
  - name: block
    shape: {type: box, from: [0 mm, 0 mm, 0 mm], to: [4 mm, 4 mm, 0 mm]}
    material: {law: neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
    velocity: [0 m/s, -1 m/s, 0 m/s]
contacts: [{solid: block, plane: {point: [0 mm, -0.1 mm, 0 mm], normal: [0, 1, 0]}}]
numerics: {spacing: 1 mm, duration: 1 ms, solid: {plane_strain: true}}
output: {interval: 0.5 ms}
)";
    const std::string deck = write(text);
    const Result check = patency("check " + deck);
    EXPECT_EQ(check.exit_code, 0);
    EXPECT_NE(check.output.find("16 particles"), std::string::npos) << check.output;
    const Result run = patency("solid " + deck + " -o " + out());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_TRUE(fs::exists(folder_ / "out" / "frames" / "block_000002.vtp"));
    EXPECT_NE(content(folder_ / "out" / "summary.json").find("largest_penetration_m"), std::string::npos);
    const std::string summary = content(folder_ / "out" / "summary.json"),
                      energies = content(folder_ / "out" / "energies.csv");
    EXPECT_EQ(patency("run " + deck + " --fresh --threads 2 -o " + out()).exit_code, 0);
    EXPECT_EQ(content(folder_ / "out" / "summary.json"), summary) << "the same numbers for any number of threads";
    EXPECT_EQ(content(folder_ / "out" / "energies.csv"), energies);
    EXPECT_EQ(patency("flow " + deck + " -o " + (folder_ / "flow").string()).exit_code, 3);
    const std::string hurled = "solid " + deck + " --set 'solids.0.velocity=[0 m/s, -400 m/s, 0 m/s]' -o " + out();
    EXPECT_EQ(patency(hurled).exit_code, 8) << "the checkpoint is another deck's";
    const Result fast = patency(hurled + " --fresh");
    EXPECT_EQ(fast.exit_code, 5) << fast.output;
    EXPECT_NE(fast.output.find("inside out at t ="), std::string::npos) << fast.output;
    EXPECT_TRUE(fs::exists(folder_ / "out" / "offenders.vtp"));
    EXPECT_FALSE(fs::exists(folder_ / "out" / "summary.json"));
}

TEST_F(Commands, all_mistakes_of_a_deck_come_at_once_and_are_3) {
    std::string text = ChannelDeck{}.text();
    text.replace(text.find("3.5 mPa s"), 9, "3.5 mmHg ");
    text.replace(text.find("duration"), 8, "duratoin");
    const Result result = patency("check " + write(text));
    EXPECT_EQ(result.exit_code, 3) << result.output;
    EXPECT_NE(result.output.find("Did you mean \"duration\"?"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("blood.viscosity"), std::string::npos) << result.output;
}

TEST_F(Commands, check_says_what_a_case_costs_and_writes_nothing) {
    const Result result = patency("check " + write(ChannelDeck{}.text()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    for (const char* word : {"Reynolds", "sound speed", "particles", "memory", "expected time"})
        EXPECT_NE(result.output.find(word), std::string::npos) << word;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}), 1);   // the deck
}

TEST_F(Commands, a_missing_deck_is_7) { EXPECT_EQ(patency("check " + (folder_ / "none.yaml").string()).exit_code, 7); }

TEST_F(Commands, a_surface_that_is_not_there_is_7_and_one_that_is_no_vessel_4) {
    std::string text = ChannelDeck{}.text();
    const std::string shape = "shape: {type: channel, gap: \"1 mm\", length: \"4 mm\"}";
    text.replace(text.find(shape), shape.size(), "surface: lumen.stl, unit: mm");
    text.replace(text.find("initial: {velocity: parabola, speed: \"0.11 m/s\", pressure: linear}\n"), 66, "");
    EXPECT_EQ(patency("check " + write(text)).exit_code, 7);
    std::ofstream(folder_ / "lumen.stl") << "solid flake\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                            "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid flake\n";
    EXPECT_EQ(patency("check " + write(text)).exit_code, 4);
    EXPECT_EQ(patency("estimate " + write(text)).exit_code, 4);
}

TEST_F(Commands, flow_writes_its_results) {
    const Result result = patency(
        fmt::format("flow {} -o {} --threads 1 --set 'numerics.duration=1 ms'", write(ChannelDeck{}.text()), out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    for (const char* name : {"summary.json", "timing.json", "waveforms.csv", "log.txt", "case.resolved.yaml",
                             "fluid.pvd", "checkpoint/flow.h5"})
        EXPECT_TRUE(fs::exists(folder_ / "out" / name)) << name;
}

TEST_F(Commands, run_puts_its_stages_into_folders_and_what_they_say_together) {
    const Result result = patency(
        fmt::format("run {} -o {} --threads 1 --set 'numerics.duration=1 ms'", write(ChannelDeck{}.text()), out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    for (const char* name : {"summary.json", "timing.json", "log.txt", "before/summary.json", "before/waveforms.csv"})
        EXPECT_TRUE(fs::exists(folder_ / "out" / name)) << name;
    EXPECT_NE(content(folder_ / "out" / "summary.json").find("\"before\""), std::string::npos);
    // Again: it goes on from its end, and says the same.
    const std::string first = content(folder_ / "out" / "summary.json");
    EXPECT_EQ(patency(fmt::format("run {} -o {} --threads 1 --set 'numerics.duration=1 ms'",
                                  write(ChannelDeck{}.text()), out()))
                  .exit_code,
              0);
    EXPECT_EQ(content(folder_ / "out" / "summary.json"), first);
}

TEST_F(Commands, a_flow_that_does_not_settle_is_6_and_has_results) {
    ChannelDeck deck;
    deck.duration = "4 ms", deck.initial = "{velocity: rest}";
    deck.numerics = "convergence: {tolerance_percent: 1e-6, window: \"0.5 ms\"}";
    const Result result = patency(fmt::format("flow {} -o {} --threads 1", write(deck.text()), out()));
    EXPECT_EQ(result.exit_code, 6) << result.output;
    EXPECT_NE(result.output.find("not settled"), std::string::npos) << result.output;
    EXPECT_NE(content(folder_ / "out" / "summary.json").find("\"is_converged\": false"), std::string::npos);
}

TEST_F(Commands, a_foreign_folder_is_7) {
    fs::create_directories(out());
    std::ofstream(folder_ / "out" / "thesis.txt") << "all of it";
    EXPECT_EQ(patency(fmt::format("flow {} -o {}", write(ChannelDeck{}.text()), out())).exit_code, 7);
}

TEST_F(Commands, a_flow_that_runs_away_is_5) {
    ChannelDeck deck;
    deck.numerics = "reference_speed: \"1 mm/s\", sound_speed: \"2 m/s\"";
    const Result result = patency(fmt::format("flow {} -o {} --threads 1", write(deck.text()), out()));
    EXPECT_EQ(result.exit_code, 5) << result.output;
    EXPECT_FALSE(fs::exists(folder_ / "out" / "summary.json"));
}

TEST_F(Commands, an_interrupt_is_130_and_a_termination_143) {
    const std::string deck =
        write(ChannelDeck{.across = 25, .duration = "10 s"}.text());   // minutes, were it not stopped
    const auto stopped_by = [&](int signal) {
        const pid_t child = fork();
        if (child == 0) {
            std::freopen("/dev/null", "w", stderr);
            execl(PATENCY_BINARY, "patency", "flow", deck.c_str(), "-o", out().c_str(), "--threads", "1", nullptr);
            _exit(99);
        }
        // Once there are waveforms it computes.
        for (int wait = 0; wait < 300 && !fs::exists(folder_ / "out" / "waveforms.csv"); ++wait) usleep(100000);
        kill(child, signal);
        int status = 0;
        waitpid(child, &status, 0);
        fs::remove(folder_ / "out" / "waveforms.csv");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    };
    EXPECT_EQ(stopped_by(SIGINT), 130);
    EXPECT_EQ(stopped_by(SIGTERM), 143);
}

TEST_F(Commands, a_killed_run_goes_on_to_the_same_summary) {
    const std::string deck =
        write(ChannelDeck{.duration = "60 ms", .more = "output: {checkpoint_interval: \"1 ms\"}\n"}.text());
    const std::string whole = (folder_ / "whole").string();
    ASSERT_EQ(patency(fmt::format("flow {} -o {} --threads 2", deck, whole)).exit_code, 0);

    const pid_t child = fork();
    if (child == 0) {
        std::freopen("/dev/null", "w", stderr);
        execl(PATENCY_BINARY, "patency", "flow", deck.c_str(), "-o", out().c_str(), "--threads", "1", nullptr);
        _exit(99);
    }
    for (int wait = 0; wait < 3000 && !fs::exists(folder_ / "out" / "checkpoint" / "flow.h5"); ++wait) usleep(10000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ASSERT_FALSE(fs::exists(folder_ / "out" / "summary.json")) << "killed too late to tell anything";

    const Result resumed = patency(fmt::format("flow {} -o {} --threads 1", deck, out()));
    EXPECT_EQ(resumed.exit_code, 0);
    EXPECT_NE(resumed.output.find("goes on at"), std::string::npos) << resumed.output;
    EXPECT_EQ(content(folder_ / "out" / "summary.json"), content(folder_ / "whole" / "summary.json"));
}

/// A steady flow on cells leaves no checkpoint; its results are as dear.
TEST_F(Commands, other_results_are_replaced_only_if_asked) {
    const std::string deck = fmt::format("{}/cases/coronary_bifurcation.yaml", PATENCY_SOURCE_DIR);
    const auto flow = [&](const std::string& more) {
        return patency(fmt::format("flow {} -o {} --threads 1 --set numerics.across=5 {}", deck, out(), more))
            .exit_code;
    };
    const std::string estimate = fmt::format("estimate {} -o {}", deck, out()),
                      other = "--set openings.inlet.velocity='0.3 m/s'";
    EXPECT_EQ(patency(estimate).exit_code, 0);
    EXPECT_EQ(flow(""), 0);   // an estimate is a second's work
    const std::string summary = content(folder_ / "out" / "summary.json");
    EXPECT_EQ(patency(estimate).exit_code, 8);
    EXPECT_EQ(flow(other), 8);
    for (const char* command : {"deploy", "deploy --mode geometric", "solid"})   // which this deck has nothing for
        EXPECT_EQ(patency(fmt::format("{} {} -o {}", command, deck, out())).exit_code, 8) << command;
    EXPECT_EQ(content(folder_ / "out" / "summary.json"), summary);
    EXPECT_EQ(flow(other + " --fresh"), 0);
}

TEST_F(Commands, an_ffr_that_no_vessel_can_have_is_warned_of) {
    const Result result =
        patency(fmt::format("flow {}/cases/coronary_bifurcation.yaml -o {} --threads 1 --set numerics.across=5 --set "
                            "'aorta.pressure=1 mmHg'",
                            PATENCY_SOURCE_DIR, out()));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_EQ(result.output.find("none that a vessel can have"), std::string::npos) << result.output;   // 0.5
    const Result none =
        patency(fmt::format("flow {}/cases/coronary_bifurcation.yaml -o {} --threads 1 --set numerics.across=5 --set "
                            "'aorta.pressure=10 Pa'",
                            PATENCY_SOURCE_DIR, (folder_ / "none").string()));
    EXPECT_NE(none.output.find("none that a vessel can have"), std::string::npos) << none.output;
}

TEST_F(Commands, what_check_calls_right_a_flow_can_begin) {
    const std::string deck = fmt::format("{}/cases/coronary_bifurcation.yaml", PATENCY_SOURCE_DIR);
    const auto check = [&](const std::string& more) { return patency(fmt::format("check {} {}", deck, more)); };
    EXPECT_EQ(check("").exit_code, 0);
    EXPECT_NE(check("").output.find("Reynolds number"), std::string::npos);
    EXPECT_EQ(check("--set geometry.lesion.branch=lad").exit_code, 3);
    EXPECT_EQ(check("--set geometry.unit=cm").exit_code, 3);
    EXPECT_EQ(check("--set 'case={name: a, mode: periodic, period: 0.8 s}' "
                    "--set 'openings.inlet={type: flow, waveform: {file: none.csv}}'")
                  .exit_code,
              7);
    EXPECT_NE(check("--set openings.inlet.velocity='30 m/s'").output.find("turbulent"), std::string::npos);
}

TEST_F(Commands, another_decks_checkpoint_is_8_unless_begun_anew) {
    const std::string deck = write(ChannelDeck{}.text());
    const auto flow = [&](const std::string& more) {
        return patency(fmt::format("flow {} -o {} --threads 1 {}", deck, out(), more)).exit_code;
    };
    EXPECT_EQ(flow("--set 'numerics.duration=1 ms'"), 0);
    EXPECT_EQ(flow("--set 'numerics.duration=2 ms'"), 8);
    EXPECT_EQ(flow("--set 'numerics.duration=2 ms' --fresh"), 0);
}

}   // namespace
}   // namespace patency
