// SPDX-License-Identifier: Apache-2.0
// A flow's results as a table for people: what summary.json says, in clinical units.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace patency {

/// Openings, branches and lesions of a flow's part of summary.json; several lines, the last one ended. What is not there is left out.
std::string flow_table(const nlohmann::ordered_json& summary);

}   // namespace patency
