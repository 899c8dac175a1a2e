// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/wall_face.h"

#include <algorithm>
#include <cmath>

#include "patency/shape/level_surface.h"

namespace patency {

Surface wall_face(const WallField& field, WallFace face, double size) {
    const auto value = [&](const Vec3& x) {
        const WallPlace p = field.at(x);
        return face == WallFace::lumen ? p.lumen : std::min(p.lumen, p.healthy) - p.thickness;
    };
    const auto may_cross = [&](const Bounds& box) {   // slopes are near 1
        return std::abs(value(0.5 * (box.low + box.high))) < 0.75 * norm(box.high - box.low);
    };
    const Surface level = make_level_surface(value, level_grid_around(field.bounds(), size), may_cross);
    std::vector<std::uint32_t> within;
    for (std::uint32_t t = 0; t < level.triangles.size(); ++t)
        if (field.at(centroid(level, level.triangles[t])).region < -0.25 * size) within.push_back(t);
    Surface part = part_of(level, within);
    if (face == WallFace::lumen)
        for (Triangle& t : part.triangles) std::swap(t[1], t[2]);
    return part;
}

}   // namespace patency
