// SPDX-License-Identifier: Apache-2.0
// Rules between the keys of a deck that need no geometry. What one key alone may be is schema.cpp's.
#pragma once

#include "patency/config/case.h"
#include "patency/config/document.h"

namespace patency::deck {

/// Add a mistake for every broken rule; rules whose keys have mistakes already are passed over.
void check_case(const Case& c, const Node& root, Mistakes& mistakes);
/// The part of it that concerns `runs`.
void check_runs(const Case& c, const Node& root, Mistakes& mistakes);

}   // namespace patency::deck
