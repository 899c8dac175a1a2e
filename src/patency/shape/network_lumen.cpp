// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/network_lumen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/level_surface.h"
#include "patency/shape/network_field.h"
#include "patency/shape/surface_cut.h"
#include "patency/shape/surface_distance.h"

namespace patency {

namespace {

constexpr double cells_across_radius = 6;   // the flatness of triangles then costs 0.1 % of the radius
constexpr double most_triangles = 3e7;      // a tree of 1 m of tubes from 4.5 to 0.7 mm has 6 million

Tube extended(Tube tube, double extension) {
    if (tube.start) {
        tube.points.insert(tube.points.begin(), tube.points.front() + extension * tube.start->normal);
        tube.radii.insert(tube.radii.begin(), tube.radii.front());
    }
    if (tube.end) {
        tube.points.push_back(tube.points.back() + extension * tube.end->normal);
        tube.radii.push_back(tube.radii.back());
    }
    return tube;
}

Network extended(Network network, double extension) {
    for (Tube& tube : network.tubes) tube = extended(std::move(tube), extension);
    return network;
}

double cell_for(const Network& network, double resolution) {
    return std::min(resolution, 0.5 * narrowest_diameter(network) / cells_across_radius);
}

/// Refuses a point or a radius that is too large by far at once, and not after minutes of looking for the wall.
void expect_not_too_fine(const Network& network, double cell) {
    double wall = 0;   // m^2
    for (const Tube& tube : network.tubes)
        for (std::size_t k = 1; k < tube.points.size(); ++k)
            wall += std::numbers::pi * (tube.radii[k - 1] + tube.radii[k]) *
                    std::hypot(norm(tube.points[k] - tube.points[k - 1]), tube.radii[k] - tube.radii[k - 1]);
    constexpr double per_cell = 3;   // triangles per square of a cell's side, whichever way the wall lies
    const double triangles = per_cell * wall / (cell * cell);
    if (triangles < most_triangles) return;
    throw GeometryError(
        fmt::format("The network's wall of {:.3g} mm^2 would be {:.2g} triangles of {:.3g} mm, which are too many. Its "
                    "narrowest diameter is {:.3g} mm: "
                    "is one of its points or radii wrong?",
                    1e6 * wall, triangles, 1e3 * cell, 1e3 * narrowest_diameter(network)));
}

/// Of the network continued past its openings, all around.
Surface closed_surface(const NetworkField& field, double cell) {
    const auto may_cross = [&](const Bounds& box) {
        return std::abs(field.value(0.5 * (box.low + box.high))) <= 0.5 * field.steepest() * diagonal(box);
    };
    return make_level_surface([&](const Vec3& x) { return field.value(x); },
                              level_grid_around(grown(field.bounds(), 2 * cell), cell), may_cross);
}

/// Cut flat at the openings and closed there; the rims are the circles they should be.
void cut_openings(Surface& surface, const std::vector<Opening>& openings, double cell, double extension) {
    for (std::size_t k = 0; k < openings.size(); ++k) {
        const Opening& o = openings[k];
        const double past = extension + 2 * o.radius;
        if (cut_flat(surface, {o.centre, o.normal, 1.5 * o.radius, past}, 0.3 * cell, std::int32_t(k + 2)) != 1)
            throw GeometryError(fmt::format(
                "Opening '{}' does not cut its tube in one circle: move it away from other tubes.", o.name));
        for (Vec3& x : surface.points) {
            const auto [s, radial] = opening_coordinates(o, x);
            const double aside = norm(radial);
            if (std::abs(s) < 1e-3 * cell && aside > 0.5 * o.radius && aside < 1.5 * o.radius)
                x = o.centre + (o.radius / aside) * radial;
        }
    }
}

Surface wall_of(const Surface& surface) {
    std::vector<std::uint32_t> wall;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        if (surface.face_ids[t] == 1) wall.push_back(t);
    return part_of(surface, wall);
}

}   // namespace

std::vector<Opening> openings_of(const Network& network, double extension) {
    std::vector<Opening> openings;
    for (std::size_t t = 0; t < network.tubes.size(); ++t) {
        const Tube& tube = network.tubes[t];
        const auto add = [&](const std::optional<TubeOpening>& end, const Vec3& centre, double r) {
            if (!end) return;
            openings.push_back({end->name, centre, end->normal, std::numbers::pi * r * r, r, r, false, r * r / 2});
            Network rest = network;
            rest.tubes.erase(rest.tubes.begin() + std::ptrdiff_t(t));
            if (rest.tubes.empty()) return;
            const NetworkField others(extended(std::move(rest), extension));
            for (double s = 0; s <= extension; s += 0.25 * r)
                if (others.value(centre + s * end->normal) < r + network.blend)
                    throw GeometryError(fmt::format(
                        "Opening '{}' runs into another tube {:.3g} mm past its plane: move the opening, or "
                        "shorten the extension of {:.3g} mm.",
                        end->name, 1e3 * s, 1e3 * extension));
        };
        add(tube.start, tube.points.front(), tube.radii.front());
        add(tube.end, tube.points.back(), tube.radii.back());
    }
    std::stable_sort(openings.begin(), openings.end(), [](const Opening& a, const Opening& b) {
        return (a.name == "inlet") != (b.name == "inlet") ? a.name == "inlet" : a.area > b.area;
    });
    return openings;
}

Surface make_network_surface(const Network& network, double resolution) {
    expect_sound(network);
    const double cell = cell_for(network, resolution), extension = 4 * cell;
    expect_not_too_fine(network, cell);
    const std::vector<Opening> openings = openings_of(network, extension);
    Surface surface = closed_surface(NetworkField(extended(network, extension)), cell);
    cut_openings(surface, openings, cell, extension);
    surface.space = network.space;
    return surface;
}

Lumen make_network_lumen(const Network& network, double extension, double resolution) {
    expect_sound(network);
    const double cell = cell_for(network, resolution);
    expect_not_too_fine(network, cell);
    const std::vector<Opening> openings = openings_of(network, extension);
    const NetworkField field(extended(network, extension));
    Surface surface = closed_surface(field, cell);
    constexpr double voxels_outside =
        14;   // of the resolution: a wall for the kernels of particles twice as wide apart
    SignedDistance distance = made_when_asked(
        [surface, resolution] { return make_surface_distance(surface, resolution, voxels_outside * resolution); },
        bounds(surface));
    SignedDistance exact = made_when_asked([surface] { return make_exact_distance(surface); }, bounds(surface));
    cut_openings(surface, openings, cell, extension);
    const Surface wall = wall_of(surface);
    return {.distance = std::move(distance),
            .openings = openings,
            .volume = volume(surface) + volume_beyond(wall, [&](const Vec3& x) { return field.value(x); }),
            .wall_area = area(wall),
            .extension = extension,
            .bounds = bounds(surface),
            .narrowest = narrowest_diameter(network),
            .passage = passage_of(network),
            .exact = std::move(exact)};
}

}   // namespace patency
