// SPDX-License-Identifier: Apache-2.0
#include "stage_runner.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "patency/io/flow_table.h"
#include "patency/io/hash.h"
#include "patency/io/log_file.h"
#include "patency/io/summary.h"
#include "patency/stages/deploy.h"
#include "patency/stages/run_flow.h"

namespace patency::app {

namespace {

void print_log(LogLevel level, std::string_view line) {
    if (level != LogLevel::error) fmt::print(stderr, "{}\n", line);   // errors are main.cpp's to say
}

}   // namespace

Log make_run_log(const OutputFolder& folder, bool goes_on) {
    return make_tee_log(make_file_log(folder.file("log.txt"), goes_on ? LogMode::append : LogMode::begin), print_log);
}

Progress make_progress() {
    const auto print = [](std::string_view text) {
        fmt::print(stderr, "{}", text);
        std::fflush(stderr);
    };
    if (!isatty(STDERR_FILENO)) return Progress(print);
    return Progress(print, {.style = ProgressStyle::terminal, .interval = 0.2, .width = 0, .clock = {}});
}

std::string binary_hash() { return hex_text(hash_file("/proc/self/exe")); }

namespace {

/// job(progress); what throws is in the log.
template <class Job>
auto run_logged(const Log& log, Job job) {
    Progress progress = make_progress();
    try {
        return job(progress);
    } catch (const Error& error) {
        log(LogLevel::error, error.what());
        throw;
    }
}

}   // namespace

ExitCode run_flow_stage(const deck::Case& config, const OutputFolder& folder, const Interruption& interruption,
                        const Log& log) {
    if (!config.solids.empty()) throw DeckError("this deck has solids and no blood; compute it by patency solid");
    const Outcome outcome = run_logged(log, [&](Progress& progress) {
        return run_flow(config, {.folder = folder,
                                 .binary_hash = binary_hash(),
                                 .interrupted = [&] { return interruption.is_wanted(); },
                                 .log = log,
                                 .progress = &progress});
    });
    if (outcome == Outcome::interrupted) return interruption.exit_code();
    fmt::print("{}", flow_table(read_summary(folder.file("summary.json"))));
    return outcome == Outcome::done ? ExitCode::ok : ExitCode::bar_missed;
}

bool is_quasi_static(const nlohmann::ordered_json& deploy) {
    constexpr double most = 0.05;
    return !deploy["kinetic_to_internal"].is_number() || deploy["kinetic_to_internal"].get<double>() < most;
}

ExitCode run_deploy_stage(const deck::Case& config, const OutputFolder& folder, const Interruption& interruption,
                          const Log& log) {
    const bool is_done = run_logged(log, [&](Progress& progress) {
        return run_deploy(config, {.folder = folder,
                                   .binary_hash = binary_hash(),
                                   .interrupted = [&] { return interruption.is_wanted(); },
                                   .log = log,
                                   .progress = &progress});
    });
    if (!is_done) return interruption.exit_code();
    if (is_quasi_static(read_summary(folder.file("summary.json"))["deploy"])) return ExitCode::ok;
    log(LogLevel::warning,
        "the deployment was not quasi-static: its kinetic energy rose above a twentieth of the internal one, so that "
        "recoil, strains and "
        "pressures are provisional; give deployment.steps more");
    return ExitCode::bar_missed;
}

}   // namespace patency::app
