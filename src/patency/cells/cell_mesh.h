// SPDX-License-Identifier: Apache-2.0
// The cells of still particles: of each its Voronoi cell within the lumen. No mesh to repair: a cell is made of its own
// neighbours and walls alone. Each particle has its own spacing.                                    THEORY.md (18.1)
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "patency/shape/lumen.h"

namespace patency {

/// What two cells share.
struct CellFace {
    std::uint32_t a, b;   ///< cells, a < b
    Vec3 area;            ///< from a to b, along the line between their points [m^2]
    Vec3 centroid;        ///< [m]
    double conductance;   ///< |area| over the distance of the points [m]
};

/// What a cell shares with the wall or an opening.
struct CellPatch {
    static constexpr int wall = -1, symmetry = -2;
    std::uint32_t cell;
    int opening;       ///< of the lumen; or wall; or symmetry: the two sides of a planar lumen's slab
    Vec3 area;         ///< out of the lumen [m^2]
    Vec3 centroid;     ///< [m]
    Vec3 normal;       ///< unit, of the plane
    double distance;   ///< of the cell's point from the plane, > 0 [m]
};

/// A face seen from a cell.
struct CellNeighbour {
    std::uint32_t cell, face;
};

struct CellMesh {
    static constexpr double far = std::numeric_limits<double>::infinity();

    std::vector<Vec3> point;                             ///< [m], in an order that keeps neighbours near
    std::vector<std::uint32_t> source;                   ///< which of the points given it was
    std::vector<double> volume;                          ///< [m^3]
    std::vector<double> wall_distance;                   ///< [m], > 0; far: deeper than any neighbour needs
    std::vector<Vec3> wall_normal;                       ///< unit, out of the lumen, at the nearest place of the wall
    std::vector<CellFace> faces;                         ///< ordered by a, then b
    std::vector<CellPatch> patches;                      ///< ordered by cell
    std::vector<std::uint32_t> row_start, patch_start;   ///< per cell, and one more
    std::vector<CellNeighbour> row;                      ///< per cell, by rising neighbour
    std::vector<double> opening_area;                    ///< per opening, of the patches [m^2]; the lumen's own
    double depth = 1;                                    ///< of the slab that stands for a planar lumen [m]; 1 in space
    std::size_t led_back = 0;                            ///< points that were moved off the wall

    std::size_t size() const { return point.size(); }
    std::span<const CellNeighbour> neighbours(std::size_t i) const {
        return {row.data() + row_start[i], row.data() + row_start[i + 1]};
    }
    std::span<const CellPatch> patches_of(std::size_t i) const {
        return {patches.data() + patch_start[i], patches.data() + patch_start[i + 1]};
    }
};

/// The cells of points in the lumen behind its openings, spacing: of each [m]. Voronoi cells, cut by the tangent plane at
/// the nearest place of the wall, by further planes where a corner still reaches out of the lumen, and by the openings. Two
/// cells see the same face to round-off except at the wall; the mean of both is taken, and the areas of a cell sum to zero
/// to round-off: the patches of the wall make up for the rest. Patches of an opening sum to its area. A planar lumen
/// becomes a slab one spacing deep. Points nearer to the wall than a quarter of a spacing are led back to there.
/// The same bits for any number of threads. Throws GeometryError for points that are outside, too close or too far apart.
CellMesh make_cell_mesh(std::span<const Vec3> points, std::span<const double> spacing, const Lumen& lumen);

}   // namespace patency
