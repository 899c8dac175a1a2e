// SPDX-License-Identifier: Apache-2.0
// The formats of surface files, one function each: bytes in, a surface in the file's own unit out. Indices and numbers
// are as found; surface_file.cpp checks them. For surface_file.cpp, network_file.cpp
// and polydata_file.cpp only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "patency/io/vtp.h"
#include "patency/shape/surface.h"

namespace patency {

struct SurfaceBytes {
    const std::filesystem::path& path;   ///< for sentences
    std::string_view bytes;
};

/// Throws FileError "cannot read 'PATH': REASON".
[[noreturn]] void refuse_file(const SurfaceBytes& file, std::string_view reason);

Surface parse_stl(const SurfaceBytes& file);   ///< text or binary
Surface parse_ply(const SurfaceBytes& file);   ///< text or binary
Surface parse_obj(const SurfaceBytes& file);
Surface parse_vtp(const SurfaceBytes& file);
Surface parse_legacy_vtk(const SurfaceBytes& file);

struct CentrelineData {
    std::vector<Vec3> points;
    std::vector<double> radii;                         ///< one per point
    std::vector<std::array<std::uint32_t, 2>> edges;   ///< between points
    std::string space;
};
/// The lines of a VTP or legacy file and their point array of radii.
CentrelineData parse_vtk_lines(const SurfaceBytes& file);

/// Everything of a VTP file that PolyData has a place for; lengths and names as in the file. Cell arrays are left out.
PolyData parse_vtp_polydata(const SurfaceBytes& file);

bool is_stl_text(std::string_view bytes);     ///< begins with "solid" and is text
bool is_stl_binary(std::string_view bytes);   ///< has just the length that its number of triangles needs

/// LPS or RAS of a comment that says SPACE=LPS, as 3D Slicer writes it; else empty.
std::string space_mark(std::string_view comment);

/// The lines of a text, whichever way they end.
class Lines {
public:
    explicit Lines(std::string_view text) : rest_(text) {}
    /// The next line, or nothing at the end.
    std::optional<std::string_view> next();
    std::size_t number() const { return number_; }    ///< of the last line, from 1
    std::string_view rest() const { return rest_; }   ///< what is not read yet

private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

/// Cuts the first word off; empty at the end.
std::string_view next_word(std::string_view& text);

/// A number and nothing else; NaN and infinity are numbers here.
std::optional<double> read_number(std::string_view word);
/// Three numbers.
std::optional<Vec3> read_point(std::string_view text);

/// Adds a polygon as a fan of triangles. Polygons of more than four corners are taken for convex.
void add_polygon(Surface& surface, const std::vector<std::uint32_t>& corners);

}   // namespace patency
