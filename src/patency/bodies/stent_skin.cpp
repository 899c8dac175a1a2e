// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/stent_skin.h"

#include "patency/shape/stent_chart.h"

namespace patency {

SurfaceElements make_stent_skin(const StrutCurves& curves, const StentAxis& axis, double size) {
    Surface surface = make_stent_surface(curves, axis, size);
    SurfaceElements skin{.vertices = std::move(surface.points), .elements = std::move(surface.triangles), .face = {},
                         .faces = {"outer", "inner", "side"}};
    for (const auto& [a, b, c] : skin.elements) {
        const std::uint32_t inner = a % 2 + b % 2 + c % 2;   // points alternate
        skin.face.push_back(inner == 0 ? stent_outer : inner == 3 ? stent_inner : stent_side);
    }
    return skin;
}

}   // namespace patency
