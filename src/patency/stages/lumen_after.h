// SPDX-License-Identifier: Apache-2.0
// The lumen that a deployment leaves, as files that a flow begins with: the surface in the input's axes, and the deck for it.
#pragma once

#include "patency/config/case.h"
#include "patency/io/output_folder.h"
#include "patency/stages/vessel.h"

namespace patency {

/// Writes lumen_after.vtp (mm), lumen_after.stl (the input's unit) and case_after.yaml: the deck without its stent, its openings under the
/// names that they had, and its branches where they are found again. Returns the new surface as a flow will see it, followed. Throws
/// GeometryError if it cannot be used (the files stand, so that it can be looked at), FileError.
Vessel write_lumen_after(const deck::Case& config, const Vessel& before, const Surface& after,
                         const OutputFolder& folder);

/// The deck for the lumen after, whose surface is `surface`; `vessel` is that surface, checked; its inlet is chosen here.
deck::Case case_after(const deck::Case& config, const Vessel& before, Vessel& vessel,
                      const std::filesystem::path& surface);

/// Gives the branches after the names of those before, by the middles of these; returns the middles of those found again [m], or nothing
/// and changes nothing where old and new names would clash.
std::map<std::string, Vec3> keep_branch_names(const BranchedLines& before, BranchedLines& after);

}   // namespace patency
