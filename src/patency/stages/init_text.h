// SPDX-License-Identifier: Apache-2.0
// A plan of patency init as text: lines for a person, and the commented deck. Decides nothing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "patency/stages/init_deck.h"

namespace patency {

/// Openings, branches, lesions, the price and what the spacing means, a line each.
std::vector<std::string> describe_plan(const Vessel& vessel, const InitPlan& plan);

/// The deck, every key commented, paths relative to `folder`. parse_case reads plan.config from it. The same plan gives the same
/// bytes. Throws UsageError for a path that is no text.
std::string deck_text(const Vessel& vessel, const InitPlan& plan, const std::filesystem::path& folder);

}   // namespace patency
