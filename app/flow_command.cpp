// SPDX-License-Identifier: Apache-2.0
// patency flow: the flow stage with its log, its progress line and its signals.
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>

#include "commands.h"
#include "deck_options.h"
#include "patency/stages/result_files.h"
#include "patency/stages/run_flow.h"

namespace patency::app {

namespace {

std::atomic<int> caught_signal{0};
void note_signal(int signal) {
    caught_signal = signal;
    std::signal(signal, SIG_DFL);   // a second one ends the program at once
}

/// Rewrites one line on a terminal; elsewhere writes a line every half minute.
class ProgressLine {
public:
    void show(const FlowProgress& p) {
        const bool is_end = p.time >= p.duration;
        if (!is_end && p.wall_seconds < next_) return;
        next_ = p.wall_seconds + (is_terminal_ ? 0.2 : 30);
        const double left = p.time > 0 ? p.wall_seconds * (p.duration - p.time) / p.time : 0;
        const std::string line = fmt::format("flow {:5.1f} %  t {:.4g} s  step {}  in - out {:+.3g} m3/s  {:.0f} s left", 100 * p.time / p.duration,
                                             p.time, p.steps, p.inflow_less_outflow, left);
        if (is_terminal_) fmt::print(stderr, "\r\x1b[K{}{}", line, is_end ? "\n" : "");
        else fmt::print(stderr, "{}\n", line);
        std::fflush(stderr);
    }

private:
    bool is_terminal_ = isatty(STDERR_FILENO);
    double next_ = 0;
};

struct FlowOptions {
    DeckOptions deck;
    std::string out;
};

ExitCode run(const FlowOptions& options) {
    const deck::Case config = options.deck.read();
    const int threads = options.deck.apply_threads(config);
    const std::filesystem::path out = options.out;
    open_result_folder(out);

    const auto console = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    console->set_pattern("%v");
    std::shared_ptr<spdlog::sinks::basic_file_sink_mt> file;
    try {
        file = std::make_shared<spdlog::sinks::basic_file_sink_mt>((out / "log.txt").string(), true);
    } catch (const spdlog::spdlog_ex& error) {
        throw FileError(error.what());
    }
    spdlog::logger log("patency", {console, file});
    log.flush_on(spdlog::level::info);
    log.info("{} on {} threads", options.deck.path, threads);

    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
    ProgressLine progress;
    const FlowStage stage{.out = out,
                          .interrupted = [] { return caught_signal != 0; },
                          .say = [&](std::string_view line) { log.info("{}", line); },
                          .show = [&](const FlowProgress& p) { progress.show(p); }};
    try {
        if (run_flow(config, stage) == Outcome::done) return ExitCode::ok;
    } catch (const Error& error) {
        file->log({"patency", spdlog::level::err, error.what()});   // on the terminal main.cpp says it
        file->flush();
        throw;
    }
    return caught_signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

}  // namespace

void add_flow_command(CLI::App& program, ExitCode& exit_code) {
    CLI::App* command = program.add_subcommand("flow", "compute the blood flow");
    const auto options = std::make_shared<FlowOptions>();
    options->deck.add_to(*command);
    command->add_option("-o,--out", options->out, "the folder for the results")->required();
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace patency::app
