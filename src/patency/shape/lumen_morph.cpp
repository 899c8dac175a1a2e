// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/lumen_morph.h"

#include <cmath>
#include <numbers>

#include "patency/base/parallel.h"

namespace patency {

namespace {

/// 1 along the stent, 0 past the shoulders, smooth between.
double share(double along, const LumenMorph& morph) {
    const double past = (std::abs(along) - morph.length / 2) / morph.shoulder;
    if (past <= 0) return 1;
    if (past >= 1) return 0;
    return 0.5 * (1 + std::cos(std::numbers::pi * past));
}

}   // namespace

Vec3 morphed(const Vec3& x, const StentAxis& axis, const LumenMorph& morph) {
    constexpr double far = 40;   // exp(-40) is nothing beside 1
    const double width = morph.corner * morph.radius;
    const StentPoint at = axis.coordinates(x);
    const double part = share(at.along, morph), over = (at.radius - morph.radius) / width;
    if (part == 0 || over > far) return x;
    return x + (part * width * (over < -far ? -over : std::log1p(std::exp(-over)))) * axis.outward(at);
}

void morph_surface(Surface& surface, const StentAxis& axis, const LumenMorph& morph) {
    for_each_index(surface.points.size(),
                   [&](std::size_t i) { surface.points[i] = morphed(surface.points[i], axis, morph); });
}

}   // namespace patency
