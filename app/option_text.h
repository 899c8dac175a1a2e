// SPDX-License-Identifier: Apache-2.0
// What the manual and the completions of shells say alike of an option.
#pragma once

#include <string>

namespace CLI {
class Option;
}

namespace patency::app {

bool is_flag(const CLI::Option& option);
/// What an option takes: "TEXT", or its words "{quick,full}"; ranges stand in the checks, not here.
std::string taken(const CLI::Option& option);

}   // namespace patency::app
