// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/stent_skin.h"

#include <cmath>

#include "patency/shape/exact_distance.h"
#include "patency/shape/level_surface.h"
#include "patency/shape/stent_chart.h"

namespace patency {

namespace {

const std::vector<std::string> names = {"outer", "inner", "side"};
constexpr double facing = 0.7071;   // cosine of the angle to the radius within which a face looks out or in

SurfaceElements skin_of(const StrutCurves& curves, const StentAxis& axis, double size) {
    Surface surface = make_stent_surface(curves, axis, size);
    SurfaceElements skin{
        .vertices = std::move(surface.points), .elements = std::move(surface.triangles), .face = {}, .faces = names};
    for (const auto& [a, b, c] : skin.elements) {
        const std::uint32_t inner = a % 2 + b % 2 + c % 2;   // points alternate
        skin.face.push_back(inner == 0 ? stent_outer : inner == 3 ? stent_inner : stent_side);
    }
    return skin;
}

/// The triangles of a file are slivers, and as large as flat faces allow. Cells a little smaller than the elements cut less of the
/// edges: 4 % of the volume of bars three elements wide.
SurfaceElements skin_of(const ImportedStent& stent, const StentAxis& axis, double size) {
    const SignedDistance metal = make_exact_distance(stent.surface);
    const double cell = 0.75 * size;
    const auto may_cross = [&](const Bounds& box) {
        return std::abs(metal.value(0.5 * (box.low + box.high))) <= 0.5 * norm(box.high - box.low);
    };
    Surface surface = make_level_surface([&](const Vec3& x) { return metal.value(x); },
                                         level_grid_around(metal.bounds(), cell), may_cross);
    SurfaceElements skin{.vertices = {}, .elements = std::move(surface.triangles), .face = {}, .faces = names};
    for (const auto& t : skin.elements) {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        const Vec3 area = cross(b - a, c - a), middle = a + b + c;
        const double out = (area.y * middle.y + area.z * middle.z) / (norm(area) * std::hypot(middle.y, middle.z));
        skin.face.push_back(out > facing ? stent_outer : out < -facing ? stent_inner : stent_side);
    }
    const StentAxis own;
    for (const Vec3& x : surface.points) skin.vertices.push_back(axis.place(own.coordinates(x)));
    return skin;
}

}   // namespace

SurfaceElements make_stent_skin(const StentForm& form, const StentAxis& axis, double size) {
    return std::visit([&](const auto& f) { return skin_of(f, axis, size); }, form);
}

}   // namespace patency
