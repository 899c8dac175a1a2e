// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/contact_hit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "patency/bodies/closest_point.h"

namespace patency {

namespace {

/// What a place x sees of an element: its nearest point.
struct Sight {
    std::array<double, 3> weights;   // of the element's corners
    Vec3 way;                        // from x [m]

    Sight(const SolidSurface& surface, std::uint32_t element, const Vec3& x) {
        const auto& [ia, ib, ic] = surface.mesh().elements[element];
        const Vec3 &a = surface.position[ia], &b = surface.position[ib], &c = surface.position[ic];
        weights = surface.planar() ? closest_on_segment(x, a, b) : closest_on_triangle(x, a, b, c);
        way = weights[0] * a + weights[1] * b + weights[2] * c - x;
    }
    /// How far x lies behind the plane of an element that faces like `facing`; negative: before it.
    double behind(const SolidSurface& surface, std::uint32_t facing) const {
        const Vec3 across = surface.area_vector(facing);
        return dot(way, across) / norm(across);
    }
};

/// How far x lies behind what it sees most squarely beside a thin element, among that (`behind` it at the distance `nearest`) and elements
/// that are not thin and as near but for its width: it keeps them apart from the edge that they would share.
double behind_beside(const SolidSurface& surface, const ContactSearch& search, std::uint32_t thin, const Vec3& x,
                     double nearest, double behind) {
    const auto& elements = surface.mesh().elements;
    const auto& at = surface.elements_at();
    double longest = 0, away = nearest;   // away: how far what is seen most squarely is
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest,
                           norm(surface.position[elements[thin][k]] - surface.position[elements[thin][(k + 1) % 3]]));
    for (const std::uint32_t corner : elements[thin])
        for (const std::uint32_t* e = at.begin(corner); e < at.end(corner); ++e) {
            if (search.facing(*e) != *e) continue;
            const Sight sight(surface, *e, x);
            const double distance = norm(sight.way), here = sight.behind(surface, *e);
            if (distance > nearest + ContactSearch::thin * longest) continue;
            if (std::abs(here) * away > std::abs(behind) * distance) behind = here, away = distance;
        }
    return behind;
}

}   // namespace

ContactHit find_contact_hit(const Vec3& x, std::size_t vertex, const SolidSurface& other, const ContactSearch& search,
                            double& clearance) {
    double nearest = search.reach(), behind = 0;
    ContactHit hit;
    std::optional<std::uint32_t> thin;   // among the nearest
    for (const auto* near = search.candidates().begin(vertex); near < search.candidates().end(vertex); ++near) {
        if (near->distance - search.moved() > nearest * (1 + 1e-9)) break;   // nor can those behind it be nearer
        const std::uint32_t e = near->element;
        const Sight sight(other, e, x);
        const double distance = norm(sight.way);
        // Where an edge or a corner is nearest its elements tie, and the one that x stands out of most tells the side; of those in one plane
        // the first by number, in whatever order a search found them.
        const bool is_tie = std::abs(distance - nearest) <= 1e-9 * nearest;
        if (!is_tie && distance > nearest) continue;
        if (!is_tie) thin.reset();
        if (search.facing(e) != e) thin = e;
        const double here = sight.behind(other, search.facing(e)), further = std::abs(here) - std::abs(behind);
        if (is_tie && (further < 0 || (further == 0 && e > hit.element))) continue;
        nearest = distance, behind = here;
        hit = {distance, distance > 0 ? sight.way / distance : normalized(other.area_vector(search.facing(e))), e,
               sight.weights};
    }
    if (thin) behind = behind_beside(other, search, *thin, x, nearest, behind);
    const bool is_inside = behind > 0;
    clearance = is_inside ? 0 : nearest;
    if (!is_inside) hit.depth *= -1, hit.normal *= -1;
    return hit;
}

}   // namespace patency
