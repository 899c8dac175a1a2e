// SPDX-License-Identifier: Apache-2.0
// patency man: what --help knows, for man(1).
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <string>

#include "commands.h"
#include "exit_codes.h"
#include "option_text.h"

namespace patency::app {

namespace {

/// As roff wants it: a line that begins with a dot or a quote would be a request, and a plain - a hyphen.
std::string roff(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) safe += "\\&";
        if (c == '-')
            safe += "\\-";
        else if (c == '\\')
            safe += "\\e";
        else
            safe += c;
    }
    return safe;
}

/// "-o,--out TEXT"; a positional argument's name alone.
std::string spelling(const CLI::Option& option) {
    if (option.get_positional()) return option.get_name(true);
    return option.get_name(false, true) + (is_flag(option) ? "" : " " + taken(option));
}

/// "patency stent show NAME [OPTIONS]"
std::string synopsis(const CLI::App& command, const std::string& path) {
    std::string line = path;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional())
            line += option->get_required() ? " " + option->get_name(true) : " [" + option->get_name(true) + "]";
    return line + " [OPTIONS]";
}

void add_manual(std::string& text, const CLI::App& command, const std::string& path) {
    const auto deeper = command.get_subcommands(nullptr);
    text += fmt::format(".SS {}\n{}\n", roff(deeper.empty() ? synopsis(command, path) : path),
                        roff(command.get_description()));
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_name() == "--help" || option->get_lnames() == std::vector<std::string>{"help"}) continue;
        const std::string standard =
            option->get_default_str().empty() ? "" : fmt::format(" (default {})", option->get_default_str());
        text += fmt::format(".TP\n.B {}\n{}\n", roff(spelling(*option)), roff(option->get_description() + standard));
    }
    for (const CLI::App* next : deeper) add_manual(text, *next, path + " " + next->get_name());
}

std::string man_page(const CLI::App& program, std::string_view version) {
    std::string text = fmt::format(
        ".TH PATENCY 1 \"\" \"patency {}\" \"User Commands\"\n.SH NAME\npatency \\- {}\n.SH SYNOPSIS\n.B patency\n.I "
        "COMMAND\n[ARGUMENT...] [OPTIONS]\n.SH COMMANDS\n",
        roff(version), roff(program.get_description()));
    for (const CLI::App* command : program.get_subcommands(nullptr))
        add_manual(text, *command, "patency " + command->get_name());
    text += ".SH EXIT STATUS\n";
    for (const ExitMeaning& exit : exit_meanings())
        text += fmt::format(".TP\n.B {}\n{}\n", exit.code, roff(exit.meaning));
    return text +
           ".SH ENVIRONMENT\n.TP\n.B OMP_NUM_THREADS\nhow many threads, where neither \\-\\-threads nor the deck says "
           "it\n"
           ".TP\n.B PATENCY_ISA\nof a package's programs the one to run: baseline, avx2 or avx512; the widest that the "
           "processor has if unset\n";
}

}   // namespace

void add_man_command(CLI::App& program, ExitCode& exit_code) {
    program.add_subcommand("man", "print the manual page: patency man | man -l -")->callback([&program, &exit_code] {
        fmt::print("{}", man_page(program, PATENCY_VERSION));
        exit_code = ExitCode::ok;
    });
}

}   // namespace patency::app
