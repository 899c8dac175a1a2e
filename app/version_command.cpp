// SPDX-License-Identifier: Apache-2.0
// patency version, patency schema: what the program is and what decks it reads.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "commands.h"
#include "patency/config/schema.h"

namespace patency::app {

void add_version_command(CLI::App& program, ExitCode&) {
    program.add_subcommand("version", "print the version, and for which instructions the program was compiled")->callback([] { std::puts("patency " PATENCY_VERSION " (" PATENCY_ISA ")"); });
}

void add_schema_command(CLI::App& program, ExitCode&) {
    CLI::App* command = program.add_subcommand("schema", "print the deck's JSON Schema, for editors");
    const auto as_markdown = std::make_shared<bool>(false);
    command->add_flag("--markdown", *as_markdown, "print the keys as tables of Markdown instead");
    command->callback([as_markdown] { std::puts((*as_markdown ? deck::schema_markdown() : deck::schema_json()).c_str()); });
}

}  // namespace patency::app
