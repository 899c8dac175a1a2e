// SPDX-License-Identifier: Apache-2.0
// Vessel networks from files: centrelines with radii. What they enclose is shape/'s (network_lumen.h).
#pragma once

#include <filesystem>
#include <string_view>

#include "patency/shape/network.h"

namespace patency {

/// Whether a file holds centrelines and no surface: JSON, SWC, or VTK polydata with lines and no polygons. Throws FileError.
bool holds_network(const std::filesystem::path& path);

/// A network with its openings. Formats, by the contents:
///   JSON  {"unit": "mm", "tubes": [{"name": ..., "points": [[x, y, z, radius], ...]}, ...], "blend_width_k": ...,
///         "ends": {NAME: {"point": [x, y, z], "outward_normal": [x, y, z]}, ...}}; without ends the free ends are openings;
///   SWC   a line per node: id, type, x, y, z, radius, parent's id or -1;
///   VTP and legacy VTK  lines with a point array MaximumInscribedSphereRadius, Radius or radii. Lines that share
///         their way from the inlet on, as VMTK's do, become a tree.
/// unit: m, cm, mm or um; may be empty for JSON that says its own, and must not differ from that. space: "LPS", "RAS" or
/// empty, believed over the file's own mark. Throws FileError for what cannot be read, GeometryError for what is no network (expect_sound),
/// UsageError for another or a missing unit.
Network read_network(const std::filesystem::path& path, std::string_view unit, std::string_view space = {});

}   // namespace patency
