// SPDX-License-Identifier: Apache-2.0
#include "stage_runner.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "patency/io/flow_table.h"
#include "patency/io/hash.h"
#include "patency/io/log_file.h"
#include "patency/io/summary.h"
#include "patency/stages/deploy.h"
#include "patency/stages/deploy_doubts.h"
#include "patency/stages/flow_checkpoint.h"
#include "patency/stages/run_flow.h"

namespace patency::app {

namespace {

using Json = nlohmann::ordered_json;

void print_log(LogLevel level, std::string_view line) {
    if (level != LogLevel::error) fmt::print(stderr, "{}\n", line);   // errors are main.cpp's to say
}

/// What a folder's results say that they were made from; null where there are none, or none that cost more than a second.
Json origin_of_results(const OutputFolder& folder) {
    for (const char* name : {"origin.json", "sweep.json"})
        if (std::filesystem::exists(folder.file(name))) return Json(name);
    if (!std::filesystem::exists(folder.file("summary.json"))) return nullptr;
    const Json summary = read_summary(folder.file("summary.json"));
    if (!summary.is_object()) return nullptr;
    if (summary.contains("made_from")) return summary["made_from"];
    if (summary.contains("solids")) return Json("solids");
    const bool is_implanted = summary.contains("deploy") && summary["deploy"].value("is_mechanical", false);
    return is_implanted ? Json("deploy") : Json(nullptr);
}

}   // namespace

void expect_no_other_results(const OutputFolder& folder, const deck::Case& config) {
    const Json known = origin_of_results(folder);
    if (!known.is_null() && known != origin_summary(origin_of(config, binary_hash())))
        throw CheckpointError(fmt::format(
            "'{}' holds results of another deck, other inputs, another command or another version of the program; "
            "--fresh replaces them",
            folder.root().string()));
}

void expect_no_results(const OutputFolder& folder, std::string_view advice) {
    if (!origin_of_results(folder).is_null())
        throw CheckpointError(
            fmt::format("'{}' holds results of another command, which this one would replace; choose another folder{}",
                        folder.root().string(), advice));
}

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
    const Json summary = read_summary(folder.file("summary.json"));
    fmt::print("{}", flow_table(summary));
    constexpr double most = 1.1;   // where a lesion gains pressure it is by less than that
    if (const Json& ffr = summary["ffr"]["lesion"]; ffr.is_number() && !(ffr >= 0 && ffr <= most))
        log(LogLevel::warning,
            fmt::format(
                "an FFR of {:.3g} is none that a vessel can have: the flow that the deck asks for loses more pressure "
                "than aorta.pressure, or runs backwards; look at flows, pressures, viscosity and their units",
                ffr.get<double>()));
    return outcome == Outcome::done ? ExitCode::ok : ExitCode::bar_missed;
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
    const Json deploy = read_summary(folder.file("summary.json"))["deploy"];
    const std::vector<std::string> doubts = doubts_about(deploy);
    for (const std::string& doubt : doubts) log(LogLevel::warning, doubt);
    return doubts.empty() ? ExitCode::ok : ExitCode::bar_missed;
}

}   // namespace patency::app
