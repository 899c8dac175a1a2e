// SPDX-License-Identifier: Apache-2.0
// What the openings of a case's lumen are called, without building it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "patency/config/case.h"

namespace patency {

/// The names of the openings of the case's shape, network or surface, in the lumen's order; none if it cannot be used, which those say
/// who use it. Reads its files. Throws nothing.
std::optional<std::vector<std::string>> find_opening_names(const deck::Case& config);

}   // namespace patency
