// SPDX-License-Identifier: Apache-2.0
// Vessels for the tests of stages: surfaces made from a few numbers, followed along their centrelines.
#pragma once

#include <cmath>
#include <numbers>

#include "patency/shape/network_lumen.h"
#include "patency/stages/vessel.h"
#include "tests/shape/surfaces.h"

namespace patency {

/// A tube along x that a cosine narrows in its middle over a third of its length.
inline Surface make_stenosed_tube(double radius, double length, double stenosis) {
    Surface surface = make_tube_mesh({.radius = radius, .length = length, .around = 48, .along = 120});
    for (Vec3& x : surface.points) {
        const double z = (x.x - 0.5 * length) / (length / 6);
        const double factor = std::abs(z) < 1 ? 1 - 0.5 * stenosis * (1 + std::cos(std::numbers::pi * z)) : 1;
        x.y *= factor, x.z *= factor;
    }
    return surface;
}

/// A trunk of 3 mm that parts into branches of 2.6 and 2.2 mm; `stenosis` of the diameter in the wider one.
inline Network make_y(double stenosis = 0) {
    Network network{
        .tubes = {{.name = "trunk", .points = {{0, 0, 0}, {12e-3, 0, 0}}, .radii = {1.5e-3, 1.5e-3}},
                  {.name = "left", .points = {{12e-3, 0, 0}, {28e-3, 12e-3, 0}}, .radii = {1.3e-3, 1.3e-3}},
                  {.name = "right", .points = {{12e-3, 0, 0}, {22e-3, -12e-3, 0}}, .radii = {1.1e-3, 1.1e-3}}}};
    open_free_ends(network);
    if (stenosis > 0) add_lesion(network, {.tube = "left", .position = 11e-3, .length = 6e-3, .stenosis = stenosis});
    return network;
}
inline Surface make_y_surface(double stenosis = 0) { return make_network_surface(make_y(stenosis), 0.3e-3); }

inline Vessel followed(Surface surface) {
    Vessel vessel = check_vessel(std::move(surface));
    follow_vessel(vessel);
    return vessel;
}

}   // namespace patency
