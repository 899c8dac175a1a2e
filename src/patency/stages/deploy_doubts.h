// SPDX-License-Identifier: Apache-2.0
// Why the numbers of a deployment are not to be relied on.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace patency {

/// Of the part "deploy" of summary.json: a sentence for each bar that it missed, with what to do. A geometric one knows no such numbers and
/// misses none.
std::vector<std::string> doubts_about(const nlohmann::ordered_json& deploy);

}   // namespace patency
