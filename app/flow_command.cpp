// SPDX-License-Identifier: Apache-2.0
// patency flow: the flow stage alone.
#include <fmt/format.h>

#include <memory>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "patency/report/page.h"
#include "stage_runner.h"

namespace patency::app {

namespace {

struct FlowOptions {
    DeckOptions deck;
    std::string out;
    bool fresh = false;
};

ExitCode run(const FlowOptions& options) {
    const deck::Case config = options.deck.read();
    const std::string title = options.deck.title(config);
    const OutputFolder folder(options.out);
    const bool goes_on = !options.fresh && folder.has_checkpoint("flow");
    if (!options.fresh && !goes_on) expect_no_other_results(folder, config);
    if (!goes_on) folder.clear();
    const Log log = make_run_log(folder, goes_on);
    log(LogLevel::info, title);
    const ExitCode code = run_flow_stage(config, folder, Interruption(folder), log);
    if (code == ExitCode::ok || code == ExitCode::bar_missed)
        log(LogLevel::info, fmt::format("the page: {}", write_report(folder.root(), PATENCY_VERSION).string()));
    return code;
}

}   // namespace

void add_flow_command(const Command& program, ExitCode& exit_code) {
    const Command command = program.add_command("flow", "compute the blood flow");
    const auto options = std::make_shared<FlowOptions>();
    options->deck.add_to(command);
    command.add_option("-o,--out", options->out, "the folder for the results; a run that was interrupted there goes on")
        .required();
    command.add_flag("--fresh", options->fresh, "begin anew instead of going on");
    command.when_given([options, &exit_code] { exit_code = run(*options); });
}

}   // namespace patency::app
