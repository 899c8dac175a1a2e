// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_lumen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "patency/base/errors.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/surface_distance.h"
#include "patency/shape/triangle_pairs.h"

namespace patency {

namespace {

using Rim = std::vector<std::uint32_t>;

/// The surface without what closes its openings.
Surface wall_of(const CheckedSurface& checked, std::span<const SurfaceOpening> openings) {
    std::vector<char> closes(checked.surface.triangles.size(), 0);
    for (const SurfaceOpening& opening : openings)
        for (const std::uint32_t t : opening.triangles) closes[t] = 1;
    std::vector<std::uint32_t> wall;
    for (std::uint32_t t = 0; t < closes.size(); ++t)
        if (!closes[t]) wall.push_back(t);
    return part_of(checked.surface, wall);
}

/// The loop of each opening, in their order.
std::vector<FlatLoop> rims_of(const Surface& wall, std::span<const SurfaceOpening> openings) {
    const std::vector<EdgeUse> uses = edge_uses(wall), boundary = boundary_edges(uses);
    std::vector<FlatLoop> loops = find_loops(wall, boundary), rims;
    for (const SurfaceOpening& opening : openings) {
        const auto away = [&](const FlatLoop& loop) { return norm(loop.centre - opening.opening.centre); };
        const auto found = std::min_element(loops.begin(), loops.end(),
                                            [&](const auto& a, const auto& b) { return away(a) < away(b); });
        if (found == loops.end() || away(*found) > 0.1 * opening.opening.radius)
            throw GeometryError(
                fmt::format("Opening '{}' has no rim of its own: its edge is the edge of no hole in the wall.",
                            opening.opening.name));
        rims.push_back(std::move(*found));
        loops.erase(found);
    }
    if (!loops.empty())
        throw GeometryError(
            fmt::format("The surface has {} more open edges than openings: close its holes.", loops.size()));
    return rims;
}

/// Joins the rim to a copy of it in the plane `height` past the centre, by a strip of triangles. Returns the copy.
Rim add_ring(Surface& surface, const Rim& rim, const Vec3& centre, const Vec3& normal, double height) {
    Rim ring;
    for (const std::uint32_t point : rim) {
        const Vec3 x = surface.points[point];
        ring.push_back(std::uint32_t(surface.points.size()));
        surface.points.push_back(x + (height - dot(x - centre, normal)) * normal);
    }
    for (std::size_t k = 0; k < rim.size(); ++k) {
        const std::size_t next = (k + 1) % rim.size();
        surface.triangles.push_back({rim[k], rim[next], ring[next]});
        surface.triangles.push_back({rim[k], ring[next], ring[k]});
    }
    return ring;
}

/// Closes the rim by a fan around its centre.
void add_cap(Surface& surface, const Rim& rim, const Vec3& centre) {
    const auto middle = std::uint32_t(surface.points.size());
    surface.points.push_back(centre);
    for (std::size_t k = 0; k < rim.size(); ++k)
        surface.triangles.push_back({middle, rim[k], rim[(k + 1) % rim.size()]});
}

/// Mean over the flat face of the squared distance from its centre [m^2].
double mean_square(const Surface& surface, const FlatLoop& loop) {
    double sum = 0;
    for (std::size_t k = 0; k < loop.rim.size(); ++k) {
        const Vec3 a = surface.points[loop.rim[k]] - loop.centre,
                   b = surface.points[loop.rim[(k + 1) % loop.rim.size()]] - loop.centre;
        sum += 0.5 * dot(cross(a, b), loop.normal) * (dot(a, a) + dot(a, b) + dot(b, b)) / 6;
    }
    return sum / loop.area;
}

/// No other part of the vessel may be where the opening's continuation is, nor touch it.
void expect_room(const Surface& surface, std::span<const FlatLoop> planes,
                 std::span<const std::pair<std::uint32_t, std::uint32_t>> own, std::span<const SurfaceOpening> openings,
                 const SurfaceLumenSettings& settings) {
    const auto refuse = [&](std::size_t k, double place) {
        throw GeometryError(fmt::format(
            "Opening '{}' cannot go on straight for {:.3g} mm, which the flow through it needs: another part of "
            "the vessel is in its way {:.3g} mm past it. Cut that end farther back (geometry.cut_back: {{{}: "
            "LENGTH}}), or take a smaller spacing.",
            openings[k].opening.name, 1e3 * settings.extension, 1e3 * place, openings[k].opening.name));
    };
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const FlatLoop& plane = planes[k];
        for (std::uint32_t point = 0; point < surface.points.size(); ++point) {
            if (point >= own[k].first && point < own[k].second) continue;
            const Vec3 from = surface.points[point] - plane.centre;
            const double s = dot(from, plane.normal);
            // At the rim of an oblique end the wall leans a little over the plane.
            if (s > 0.25 * plane.reach && s < settings.extension + 2 * plane.reach &&
                norm(from - s * plane.normal) < plane.reach + settings.outside)
                refuse(k, s);
        }
    }
    for (const TrianglePair& pair : find_crossing_triangles(surface, 1))
        for (std::size_t k = 0; k < planes.size(); ++k)
            for (const std::uint32_t t : {pair.a, pair.b})
                if (surface.triangles[t][2] >= own[k].first && surface.triangles[t][2] < own[k].second)
                    refuse(k, dot(pair.place - planes[k].centre, planes[k].normal));
}

}   // namespace

