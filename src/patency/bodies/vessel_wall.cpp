// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/vessel_wall.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/bodies/stent.h"
#include "patency/shape/measure.h"
#include "patency/shape/wall_face.h"

namespace patency {

namespace {

constexpr double fewest_through = 2.5;   // spacings through the wall: three layers
constexpr double held = 2.5;             // spacings: a support's worth of particles

WallLayer layer_at(const WallPlace& place, double adventitia_share) {
    if (place.healthy < 0) return WallLayer::plaque;
    return std::min(place.lumen, place.healthy) > (1 - adventitia_share) * place.thickness ? WallLayer::adventitia
                                                                                           : WallLayer::media;
}

/// Without those that were led away: beside a plane that cuts one branch next to another the distance jumps by the way to the other's plane,
/// and a particle that crosses the jump is sent as far. A few in ten thousand; many would be a wall that is not understood.
std::vector<Vec3> within(const SignedDistance& body, const StentParticles& particles, double spacing) {
    std::vector<Vec3> places;
    for (const Vec3& x : particles.position)
        if (body.value(x) < 0.5 * spacing) places.push_back(x);
    if (const double lost = 1 - double(places.size()) / double(particles.size()); lost > 0.01)
        throw GeometryError(
            fmt::format("{:.2g} % of the wall's particles do not stay in it: give deployment.region another value, so "
                        "that no end lies beside a bifurcation.",
                        100 * lost));
    return places;
}

void add_face(SurfaceElements& mesh, std::string name, const Surface& surface) {
    const auto face = std::uint16_t(mesh.faces.size());
    mesh.faces.push_back(std::move(name));
    const auto first = std::uint32_t(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), surface.points.begin(), surface.points.end());
    for (const Triangle& t : surface.triangles) {
        mesh.elements.push_back({first + t[0], first + t[1], first + t[2]});
        mesh.face.push_back(face);
    }
}

}   // namespace

std::string_view name_of(WallLayer layer) {
    switch (layer) {
        case WallLayer::plaque: return "plaque";
        case WallLayer::media: return "media";
        case WallLayer::adventitia: break;
    }
    return "adventitia";
}

VesselWall make_vessel_wall(const WallField& field, double spacing, double adventitia_share) {
    if (!(spacing > 0) || field.thinnest() < fewest_through * spacing)
        throw GeometryError(
            fmt::format("wall.spacing: {:.3g} mm leaves fewer than three particles through the wall, which is {:.3g} "
                        "mm thick where it is thinnest: take "
                        "{:.2g} mm or less.",
                        1e3 * spacing, 1e3 * field.thinnest(), 1e3 * field.thinnest() / 4));
    const SignedDistance body = field.wall();
    const Lumen as_lumen{.distance = body, .openings = {}, .volume = 0, .wall_area = 0, .bounds = body.bounds()};
    const double volume = measure(as_lumen, spacing / 3).volume;
    StentParticles particles;
    make_stent_particles(body, volume, spacing, particles);
    VesselWall wall{
        .places = within(body, particles, spacing), .volume = 0, .layer = {}, .is_at_end = {}, .surface = {}};
    wall.volume = volume / double(wall.places.size());
    for (const Vec3& x : wall.places) {
        const WallPlace at = field.at(x);
        wall.layer.push_back(layer_at(at, adventitia_share));
        wall.is_at_end.push_back(at.region > -held * spacing);
    }
    add_face(wall.surface, "lumen", wall_face(field, WallFace::lumen, spacing));
    add_face(wall.surface, "outer", wall_face(field, WallFace::outer, spacing));
    return wall;
}

}   // namespace patency
