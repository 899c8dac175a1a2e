// SPDX-License-Identifier: Apache-2.0
// The openings of a lumen's surface: open ends, and flat faces that close an end. Rounded ends are none.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patency/shape/lumen.h"
#include "patency/shape/surface_check.h"

namespace patency {

struct SurfaceOpening {
    Opening opening;                          ///< as particles know it: name, centre, normal, area, radius, reach
    double perimeter;                         ///< [m]
    double flatness;                          ///< largest distance of the rim from the opening's plane [m]
    std::optional<std::int32_t> face_id{};    ///< ModelFaceID of the face that closes it
    std::vector<std::uint32_t> triangles{};   ///< of the surface, that close it; none at an open end
};

/// The openings by falling area, named inlet, outlet_1, outlet_2...: open ends, flat faces with a face id of their own,
/// else round flat regions, if bent not by much, with a sharp edge all around at which the wall turns away.
std::vector<SurfaceOpening> find_openings(const CheckedSurface& checked);

/// Names another one the inlet: by its name, or its number 1, 2.. in the list. It comes first then, the others
/// stay by falling area. Throws UsageError.
void choose_inlet(std::vector<SurfaceOpening>& openings, std::string_view name_or_number);

/// Own names, by those that the openings have. Throws UsageError for a name that none has, or that two would have.
void rename_openings(std::vector<SurfaceOpening>& openings, const std::map<std::string, std::string>& names);

/// Throws GeometryError, a question about the unit, if the inlet's diameter is not one of a vessel (0.5 to 40 mm), with the
/// units that would fit.
void expect_vessel_size(const SurfaceOpening& inlet, std::string_view unit);

/// What is missing for a flow: fewer than two openings. A refused finding, or none.
std::vector<Finding> find_missing_openings(const std::vector<SurfaceOpening>& openings);

}   // namespace patency
