// SPDX-License-Identifier: Apache-2.0
// The deck's stent as it was made, and its axis.
#pragma once

#include <span>

#include "patency/config/case.h"
#include "patency/shape/stent_axis.h"
#include "patency/shape/stent_form.h"

namespace patency {

/// Throws DeckError for a design or an alloy that the library lacks, and for a length of what is no design.
void expect_known_names(const deck::Stent& stent);

/// The library's design or the deck's own pattern, with the deck's alloy; of its own pattern 316L if it names none. Throws
/// DeckError if the stent is a surface, and as expect_known_names.
StentPattern make_stent_pattern(const deck::Stent& stent);

/// What the stent is of: the deck's alloy, the design's, or 316L. Throws as make_stent_pattern.
std::string alloy_of(const deck::Stent& stent);

/// A stent as it was made.
struct MadeStent {
    StentPattern pattern;   ///< of a surface what can be measured of it: length, diameters, thickness, alloy; no rings
    StentForm form;
};
/// A pattern as make_stent_pattern has it, or a surface, of alloy_of. Throws as that does, FileError and, for
/// a surface that is no stent, GeometryError.
MadeStent make_stent(const deck::Stent& stent);

/// Where a stent of this length and outer diameter lies: `line` is the centreline of placement.branch [m], needed if it lies at an arc length. Throws
/// DeckError without it, GeometryError if the stent does not lie on it (StentAxis).
StentAxis make_stent_axis(const deck::StentPlacement& placement, const StentPattern& pattern,
                          std::span<const Vec3> line = {});

}   // namespace patency
