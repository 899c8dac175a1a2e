// SPDX-License-Identifier: Apache-2.0
// The deck's stent as a pattern and an axis.
#pragma once

#include <span>

#include "patency/config/case.h"
#include "patency/shape/stent_axis.h"
#include "patency/shape/stent_pattern.h"

namespace patency {

/// The library's design or the deck's own pattern, with the deck's alloy; of its own pattern 316L if it names none. Throws
/// DeckError if the stent is a surface, GeometryError for an unknown design or alloy.
StentPattern make_stent_pattern(const deck::Stent& stent);

/// Where the stent lies: `line` is the centreline of placement.branch [m], needed if it lies at an arc length. Throws
/// DeckError without it, GeometryError if the stent does not lie on it (StentAxis).
StentAxis make_stent_axis(const deck::StentPlacement& placement, const StrutCurves& curves,
                          std::span<const Vec3> line = {});

}   // namespace patency
