// SPDX-License-Identifier: Apache-2.0
// Whether the openings of a deck are those of its lumen. What a lumen's openings are called is found out elsewhere
// (stages/opening_names.h): that needs its geometry.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "patency/config/case.h"
#include "patency/config/document.h"

namespace patency::deck {

/// The names of the openings of a case's lumen; none if they cannot be known. May read files, throws nothing.
using FindOpeningNames = std::function<std::optional<std::vector<std::string>>(const Case&)>;

/// Adds a mistake for every opening that the lumen does not have, with the nearest one that it has, and for every opening of the lumen
/// that the deck leaves out, unless a misspelt one stands for it. Asks nothing where the geometry has mistakes, nor of a surface, which
/// takes a while to read, if all is well with the deck and its openings have names that surfaces give theirs.
void check_opening_names(const Case& c, const Node& root, const FindOpeningNames& find, Mistakes& mistakes);

}   // namespace patency::deck
