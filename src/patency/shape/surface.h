// SPDX-License-Identifier: Apache-2.0
// A surface of triangles and what can be said of it without judging it: area, volume, bounds, edges. Files are
// io's (surface_file.h), defects surface_check.h's, openings surface_openings.h's.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "patency/base/vec.h"
#include "patency/shape/signed_distance.h"

namespace patency {

using Triangle = std::array<std::uint32_t, 3>;   ///< indices of points, counter-clockwise seen from outside

struct Surface {
    std::vector<Vec3> points{};   ///< [m]
    std::vector<Triangle> triangles{};
    std::vector<std::int32_t>
        face_ids{};        ///< ModelFaceID (or number of the solid) per triangle; empty if there is none
    std::string space{};   ///< axes of the coordinates: "LPS", "RAS", or empty if nobody said
};

Vec3 area_vector(const Surface& surface, const Triangle& triangle);   ///< area times outward normal [m^2]
Vec3 centroid(const Surface& surface, const Triangle& triangle);      ///< [m]

double area(const Surface& surface);     ///< [m^2]
double volume(const Surface& surface);   ///< of a closed surface [m^3], negative if it is inside out
Bounds bounds(const Surface& surface);   ///< of all points [m]; infinite if there are none
double diagonal(const Bounds& box);      ///< [m]

/// The surface of some of its triangles, in this order, with the points they use.
Surface part_of(const Surface& surface, std::span<const std::uint32_t> triangles);

/// Points no farther apart than tolerance [m] become one, points without a triangle go. The order of the triangles stays;
/// some may have lost their area. Returns how many points went.
std::size_t merge_points(Surface& surface, double tolerance);

/// One side of a triangle as an edge between two points.
struct EdgeUse {
    std::uint32_t low, high;   ///< its points, low < high
    std::uint32_t triangle;
    bool rises;   ///< the triangle runs from low to high
};
/// The sides of all triangles with three different points, ordered by edge, then by triangle.
std::vector<EdgeUse> edge_uses(const Surface& surface);

/// visit(uses of one edge) for every edge.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit visit) {
    for (std::size_t begin = 0, end; begin < uses.size(); begin = end) {
        for (end = begin + 1; end < uses.size(); ++end)
            if (uses[end].low != uses[begin].low || uses[end].high != uses[begin].high) break;
        visit(uses.subspan(begin, end - begin));
    }
}

/// Sets of numbers 0..n-1 that are joined step by step.
class Groups {
public:
    explicit Groups(std::size_t count);
    std::uint32_t group_of(std::uint32_t i);   ///< the smallest member of its group
    void join(std::uint32_t i, std::uint32_t j);

private:
    std::vector<std::uint32_t> parent_;
};

}   // namespace patency
