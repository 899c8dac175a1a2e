// SPDX-License-Identifier: Apache-2.0
// patency flow: the flow stage with its log, its progress line and its signals.
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "deck_options.h"
#include "patency/io/flow_table.h"
#include "patency/io/hash.h"
#include "patency/io/log_file.h"
#include "patency/io/summary.h"
#include "patency/stages/run_flow.h"

namespace patency::app {

namespace {

std::atomic<int> caught_signal{0};
void note_signal(int signal) {
    caught_signal = signal;
    std::signal(signal, SIG_DFL);   // a second one ends the program at once
}

struct FlowOptions {
    DeckOptions deck;
    std::string out;
    bool fresh = false;
};

Progress make_progress() {
    const auto print = [](std::string_view text) {
        fmt::print(stderr, "{}", text);
        std::fflush(stderr);
    };
    if (!isatty(STDERR_FILENO)) return Progress(print);
    return Progress(print, {.style = ProgressStyle::terminal, .interval = 0.2, .width = 0, .clock = {}});
}

void print_log(LogLevel, std::string_view line) { fmt::print(stderr, "{}\n", line); }

ExitCode run(const FlowOptions& options) {
    const deck::Case config = options.deck.read();
    const int threads = options.deck.apply_threads(config);
    const OutputFolder folder(options.out);
    const bool goes_on = !options.fresh && folder.has_checkpoint("flow");
    if (!goes_on) folder.clear();
    const Log file = make_file_log(folder.file("log.txt"), goes_on ? LogMode::append : LogMode::begin);
    const Log log = make_tee_log(file, print_log);
    log(LogLevel::info, fmt::format("{} on {} threads", options.deck.path, threads));

    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
    Progress progress = make_progress();
    try {
        const Outcome outcome = run_flow(config, {.folder = folder,
                                                  .binary_hash = hex_text(hash_file("/proc/self/exe")),
                                                  .interrupted = [] { return caught_signal != 0; },
                                                  .log = log,
                                                  .progress = &progress});
        if (outcome != Outcome::interrupted) fmt::print("{}", flow_table(read_summary(folder.file("summary.json"))));
        if (outcome == Outcome::done) return ExitCode::ok;
        if (outcome == Outcome::unsettled) {
            log(LogLevel::warning, "the flow had not settled at the end of numerics.duration; the results are marked, a longer duration will do");
            return ExitCode::bar_missed;
        }
    } catch (const Error& error) {
        file(LogLevel::error, error.what());   // on the terminal main.cpp says it
        throw;
    }
    return caught_signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

}  // namespace

void add_flow_command(CLI::App& program, ExitCode& exit_code) {
    CLI::App* command = program.add_subcommand("flow", "compute the blood flow");
    const auto options = std::make_shared<FlowOptions>();
    options->deck.add_to(*command);
    command->add_option("-o,--out", options->out, "the folder for the results; a run that was interrupted there goes on")->required();
    command->add_flag("--fresh", options->fresh, "begin anew instead of going on");
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace patency::app
