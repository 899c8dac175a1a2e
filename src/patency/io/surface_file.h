// SPDX-License-Identifier: Apache-2.0
// Surfaces of triangles from files that other programs wrote (STL, VTP, PLY, OBJ, legacy VTK; label maps in NIfTI, NRRD, MetaImage) and to VTP. What is wrong
// with a surface as a vessel is shape/'s (surface_check.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "patency/shape/surface.h"

namespace patency {

/// A surface file, its numbers taken in `unit` (m, cm, mm or um: surface files carry none). The format is that of the
/// contents, whatever the name says. Polygons and strips become triangles; equal points stay apart. face_ids are the
/// cell array ModelFaceID, or the solids of an STL with several. `space` ("LPS", "RAS" or empty) is believed over the file's own mark.
/// An image becomes a surface by its label (make_image_surface); images know their unit, so `unit` is empty or mm then.
/// Throws FileError for what cannot be read, GeometryError for a surface without triangles, UsageError for another unit or
/// space.
Surface read_surface(const std::filesystem::path& path, std::string_view unit, std::string_view space = {},
                     std::optional<int> label = {});

/// The surface as VTP: mm, its unit and the mark SPACE in FieldData, face_ids as ModelFaceID. Throws FileError.
void write_surface(const std::filesystem::path& path, const Surface& surface);

/// The surface as binary STL, its numbers in `unit` (STL carries none), the mark SPACE in its header. Throws FileError, UsageError for
/// another unit.
void write_stl(const std::filesystem::path& path, const Surface& surface, std::string_view unit);

}   // namespace patency
