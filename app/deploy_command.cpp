// SPDX-License-Identifier: Apache-2.0
// patency deploy: the stent alone.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "patency/base/text.h"
#include "patency/report/page.h"
#include "stage_runner.h"

namespace patency::app {

namespace {

struct DeployOptions {
    DeckOptions deck;
    std::string out, mode;
    bool fresh = false;
};

/// The deck, with the mode of the command line over it.
deck::Case read(const DeployOptions& options) {
    deck::Case config = options.deck.read();
    if (options.mode.empty()) return config;
    const deck::Words known = words(deck::DeploymentMode{});
    const auto found = std::find(known.begin(), known.end(), options.mode);
    if (found == known.end()) {
        const std::vector<std::string> names(known.begin(), known.end());
        throw UsageError(fmt::format("--mode {}: is none of {}", double_quoted(shortened(options.mode)),
                                     join(names, ", ", " and ")));
    }
    config.deployment.mode = deck::DeploymentMode(found - known.begin());
    return config;
}

ExitCode run(const DeployOptions& options) {
    const deck::Case config = read(options);
    const std::string title = options.deck.title(config);
    const OutputFolder folder(options.out);
    const bool has_mechanics = config.deployment.mode != deck::DeploymentMode::geometric;
    const bool goes_on = has_mechanics && !options.fresh && folder.has_checkpoint("deploy");
    if (!options.fresh && !goes_on) expect_no_results(folder);
    if (!goes_on) folder.clear();
    const Log log = make_run_log(folder, goes_on);
    log(LogLevel::info, title);
    const ExitCode code = run_deploy_stage(config, folder, Interruption(folder), log);
    if (code == ExitCode::ok || code == ExitCode::bar_missed)
        log(LogLevel::info, fmt::format("the page: {}", write_report(folder.root(), PATENCY_VERSION).string()));
    return code;
}

}   // namespace

void add_deploy_command(const Command& program, ExitCode& exit_code) {
    const Command command =
        program.add_command("deploy", "implant the deck's stent: crimp it, open it in the vessel, let go");
    const auto options = std::make_shared<DeployOptions>();
    options->deck.add_to(command);
    command
        .add_option("-o,--out", options->out,
                    "the folder for the results; with mechanics it goes on from a checkpoint there")
        .required();
    command.add_option(
        "--mode", options->mode,
        "balloon, radial_load, or geometric: a quick change of shape without mechanics; instead of the deck's");
    command.add_flag("--fresh", options->fresh, "begin anew instead of going on");
    command.when_given([options, &exit_code] { exit_code = run(*options); });
}

}   // namespace patency::app
