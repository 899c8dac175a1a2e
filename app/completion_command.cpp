// SPDX-License-Identifier: Apache-2.0
// patency completion: what --help knows, for a shell.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "option_text.h"
#include "patency/base/text.h"

namespace patency::app {

namespace {

std::vector<std::string> long_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
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
    return fmt::format(
        "# bash completion for patency\n"
        "_patency() {{\n"
        "    local current=${{COMP_WORDS[COMP_CWORD]}} words=\n"
        "    if [[ $COMP_CWORD -eq 1 ]]; then\n        COMPREPLY=($(compgen -W \"{} --help\" -- \"$current\"))\n       "
        " return\n    fi\n"
        "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
        "    if [[ $current == -* || $COMP_CWORD -eq 2 ]]; then COMPREPLY=($(compgen -W \"$words\" -- \"$current\")); "
        "fi\n"
        "    if [[ $current != -* ]]; then COMPREPLY+=($(compgen -f -- \"$current\")); fi\n"   // decks, surfaces, folders
        "}}\n"
        "complete -o filenames -F _patency patency\n",
        join(commands, " "), cases);
}

/// Between the single quotes of a specification of zsh, whose own signs are `special`.
std::string zsh_text(std::string_view text, std::string_view special) {
    std::string safe;
    for (const char c : text) {
        if (c == '\'')
            safe += "'\\''";
        else if (special.find(c) != special.npos)
            safe += std::string{'\\', c};
        else
            safe += c;
    }
    return safe;
}

/// How zsh completes what an option takes: its words, nothing for a number, else files.
std::string zsh_action(const CLI::Option& option) {
    std::string text = taken(option);
    if (text.starts_with('{')) {
        text.front() = '(', text.back() = ')';
        std::replace(text.begin(), text.end(), ',', ' ');
        return text;
    }
    return text == "INT" || text == "UINT" || text == "FLOAT" ? " " : "_files";
}

/// An option's lines for _arguments, one for each of its names; each takes away the others.
std::string zsh_option(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    const bool is_repeated = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll && !is_flag(option);
    std::string lines;
    for (const std::string& name : names) {
        const std::string others = is_repeated ? "*" : names.size() > 1 ? "(" + join(names, " ") + ")" : "";
        const std::string value =
            is_flag(option) ? ""
                            : fmt::format(":{}:{}", zsh_text(option.get_name(false, false), ":\\"), zsh_action(option));
        const bool may_be_joined = name.starts_with("--") && !is_flag(option);   // --level=full
        lines += fmt::format(" \\\n        '{}{}{}[{}]{}'", others, name, may_be_joined ? "=" : "",
                             zsh_text(option.get_description(), "[]:\\"), value);
    }
    return lines;
}

std::string zsh_positional(const CLI::Option& option) {
    const bool is_list = option.get_items_expected_max() > 1;
    return fmt::format(" \\\n        '{}:{}:{}'",
                       is_list                 ? "*"
                       : option.get_required() ? ""
                                               : ":",
                       zsh_text(option.get_name(true), ":\\"), zsh_action(option));
}

/// A function of zsh for a command and each below it: _patency, _patency_stent, _patency_stent_list.
void add_zsh_functions(std::string& text, const CLI::App& command, const std::string& function) {
    std::string arguments, commands;
    for (const CLI::Option* option : command.get_options())
        arguments += option->get_positional() ? zsh_positional(*option) : zsh_option(*option);
    for (const CLI::App* next : command.get_subcommands(nullptr)) {
        add_zsh_functions(text, *next, function + "_" + next->get_name());
        commands += fmt::format("        '{}:{}'\n", next->get_name(), zsh_text(next->get_description(), ":\\"));
    }
    if (commands.empty()) {
        text += fmt::format("{}() {{\n    _arguments{}\n}}\n", function, arguments);
        return;
    }
    text += fmt::format(
        "{0}() {{\n"
        "    local curcontext=$curcontext state line\n    typeset -A opt_args\n    local -a commands=(\n{1}    )\n"
        "    _arguments -C{2} \\\n        '1:command:->command' \\\n        '*::argument:->argument'\n"
        "    case $state in\n"
        "        command) _describe command commands ;;\n"
        "        argument) (( $+functions[{0}_$words[1]] )) && {0}_$words[1] ;;\n"
        "    esac\n}}\n",
        function, commands, arguments);
}

std::string zsh_completion(const CLI::App& program) {
    std::string text =
        "#compdef patency\n# zsh completion for patency: a file _patency in a folder of $fpath, or sourced after "
        "compinit\n";
    add_zsh_functions(text, program, "_patency");
    return text + "if [[ $funcstack[1] == _patency ]]; then _patency \"$@\"; else compdef _patency patency; fi\n";
}

}   // namespace

void add_completion_command(CLI::App& program, ExitCode& exit_code) {
    CLI::App* completion =
        program.add_subcommand("completion", "print the completion of a shell: source <(patency completion bash)");
    const auto shell = std::make_shared<std::string>();
    completion->add_option("shell", *shell, "which shell's")->required()->check(CLI::IsMember({"bash", "zsh"}));
    completion->callback([&program, shell, &exit_code] {
        fmt::print("{}", *shell == "zsh" ? zsh_completion(program) : bash_completion(program));
        exit_code = ExitCode::ok;
    });
}

}   // namespace patency::app
