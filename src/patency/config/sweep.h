// SPDX-License-Identifier: Apache-2.0
// A deck in many variants: keys that take several values, and all their combinations. Knows text only; whether a value fits
// its key, reading the deck says.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patency::deck {

struct SweepAxis {
    std::string key;                   ///< "numerics.spacing"
    std::vector<std::string> values;   ///< as they were written, one at least
};

/// "key=v1,v2": a comma within brackets, braces or quotes belongs to a value. Throws UsageError.
SweepAxis parse_axis(std::string_view setting);

struct SweepPoint {
    std::string name;   ///< fit for a folder, made of the values alone: "spacing=0.2_mm,density=1060_kg_m_3"
    std::vector<std::string> values;   ///< one for each axis
};

/// All combinations, the last axis changing fastest. A point keeps its name when values are added to an axis, so that a sweep
/// can grow; axes of one value are in no name. Throws UsageError where a key has two axes or nothing varies.
std::vector<SweepPoint> combine(const std::vector<SweepAxis>& axes);

}   // namespace patency::deck
