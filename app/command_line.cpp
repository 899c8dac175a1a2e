// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <CLI/CLI.hpp>

#include <utility>

namespace patency::app {

const Option& Option::required() const {
    option_->required();
    return *this;
}

const Option& Option::between(int least, int most) const {
    option_->check(CLI::Range(least, most));
    return *this;
}

const Option& Option::positive() const {
    option_->check(CLI::PositiveNumber);
    return *this;
}

const Option& Option::one_of(const std::vector<std::string>& words) const {
    option_->check(CLI::IsMember(words));
    return *this;
}

const Option& Option::with_default() const {
    option_->capture_default_str();
    return *this;
}

const Option& Option::repeated() const {
    option_->expected(1)->take_all();
    return *this;
}

const Option& Option::comma_separated() const {
    option_->delimiter(',');
    return *this;
}

Command Command::add_command(const std::string& name, const std::string& what) const {
    return Command(command_->add_subcommand(name, what));
}

void Command::expect_one_of_its_commands() const { command_->require_subcommand(1); }

Option Command::add_option(const std::string& names, std::string& value, const std::string& what) const {
    return Option(command_->add_option(names, value, what));
}

Option Command::add_option(const std::string& names, std::vector<std::string>& values, const std::string& what) const {
    return Option(command_->add_option(names, values, what));
}

Option Command::add_option(const std::string& names, int& value, const std::string& what) const {
    return Option(command_->add_option(names, value, what));
}

Option Command::add_option(const std::string& names, std::optional<int>& value, const std::string& what) const {
    return Option(command_->add_option(names, value, what));
}

Option Command::add_option(const std::string& names, double& value, const std::string& what) const {
    return Option(command_->add_option(names, value, what));
}

void Command::add_flag(const std::string& names, bool& value, const std::string& what) const {
    command_->add_flag(names, value, what);
}

void Command::describe(const std::string& option, const std::string& what) const {
    command_->get_option(option)->description(what);
}

void Command::when_given(std::function<void()> call) const { command_->callback(std::move(call)); }

}   // namespace patency::app
