// SPDX-License-Identifier: Apache-2.0
// Stent designs by name.
#pragma once

#include <string>
#include <vector>

#include "patency/shape/stent_pattern.h"

namespace patency {

struct StentDesign {
    const char* name;
    const char* description;
    const char* source;   ///< where its figures come from
    StentPattern pattern;
};

/// All of them; each can be made.
const std::vector<StentDesign>& stent_library();
/// Throws GeometryError with the nearest name.
const StentDesign& find_stent(const std::string& name);

}   // namespace patency
