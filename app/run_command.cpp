// SPDX-License-Identifier: Apache-2.0
// patency run: everything that a deck asks for, one stage after the other: the estimate with its bands, then the flow. Each stage's
// results are in a folder of its own in OUT, what they say together in OUT/summary.json.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "deck_options.h"
#include "flow_runner.h"
#include "solid_runner.h"
#include "patency/io/summary.h"
#include "patency/stages/estimate_results.h"

namespace patency::app {

namespace {

struct RunOptions {
    DeckOptions deck;
    std::string out;
    bool fresh = false;
};

using Json = nlohmann::ordered_json;

/// What the tree of tubes says, with the bands of its uncertain numbers; null for a shape.
Json estimate(const deck::Case& config, const Log& log) {
    if (!config.has_vessel()) return nullptr;
    const Vessel vessel = read_vessel(config);
    const Estimate e = estimate_flow(config, vessel);
    Json summary = estimate_summary(config, vessel, e, estimate_band(config, vessel));
    for (const auto& [name, opening] : summary["openings"].items())
        log(LogLevel::info, fmt::format("estimate: {} {:.2f} mL/min", name, 6e7 * opening["flow_m3_per_s"].get<double>()));
    return summary;
}

ExitCode run(const RunOptions& options) {
    const deck::Case config = options.deck.read();
    const int threads = options.deck.apply_threads(config);
    const OutputFolder folder(options.out);
    if (!config.solids.empty()) return run_solid_stage(config, folder, fmt::format("{} on {} threads", options.deck.path, threads), options.fresh);
    const OutputFolder before(folder.file("before"));
    const bool goes_on = !options.fresh && before.has_checkpoint("flow");
    if (!goes_on) folder.clear(), before.clear();
    const Log log = make_run_log(folder, goes_on);
    log(LogLevel::info, fmt::format("{} on {} threads", options.deck.path, threads));

    Json summary{{"name", config.about.name}};
    summary["estimate"] = estimate(config, log);
    const ExitCode code = run_flow_stage(config, before, log);
    if (code != ExitCode::ok && code != ExitCode::bar_missed) return code;
    summary["before"] = read_summary(before.file("summary.json"));
    write_summary(folder.file("summary.json"), summary);
    write_summary(folder.file("timing.json"), {{"before", read_summary(before.file("timing.json"))}});
    return code;
}

}   // namespace

void add_run_command(CLI::App& program, ExitCode& exit_code) {
    CLI::App* command = program.add_subcommand("run", "everything that the deck asks for: the estimate, then the flow; or solids");
    const auto options = std::make_shared<RunOptions>();
    options->deck.add_to(*command);
    command->add_option("-o,--out", options->out, "the folder for the results; a run that was interrupted there goes on")->required();
    command->add_flag("--fresh", options->fresh, "begin anew instead of going on");
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

}   // namespace patency::app
