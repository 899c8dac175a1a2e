// SPDX-License-Identifier: Apache-2.0
// patency version, patency schema: what the program is and what decks it reads.
#include <cstdio>

#include "command_line.h"
#include "commands.h"
#include "patency/config/schema.h"

namespace patency::app {

void add_version_command(const Command& program, ExitCode&) {
    program.add_command("version", "print the version, and for which instructions the program was compiled")
        .when_given([] { std::puts("patency " PATENCY_VERSION " (" PATENCY_ISA ")"); });
}

void add_schema_command(const Command& program, ExitCode&) {
    const Command command = program.add_command("schema", "print the deck's JSON Schema, for editors");
    const auto as_markdown = std::make_shared<bool>(false);
    command.add_flag("--markdown", *as_markdown, "print the keys as tables of Markdown instead");
    command.when_given(
        [as_markdown] { std::puts((*as_markdown ? deck::schema_markdown() : deck::schema_json()).c_str()); });
}

}   // namespace patency::app
