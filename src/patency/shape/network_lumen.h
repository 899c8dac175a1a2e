// SPDX-License-Identifier: Apache-2.0
// The space inside a network of tubes: as a lumen for particles, and as a closed surface for other programs. Its wall is
// the zero level of NetworkField (network_field.h).
#pragma once

#include "patency/shape/lumen.h"
#include "patency/shape/network.h"
#include "patency/shape/surface.h"

namespace patency {

/// The openings: discs across the tubes' ends, the inlet first, the others by falling area. Throws GeometryError if an
/// opening or its straight continuation by `extension` [m] runs into another tube.
std::vector<Opening> openings_of(const Network& network, double extension);

/// The surface, closed by flat discs: ModelFaceID 1 is the wall, 2, 3.. the openings in their order. Triangles of about
/// `resolution` [m], smaller where the narrowest tube needs it; their points lie on the wall.
/// Throws GeometryError as openings_of, and for a network whose wall is too large for its narrowest tube.
Surface make_network_surface(const Network& network, double resolution);

/// The lumen, continued straight by `extension` [m] past its openings. Its distance is that to the triangles of about `resolution` [m]
/// (make_surface_distance), so exact where tubes meet too; its volume is right to 1e-4. Throws as make_network_surface.
Lumen make_network_lumen(const Network& network, double extension, double resolution);

}   // namespace patency
