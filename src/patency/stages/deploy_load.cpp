// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_load.h"

#include <algorithm>

#include "patency/base/parallel.h"
#include "patency/bodies/stent_skin.h"

namespace patency {

InnerFace::InnerFace(const SolidSurface& stent, const StentAxis& axis) : stent_(stent) {
    const SurfaceElements& mesh = stent.mesh();
    std::vector<double> area(stent.size());
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        if (mesh.face[e] != stent_inner) continue;
        const auto& [a, b, c] = mesh.elements[e];
        const double third = norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 6;
        for (const std::uint32_t v : mesh.elements[e]) area[v] += third, area_ += third;
    }
    for (std::uint32_t v = 0; v < area.size(); ++v) {
        if (area[v] == 0) continue;
        std::size_t piece = StentAxis::unseen;
        const StentAxis::Sight seen = axis.sight(mesh.vertices[v], piece);
        const Vec3 outward = area[v] / area_ * seen.outward;
        places_.push_back({v, outward});
        of_axis_ += dot(outward, mesh.vertices[v] - seen.radius * seen.outward);
    }
}

double InnerFace::radius() const {
    return sum_of(places_.size(),
                  [&](std::size_t k) { return dot(places_[k].outward, stent_.position[places_[k].vertex]); }) -
           of_axis_;
}

double InnerFace::speed() const {
    return sum_of(places_.size(),
                  [&](std::size_t k) { return dot(places_[k].outward, stent_.velocity(places_[k].vertex)); });
}

double RadialLoad::pressure(double time) const {
    const double r = radius(), stiffness = most / (full_lag * r);   // Pa/m
    const double lag = std::min(filled, pumped(time)) - r;
    if (lag <= 0) return 0;   // there is no fluid between
    return std::clamp(stiffness * lag - 2 * std::sqrt(stiffness * mass_by_area) * speed(), 0.0, most);
}

void RadialLoad::fill(double time) { filled = radius() * (1 + full_lag * pressure(time) / most); }

}   // namespace patency
