// SPDX-License-Identifier: Apache-2.0
// The smooth surface of a vessel in an image: of one label of a label map, or the zero level of a level set. Files are
// io's (image_file.h).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

/// Values at the points of a lattice.
struct Image {
    std::array<int, 3> size{};     ///< points along the image's axes
    std::vector<float> values{};   ///< the first axis fastest
    Mat3 step{};                   ///< its columns are the steps from point to point along the axes [m]
    Vec3 origin{};                 ///< the first point [m]
    std::string space{};           ///< axes of the coordinates: "LPS", "RAS", or empty if nobody said

    Vec3 place(const Vec3& index) const { return origin + step * index; }   ///< [m]
};

/// A surface from an image. Whole numbers without a sign are labels: `label`, or the only one that is not 0. Its steps of voxels are
/// smoothed over about a voxel, and its volume is that of its voxels. Numbers with both signs are a level set: its zero
/// level; inside is the side that has less of the image's border. Where the vessel leaves the image, the surface is cut flat at the
/// outer faces of the last voxels, and open. Throws GeometryError if there is no such label, or several to choose from.
Surface make_image_surface(const Image& image, std::optional<int> label = {});

}   // namespace patency
