// SPDX-License-Identifier: Apache-2.0
// patency man and patency completion: what --help knows, for man(1) and for a shell.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "exit_codes.h"
#include "patency/base/text.h"

namespace patency::app {

namespace {

/// As roff wants it: a line that begins with a dot or a quote would be a request, and a plain - a hyphen.
std::string roff(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) safe += "\\&";
        if (c == '-') safe += "\\-";
        else if (c == '\\') safe += "\\e";
        else safe += c;
    }
    return safe;
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

/// What an option takes: "TEXT", or its words "{quick,full}"; ranges stand in the checks, not here.
std::string taken(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t colon = type.find(':');
    return colon == type.npos ? type : type[colon + 1] == '{' ? type.substr(colon + 1) : type.substr(0, colon);
}

/// "-o,--out TEXT"; a positional argument's name alone.
std::string spelling(const CLI::Option& option) {
    if (option.get_positional()) return option.get_name(true);
    return option.get_name(false, true) + (is_flag(option) ? "" : " " + taken(option));
}

std::vector<std::string> long_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// "patency stent show NAME [OPTIONS]"
std::string synopsis(const CLI::App& command, const std::string& path) {
    std::string line = path;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional()) line += option->get_required() ? " " + option->get_name(true) : " [" + option->get_name(true) + "]";
    return line + " [OPTIONS]";
}

void add_manual(std::string& text, const CLI::App& command, const std::string& path) {
    const auto deeper = command.get_subcommands(nullptr);
    text += fmt::format(".SS {}\n{}\n", roff(deeper.empty() ? synopsis(command, path) : path), roff(command.get_description()));
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_name() == "--help" || option->get_lnames() == std::vector<std::string>{"help"}) continue;
        const std::string standard = option->get_default_str().empty() ? "" : fmt::format(" (default {})", option->get_default_str());
        text += fmt::format(".TP\n.B {}\n{}\n", roff(spelling(*option)), roff(option->get_description() + standard));
    }
    for (const CLI::App* next : deeper) add_manual(text, *next, path + " " + next->get_name());
}

}   // namespace

namespace {

std::string man_page(const CLI::App& program, std::string_view version) {
    std::string text = fmt::format(".TH PATENCY 1 \"\" \"patency {}\" \"User Commands\"\n.SH NAME\npatency \\- {}\n.SH SYNOPSIS\n.B patency\n.I COMMAND\n[ARGUMENT...] [OPTIONS]\n.SH COMMANDS\n",
                                   roff(version), roff(program.get_description()));
    for (const CLI::App* command : program.get_subcommands(nullptr)) add_manual(text, *command, "patency " + command->get_name());
    text += ".SH EXIT STATUS\n";
    for (const ExitMeaning& exit : exit_meanings()) text += fmt::format(".TP\n.B {}\n{}\n", exit.code, roff(exit.meaning));
    return text + ".SH ENVIRONMENT\n.TP\n.B OMP_NUM_THREADS\nhow many threads, where neither \\-\\-threads nor the deck says it\n";
}

std::string bash_completion(const CLI::App& program) {
    std::vector<std::string> commands;
    std::string cases;
    for (const CLI::App* command : program.get_subcommands(nullptr)) {
        commands.push_back(command->get_name());
        std::vector<std::string> words = long_names(*command);
        for (const CLI::App* next : command->get_subcommands(nullptr)) {
            words.push_back(next->get_name());
            for (const std::string& name : long_names(*next)) words.push_back(name);
        }
        cases += fmt::format("        {}) words=\"{}\" ;;\n", command->get_name(), join(words, " "));
    }
    return fmt::format("# bash completion for patency; zsh takes it after: autoload -U bashcompinit; bashcompinit\n"
                       "_patency() {{\n"
                       "    local current=${{COMP_WORDS[COMP_CWORD]}} words=\n"
                       "    if [[ $COMP_CWORD -eq 1 ]]; then\n        COMPREPLY=($(compgen -W \"{} --help\" -- \"$current\"))\n        return\n    fi\n"
                       "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
                       "    if [[ $current == -* || $COMP_CWORD -eq 2 ]]; then COMPREPLY=($(compgen -W \"$words\" -- \"$current\")); fi\n"
                       "    if [[ $current != -* ]]; then COMPREPLY+=($(compgen -f -- \"$current\")); fi\n"   // decks, surfaces, folders
                       "}}\n"
                       "complete -o filenames -F _patency patency\n",
                       join(commands, " "), cases);
}

}   // namespace

void add_documents_commands(CLI::App& program, ExitCode& exit_code) {
    CLI::App* man = program.add_subcommand("man", "print the manual page: patency man | man -l -");
    man->callback([&program, &exit_code] {
        fmt::print("{}", man_page(program, PATENCY_VERSION));
        exit_code = ExitCode::ok;
    });
    CLI::App* completion = program.add_subcommand("completion", "print the completion of a shell: . <(patency completion bash)");
    const auto shell = std::make_shared<std::string>();
    completion->add_option("shell", *shell, "bash; zsh takes the same after bashcompinit")->required()->check(CLI::IsMember({"bash", "zsh"}));
    completion->callback([&program, shell, &exit_code] {   // both take the same
        fmt::print("{}", bash_completion(program));
        exit_code = ExitCode::ok;
    });
}

}   // namespace patency::app
