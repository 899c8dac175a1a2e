// SPDX-License-Identifier: Apache-2.0
// One cell at a time: the Voronoi cell of a point within the lumen. Private to cell_mesh.cpp.
#pragma once

#include <vector>

#include "patency/cells/point_tree.h"
#include "patency/cells/polyhedron.h"
#include "patency/shape/lumen.h"

namespace patency::cell_shapes {

/// The nearest place of the wall.
struct NearestWall {
    double distance;   ///< [m], negative for a place outside
    Vec3 normal;       ///< unit, out of the lumen
    Vec3 place;        ///< [m]
};

/// Of x; the distance must be known to about `scale` [m] only.
NearestWall find_wall(const Lumen& lumen, const Vec3& x, double scale);

/// A side of a cell, as that cell sees it.
struct CellSide {
    int label;               ///< the neighbour, or one of the labels below
    double area;             ///< [m^2]
    Vec3 centroid, normal;   ///< [m]; unit, of the plane, of boundaries only
    double distance;         ///< of the point from the plane [m], of boundaries only
};
constexpr int box_label = -1, symmetry_label = -2, wall_label = -3,
              opening_label = -4;   // opening k: opening_label - k

struct PointCloud {
    std::span<const Vec3> point;
    std::span<const double> spacing;
    const PointTree& tree;
    const Lumen& lumen;
    double half_depth;   ///< of a planar lumen's slab [m]
};

/// Makes cells, one after the other, in storage that it keeps.
class CellMaker {
public:
    explicit CellMaker(const PointCloud& cloud) : cloud_(cloud) {}

    /// Cuts the cell of point i, whose nearest wall is given. Appends its sides; returns its volume [m^3].
    double make(std::uint32_t i, const NearestWall& wall, std::vector<CellSide>& sides);

private:
    struct Plane {
        Vec3 normal;
        double offset;   // in spacings from the point
        int label;
    };
    void clip(const Plane& plane);
    void clip_by_openings();
    void clip_by_neighbours(std::uint32_t i);
    void clip_by_walls(const NearestWall& wall);
    Plane wall_at(const Vec3& corner) const;
    bool clip_outermost_corner();

    const PointCloud& cloud_;
    Polyhedron shape_;
    std::vector<Plane> planes_;
    std::vector<std::uint32_t> found_;
    std::vector<std::pair<double, std::uint32_t>> near_;
    Vec3 centre_{};
    double unit_ = 1;
};

}   // namespace patency::cell_shapes
