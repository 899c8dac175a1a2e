// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/cell_shaking.h"

#include <algorithm>
#include <random>

namespace patency {

void shake(const Lumen& lumen, double share, CellPoints& points) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-share, share);
    for (std::size_t i = 0; i < points.point.size(); ++i) {
        const double h = points.spacing[i], a = any(random), b = any(random), c = any(random);
        const Vec3 moved = points.point[i] + h * Vec3{a, b, lumen.planar ? 0 : c};
        const bool stays = lumen.distance.value(moved) < -0.3 * h &&
                           std::all_of(lumen.openings.begin(), lumen.openings.end(),
                                       [&](const Opening& o) { return opening_coordinates(o, moved).s < -0.3 * h; });
        if (stays) points.point[i] = moved;
    }
}

}   // namespace patency
