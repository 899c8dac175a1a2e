// SPDX-License-Identifier: Apache-2.0
#include "option_text.h"

#include <CLI/CLI.hpp>

namespace patency::app {

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::string taken(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t colon = type.find(':');
    return colon == type.npos ? type : type[colon + 1] == '{' ? type.substr(colon + 1) : type.substr(0, colon);
}

}   // namespace patency::app
