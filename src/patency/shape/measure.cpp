// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/measure.h"

#include <algorithm>
#include <cmath>

namespace patency {

double smooth_step(double t) {
    if (std::abs(t) >= 1) return t > 0;
    const double q = t * t;
    return 0.5 + 105.0 / 64 * t * (1 - q * (5.0 / 3 - q * (7.0 / 5 - q * (3.0 / 7))));
}

namespace {

double slope_of_smooth_step(double t) {
    const double q = std::min(t * t, 1.0);
    return 105.0 / 64 * (1 - q) * (1 - q) * (1 - 3 * q);
}

// Cubes that lie across the wall or an opening are halved down to the resolution; the smallest count with the smooth
// share of their middle.
class Subdivision {
public:
    Subdivision(const Lumen& lumen, double resolution)
        : lumen_(lumen), resolution_(resolution), band_(3 * resolution) {}

    void add(const Vec3& centre, double half) {
        const double distance = lumen_.distance.value(centre), size = 2 * half;
        // A distance changes by at most the length of the way.
        const double margin = std::sqrt(3.0) * half + band_;
        if (distance > margin) return;
        double behind = 1;   // share behind the openings
        bool cut = false;
        for (const Opening& opening : lumen_.openings) {
            const auto [s, radial] = opening_coordinates(opening, centre);
            const double aside = norm(radial), limit = opening.reach + 2 * band_;   // all of the smooth wall
            if (s > lumen_.extension + 2 * opening.reach + margin) continue;
            if (s > margin && aside + margin < limit) return;
            if (s > -margin && aside < limit + margin) cut = true;
            if (aside < limit) behind *= smooth_step(-s / band_);
        }
        if (distance < -margin && !cut) {
            result.volume += size * size * size;
        } else if (size > 1.5 * resolution_) {
            const double q = 0.5 * half;
            for (int k = 0; k < 8; ++k) add(centre + Vec3{k & 1 ? q : -q, k & 2 ? q : -q, k & 4 ? q : -q}, q);
        } else {
            result.volume += size * size * size * behind * smooth_step(-distance / band_);
            result.wall_area += size * size * size * behind * slope_of_smooth_step(distance / band_) / band_;
        }
    }

    Measures result{};

private:
    const Lumen& lumen_;
    double resolution_;
    double band_;   // the half width over which a step is smooth: three cells, so that cells do not show
};

}   // namespace

Measures measure(const Lumen& whole, double resolution) {
    Lumen lumen = whole;
    // The faces of a periodic box cut like openings.
    const Vec3 extent = lumen.bounds.high - lumen.bounds.low, middle = 0.5 * (lumen.bounds.low + lumen.bounds.high);
    const auto cut_along = [&](const Vec3& axis, double period) {
        if (period <= 0) return;
        for (double side : {-1.0, 1.0})
            lumen.openings.push_back(
                {"", middle + 0.5 * side * period * axis, side * axis, 0, 0, norm(extent), false, 0});
    };
    cut_along({1, 0, 0}, lumen.period.x);
    cut_along({0, 1, 0}, lumen.period.y);
    cut_along({0, 0, 1}, lumen.period.z);
    const Bounds box = grown(lumen.bounds, 4 * resolution);
    const Vec3 size = box.high - box.low;
    double half = 0.5 * resolution;
    while (2 * half < std::max({size.x, size.y, size.z}) / 4) half *= 2;
    Subdivision cells(lumen, resolution);
    for (double x = box.low.x; x < box.high.x; x += 2 * half)
        for (double y = box.low.y; y < box.high.y; y += 2 * half)
            for (double z = box.low.z; z < box.high.z; z += 2 * half)
                cells.add(Vec3{x + half, y + half, z + half}, half);
    return cells.result;
}

}   // namespace patency
