// SPDX-License-Identifier: Apache-2.0
// For tests of cells: points in a lumen, on a lattice that is shaken, with the spacing of each.
#pragma once

#include <random>
#include <vector>

#include "patency/shape/lumen.h"
#include "patency/shape/sampling.h"

namespace patency::testing_cells {

struct PointSet {
    std::vector<Vec3> point;
    std::vector<double> spacing;
};

/// Each point moved by up to `shake` spacings along each axis, but not nearer than 0.3 spacings to walls and openings.
inline PointSet shaken_lattice(const Lumen& lumen, double spacing, double shake, const RigidMotion& tilt = {}) {
    PointSet set;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-shake * spacing, shake * spacing);
    const auto keeps_off = [&](const Vec3& x, double gap) {
        if (lumen.distance.value(x) > -gap * spacing) return false;
        for (const Opening& opening : lumen.openings)
            if (opening_coordinates(opening, x).s > -gap * spacing) return false;
        return true;
    };
    const Lattice lattice{.frame = tilt.after(fitted_lattice(lumen, spacing).frame),
                          .cell = fitted_lattice(lumen, spacing).cell,
                          .planar = lumen.planar};
    for (const Vec3& x : lattice_points(lattice, lumen.bounds, [&](const Vec3& y) { return keeps_off(y, 0.3); })) {
        const double a = any(random), b = any(random), c = lumen.planar ? 0 * any(random) : any(random);
        const Vec3 moved = x + Vec3{a, b, c};
        set.point.push_back(shake > 0 && keeps_off(moved, 0.3) ? moved : x);
        set.spacing.push_back(spacing);
    }
    return set;
}

}   // namespace patency::testing_cells
