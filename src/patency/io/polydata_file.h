// SPDX-License-Identifier: Apache-2.0
// Results read back: the .vtp files that vtp.h writes.
#pragma once

#include <filesystem>

#include "patency/io/vtp.h"

namespace patency {

/// Points [m], lines, triangles (polygons as fans), point arrays under the file's names ("WSS") with their units. Integer arrays
/// are read as numbers; face_ids are not read. Throws FileError for what cannot be read or is damaged.
PolyData read_polydata(const std::filesystem::path& path);

}   // namespace patency
