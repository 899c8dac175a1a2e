// SPDX-License-Identifier: Apache-2.0
// The program's commands and their options, as commands.h's functions add them. CLI11 reads the arguments; command_line.cpp includes it
// for all of them, since it takes seconds in every file that does.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}   // namespace CLI

namespace patency::app {

/// One option of a command; what it returns is itself, so that its conditions are said in a row.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    const Option& required() const;
    const Option& between(int least, int most) const;
    const Option& positive() const;
    const Option& one_of(const std::vector<std::string>& words) const;
    const Option& with_default() const;   ///< the value it has already is shown as its default
    const Option& repeated() const;       ///< one value each time it is given, all of them kept
    const Option& comma_separated() const;

private:
    CLI::Option* option_;
};

/// A command, or the program itself. Values that options and flags set must live until the arguments are read.
class Command {
public:
    explicit Command(CLI::App* command) : command_(command) {}
    Command add_command(const std::string& name, const std::string& what) const;
    void expect_one_of_its_commands() const;
    Option add_option(const std::string& names, std::string& value, const std::string& what) const;
    Option add_option(const std::string& names, std::vector<std::string>& values, const std::string& what) const;
    Option add_option(const std::string& names, int& value, const std::string& what) const;
    Option add_option(const std::string& names, std::optional<int>& value, const std::string& what) const;
    Option add_option(const std::string& names, double& value, const std::string& what) const;
    void add_flag(const std::string& names, bool& value, const std::string& what) const;
    void describe(const std::string& option, const std::string& what) const;   ///< anew, of an option that it has
    void when_given(std::function<void()> call) const;

private:
    CLI::App* command_;
};

}   // namespace patency::app
