// SPDX-License-Identifier: Apache-2.0
// Solids on disk and back, so that they go on with the same bits: particles, contacts, what they did so far.
#pragma once

#include <string>

#include "patency/io/checkpoint.h"
#include "patency/stages/solid_scene.h"

namespace patency {

/// Everything under `name` that the next step depends on. Throws DivergedError if a value is not finite.
void write_solids(CheckpointWriter& writer, const SolidSystem& system, const std::string& name);
/// Into a system that was built as the written one was. Throws CheckpointError if it has other parts.
void read_solids(const CheckpointReader& reader, SolidSystem& system, const std::string& name);

/// Throws FileError, DivergedError: the last good checkpoint stays.
void write_solid_checkpoint(const std::filesystem::path& path, const CheckpointOrigin& origin, const SolidScene& scene);
/// Into the scene of the same case as it was built. Throws CheckpointError.
void read_solid_checkpoint(const CheckpointReader& reader, SolidScene& scene);

}   // namespace patency
