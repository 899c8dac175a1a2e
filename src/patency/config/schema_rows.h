// SPDX-License-Identifier: Apache-2.0
// What the files of THE table share. Every key of the deck stands in one of them, once: vessels and stents in schema_geometry.cpp, blood,
// walls and openings in schema_flow.cpp, the case and how it is computed in schema.cpp. To add a key: a member in case.h, a row there
// (docs/HOWTO-add-a-case-key.md); a rule between keys goes to checks.cpp.
#pragma once

#include "patency/config/table.h"

namespace patency::deck {

inline Condition where(std::string key, std::vector<std::string> words_of_key) {
    return {std::move(key), std::move(words_of_key)};
}

inline Condition without(std::string key) { return {.key = std::move(key), .absent = true}; }

inline constexpr double largest_length = 10;   // m; a vessel is millimetres, a bench model a metre
inline constexpr double largest_speed = 100;   // m/s

}   // namespace patency::deck
