// SPDX-License-Identifier: Apache-2.0
// Particles, points, lines and triangles as VTK PolyData files (.vtp) that ParaView, 3D Slicer and
// SimVascular open: coordinates in mm, fields in SI as 32-bit floats, each array's unit in FieldData
// as NAME_unit, arrays named as peers name them. Writes only; surfaces are read in surface_file.h.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patency/base/vec.h"
#include "patency/particles/particle_set.h"

namespace patency {

/// What to do with values that are not finite as 32-bit floats.
enum class NonFinite {
    refuse,   ///< DivergedError naming array and index: NaN never reaches a result file
    allow,    ///< for the offenders of a run that went wrong
};

struct VtpOptions {
    std::optional<double> time{};        ///< s; stored as TimeValue
    std::vector<std::string> fields{};   ///< names of the fields to write; empty: all
    std::vector<std::uint32_t> only{};   ///< indices of the particles to write; empty: all
    double pressure_level = 0;           ///< Pa, added to the field "pressure" (the moving reference)
    NonFinite non_finite = NonFinite::refuse;
};

/// One particle set, a vertex per particle, at the places of its field "position" (m). A set without
/// that field, or a chosen field that it does not have, is a std::logic_error. Throws FileError.
void write_particles(const std::filesystem::path& path, const ParticleSet& particles, const VtpOptions& options = {});

/// Values at the points of a PolyData: components (1, 3 or 9) per point, one point after another.
struct PointArray {
    std::string name, unit;   ///< name as a field's: "wall_shear_stress"; unit SI
    int components = 1;
    std::vector<double> values{};
};

/// Whole numbers at the points of a PolyData, one per point.
struct IntegerArray {
    std::string name;
    std::vector<std::int32_t> values{};
};

/// Points with what connects them. Without lines and triangles every point is a vertex.
struct PolyData {
    std::vector<Vec3> points{};   ///< m
    std::vector<std::vector<std::uint32_t>> lines{};
    std::vector<std::array<std::uint32_t, 3>> triangles{};
    std::vector<PointArray> arrays{};
    std::vector<IntegerArray> integers{};
    std::vector<std::int32_t> face_ids{};   ///< one per triangle, without lines beside them; the cell array ModelFaceID
    std::string space{};                    ///< "LPS" or "RAS": the mark SPACE that 3D Slicer looks for
};

/// Profiles, centrelines, surfaces, offenders. `options.fields`, `only` and `pressure_level` do not
/// apply. Throws FileError.
void write_polydata(const std::filesystem::path& path, const PolyData& data, const VtpOptions& options = {});

/// The array name of a field: a peer's name where there is one ("wall_shear_stress" -> "WSS"), else
/// CamelCase ("normal_direction" -> "NormalDirection").
std::string vtk_name(std::string_view field_name);

}   // namespace patency
