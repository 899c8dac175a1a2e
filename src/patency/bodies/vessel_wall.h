// SPDX-License-Identifier: Apache-2.0
// The wall of a vessel as particles that fit both its faces and the planes that cut it, with its surfaces.     THEORY (24.3)
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "patency/bodies/solid_surface.h"
#include "patency/shape/wall_field.h"

namespace patency {

enum class WallLayer : std::int32_t { plaque, media, adventitia };
std::string_view name_of(WallLayer layer);

struct VesselWall {
    std::vector<Vec3> places;   ///< [m]
    double volume;              ///< of each [m^3]; they add up to the wall's
    std::vector<WallLayer> layer;
    std::vector<char>
        is_at_end;             ///< so near to a plane that cuts the vessel that it belongs to what holds the wall there
    SurfaceElements surface;   ///< faces "lumen" and "outer", open where the wall is cut; out of the wall
};

/// adventitia_share: of the thickness, outside. Triangles are about as large as the spacing [m]. Throws GeometryError for a spacing that does
/// not put three particles through the wall.
VesselWall make_vessel_wall(const WallField& field, double spacing, double adventitia_share);

}   // namespace patency