Lumen make_surface_lumen(const CheckedSurface& checked, std::span<const SurfaceOpening> openings,
                         const SurfaceLumenSettings& settings) {
    if (!(settings.extension > 0) || !(settings.straight >= 0) ||
        !std::isfinite(settings.extension + settings.straight))
        throw GeometryError("A lumen's straight continuations must have a length.");
    Surface surface = wall_of(checked, openings);
    surface.face_ids.clear();
    const std::vector<FlatLoop> rims = rims_of(surface, openings);
    std::vector<FlatLoop> planes;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> own(rims.size());   // points of each continuation
    for (std::size_t k = 0; k < rims.size(); ++k) {
        const FlatLoop& rim = rims[k];
        double height = 0;
        for (const std::uint32_t point : rim.rim)
            height = std::max(height, dot(surface.points[point] - rim.centre, rim.normal));
        const double straight = settings.straight * rim.diameter();
        const bool is_flat = rim.flatness < 1e-6 * rim.reach && straight == 0;
        planes.push_back(
            is_flat ? rim
                    : measured_loop(surface, add_ring(surface, rim.rim, rim.centre, rim.normal, height + straight)));
    }

    Lumen lumen{.distance = everywhere(),
                .openings = {},
                .volume = closed_volume(surface, planes),
                .wall_area = area(surface),
                .extension = settings.extension,
                .bounds = bounds(surface)};
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const FlatLoop& plane = planes[k];
        Opening opening = openings[k].opening;
        opening.centre = plane.centre;
        opening.normal = plane.normal;
        opening.area = plane.area;
        opening.radius = 0.5 * plane.diameter();
        opening.reach = plane.reach;
        opening.mean_square = mean_square(surface, plane);
        lumen.openings.push_back(std::move(opening));
    }
    // As far as opening_beyond() sees; the closing face is farther away than the side up to the extension's end.
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const FlatLoop& plane = planes[k];
        const double length = settings.extension + 2 * plane.reach;
        const int rings = std::max(1, int(std::ceil(length / plane.reach)));   // slender triangles make a slow tree
        const auto first = std::uint32_t(surface.points.size());
        Rim rim = plane.rim;
        for (int ring = 1; ring <= rings; ++ring)
            rim = add_ring(surface, rim, plane.centre, plane.normal, length * ring / rings);
        add_cap(surface, rim, plane.centre + length * plane.normal);
        own[k] = {first, std::uint32_t(surface.points.size())};
    }
    expect_room(surface, planes, own, openings, settings);
    const Bounds box = bounds(surface);
    lumen.exact = made_when_asked([surface] { return make_exact_distance(surface); }, box);
    lumen.distance =
        made_when_asked([closed = std::move(surface),
                         settings] { return make_surface_distance(closed, settings.voxel, settings.outside); },
                        box);
    return lumen;
}

}   // namespace patency
