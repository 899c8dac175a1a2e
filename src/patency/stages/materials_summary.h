// SPDX-License-Identifier: Apache-2.0
// What a case's blood, wall and stent are made of, and where the numbers are from, for summary.json.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "patency/config/case.h"

namespace patency {

/// A list of {"part", "what", "source", numbers with the unit in the key}: the blood, and where a stent is implanted by mechanics the
/// wall's layers and the metal. Numbers that the deck gives itself have the source "the deck". Throws as make_solid_material.
nlohmann::ordered_json materials_summary(const deck::Case& config);

}   // namespace patency
