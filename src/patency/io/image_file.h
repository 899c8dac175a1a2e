// SPDX-License-Identifier: Apache-2.0
// Label maps and level sets from NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd) and MetaImage (.mha, .mhd). The surface in them is
// shape/'s (image_surface.h).
//
// They are read here and not by VTK, whose readers leave out the directions of NRRD and MetaImage, so that a vessel would
// lie mirrored, and do not survive all damaged files.
#pragma once

#include <filesystem>
#include <string_view>

#include "patency/shape/image_surface.h"

namespace patency {

/// By the contents.
bool is_image(std::string_view bytes);

/// The image of a file with these bytes, in metres by the unit of its format: NIfTI's own (mm if it has none), mm else. Axes are RAS (NIfTI),
/// LPS (MetaImage) or as the file says (NRRD). Throws FileError.
Image parse_image(const std::filesystem::path& path, std::string_view bytes);

}   // namespace patency
