// SPDX-License-Identifier: Apache-2.0
// patency solid: solids by themselves.
#include <fmt/format.h>

#include <memory>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "solid_runner.h"

namespace patency::app {

namespace {

struct SolidOptions {
    DeckOptions deck;
    std::string out;
    bool fresh = false;
};

ExitCode run(const SolidOptions& options) {
    const deck::Case config = options.deck.read();
    const std::string title = options.deck.title(config);
    const OutputFolder folder(options.out);
    return run_solid_stage(config, folder, title, options.fresh);
}

}   // namespace

void add_solid_command(const Command& program, ExitCode& exit_code) {
    const Command command = program.add_command("solid", "compute solids alone: how they deform, yield and touch");
    const auto options = std::make_shared<SolidOptions>();
    options->deck.add_to(command);
    command.add_option("-o,--out", options->out, "the folder for the results").required();
    command.add_flag("--fresh", options->fresh, "begin anew instead of going on");
    command.when_given([options, &exit_code] { exit_code = run(*options); });
}

}   // namespace patency::app
