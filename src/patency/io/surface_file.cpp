// SPDX-License-Identifier: Apache-2.0
#include "patency/io/surface_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/io/atomic_file.h"
#include "patency/io/image_file.h"
#include "patency/io/surface_formats.h"
#include "patency/io/vtp.h"

namespace patency {

namespace {

constexpr double largest_coordinate =
    1e6;   // m: no body is there, and the square of it is still exact enough to compare

/// By its contents; by its name only where contents do not tell.
Surface parse(const SurfaceBytes& file) {
    const std::string_view bytes = file.bytes;
    if (trimmed(bytes).empty()) refuse_file(file, "it is empty. Copy or export it again.");
    const std::string_view start = bytes.substr(0, 4096);
    if (start.starts_with("ply\n") || start.starts_with("ply\r")) return parse_ply(file);
    if (start.starts_with("# vtk DataFile")) return parse_legacy_vtk(file);
    if (start.find("<VTKFile") != start.npos) return parse_vtp(file);
    if (is_stl_binary(bytes) || is_stl_text(bytes)) return parse_stl(file);
    std::string extension = file.path.extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if (extension == ".obj") return parse_obj(file);
    if (extension == ".stl") return parse_stl(file);
    refuse_file(file,
                "it is no surface in a format that is known here: STL, VTP, PLY, OBJ, legacy VTK, NIfTI, NRRD or "
                "MetaImage. Export it as one of these.");
}

void expect_sound(const SurfaceBytes& file, const Surface& surface) {
    if (surface.points.size() >= std::numeric_limits<std::uint32_t>::max())
        refuse_file(file, "it has more than 4 thousand million points.");
    for (std::size_t k = 0; k < surface.points.size(); ++k) {
        const Vec3& x = surface.points[k];
        const double largest = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        if (std::isfinite(x.x + x.y + x.z) && largest <= largest_coordinate) continue;
        refuse_file(
            file,
            fmt::format("point {} is at ({:g}, {:g}, {:g}) m, which is no place in a body. Export the surface again.",
                        k, x.x, x.y, x.z));
    }
    for (std::size_t k = 0; k < surface.triangles.size(); ++k)
        for (std::uint32_t point : surface.triangles[k])
            if (point >= surface.points.size())
                refuse_file(file, fmt::format("triangle {} names point {}, but there are {} points, counted from 0. "
                                              "Export the surface again.",
                                              k, point, surface.points.size()));
    if (surface.triangles.empty())
        throw GeometryError(
            fmt::format("'{}' has {} points but no triangle, so there is no surface. Export the vessel's surface, not "
                        "its points or lines.",
                        file.path.string(), surface.points.size()));
}

}   // namespace

void refuse_file(const SurfaceBytes& file, std::string_view reason) {
    throw FileError(fmt::format("cannot read '{}': {}", file.path.string(), reason));
}

Surface read_surface(const std::filesystem::path& path, std::string_view unit, std::string_view space,
                     std::optional<int> label) {
    if (!space.empty() && space != "LPS" && space != "RAS")
        throw UsageError(fmt::format("'{}' is no space; it is LPS or RAS.", shortened(space)));
    const std::string bytes = read_file(path);
    if (is_image(bytes)) {
        if (!unit.empty() && unit != "mm")
            throw UsageError(
                fmt::format("'{}' is an image, which knows its unit: leave {} out.", path.string(), shortened(unit)));
        Surface surface = make_image_surface(parse_image(path, bytes), label);
        if (!space.empty()) surface.space = space;
        return surface;
    }
    if (label) throw UsageError(fmt::format("'{}' is no label map, so it has no label {}.", path.string(), *label));
    const std::vector<std::string> units = unit_names(Dimension::length);
    if (unit.empty())
        throw UsageError(fmt::format("'{}' does not say its unit: give {}.", path.string(), join(units, ", ", " or ")));
    if (std::find(units.begin(), units.end(), unit) == units.end())
        throw UsageError(
            fmt::format("'{}' is no unit of a surface; it is one of {}.", shortened(unit), join(units, ", ", " or ")));
    const SurfaceBytes file{path, bytes};
    Surface surface = parse(file);
    const double per_metre = in_unit(1, unit);
    for (Vec3& x : surface.points) x = x / per_metre;
    if (!space.empty()) surface.space = space;
    expect_sound(file, surface);
    return surface;
}

void write_surface(const std::filesystem::path& path, const Surface& surface) {
    write_polydata(path, {.points = surface.points,
                          .triangles = surface.triangles,
                          .face_ids = surface.face_ids,
                          .space = surface.space});
}

void write_stl(const std::filesystem::path& path, const Surface& surface, std::string_view unit) {
    const std::vector<std::string> units = unit_names(Dimension::length);
    if (std::find(units.begin(), units.end(), unit) == units.end())
        throw UsageError(
            fmt::format("'{}' is no unit of a surface; it is one of {}.", shortened(unit), join(units, ", ", " or ")));
    const double per_metre = in_unit(1, unit);
    std::string bytes = surface.space.empty() ? "" : "SPACE=" + surface.space;   // as 3D Slicer marks it
    bytes.resize(80, ' ');
    const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    append(std::uint32_t(surface.triangles.size()));
    for (const Triangle& t : surface.triangles) {
        const Vec3 n = area_vector(surface, t), unit_normal = norm(n) > 0 ? n / norm(n) : Vec3{};
        const std::array<Vec3, 4> vectors = {unit_normal, per_metre * surface.points[t[0]],
                                             per_metre * surface.points[t[1]], per_metre * surface.points[t[2]]};
        for (const Vec3& v : vectors)
            for (const double c : {v.x, v.y, v.z}) append(float(c));
        append(std::uint16_t(0));
    }
    write_file(path, bytes);
}

}   // namespace patency
