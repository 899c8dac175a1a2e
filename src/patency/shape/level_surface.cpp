// SPDX-License-Identifier: Apache-2.0
// Dual surface: a point per crossing of a cell, a quadrangle per edge of the grid whose ends have different signs (Gibson
// 1998, surface nets), and a point for every sheet where a cell holds several, so that sheets stay apart (Nielson 2004,
// dual marching cubes).
#include "patency/shape/level_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

constexpr int block = 8;                       // cells along the side of what is looked at, or passed over, as a whole
constexpr std::size_t most_blocks = 200'000;   // some ten million triangles

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2). Edge 4 a + m runs along axis a from the corner whose bits on
// the axes a + 1 and a + 2 are the bits of m.
constexpr int corner_of(int axis, int along, int m) {
    return (along << axis) | ((m & 1) << (axis + 1) % 3) | ((m >> 1) << (axis + 2) % 3);
}
constexpr int start_of(int edge) { return corner_of(edge / 4, 0, edge % 4); }
constexpr int end_of(int edge) { return corner_of(edge / 4, 1, edge % 4); }
constexpr int edge_between(int a, int b) {
    for (int e = 0; e < 12; ++e)
        if ((start_of(e) == a && end_of(e) == b) || (start_of(e) == b && end_of(e) == a)) return e;
    return -1;
}

using CellValues = std::array<double, 8>;

/// For every edge of a cell a number that all edges of one sheet share, -1 if the level does not cross it.
std::array<int, 12> find_sheets(const CellValues& values) {
    const auto is_inside = [&](int corner) { return values[std::size_t(corner)] < 0; };
    std::array<int, 12> sheet;
    for (int e = 0; e < 12; ++e) sheet[e] = is_inside(start_of(e)) != is_inside(end_of(e)) ? e : -1;
    const auto join = [&](int a, int b) {
        const int from = std::max(sheet[a], sheet[b]), to = std::min(sheet[a], sheet[b]);
        std::replace(sheet.begin(), sheet.end(), from, to);
    };
    for (int face = 0; face < 6; ++face) {
        std::array<int, 4> corners, edges;   // in order around the face; edge k follows corner k
        std::vector<int> crossed;
        for (int k = 0; k < 4; ++k) corners[k] = corner_of(face / 2, face % 2, k ^ (k >> 1));
        for (int k = 0; k < 4; ++k) {
            edges[k] = edge_between(corners[k], corners[(k + 1) % 4]);
            if (sheet[edges[k]] >= 0) crossed.push_back(edges[k]);
        }
        if (crossed.size() == 2) join(crossed[0], crossed[1]);
        if (crossed.size() == 4)   // two inside corners across: kept apart, as the cell beyond the face does too
            for (int k = 0; k < 4; ++k)
                if (is_inside(corners[k])) join(edges[k], edges[(k + 3) % 4]);
    }
    return sheet;
}

struct CrossedCell {
    std::array<int, 3> at;
    CellValues values;
};

class Mesher {
public:
    Mesher(const LevelField& field, const LevelGrid& grid, const std::function<bool(const Bounds&)>& may_cross)
        : field_(field),
          grid_(grid),
          may_cross_(may_cross),
          step_(1e-3 * std::min({grid.cell.x, grid.cell.y, grid.cell.z})) {}

    Surface mesh() {
        find_cells();
        place_points();
        Surface surface{.points = std::move(points_)};
        for (const auto& [a, b, c, d] : quads()) {
            const auto& p = surface.points;
            if (norm(p[a] - p[c]) <= norm(p[b] - p[d]))
                surface.triangles.insert(surface.triangles.end(), {{a, b, c}, {a, c, d}});
            else
                surface.triangles.insert(surface.triangles.end(), {{b, c, d}, {b, d, a}});
        }
        return surface;
    }

private:
    Vec3 place(double i, double j, double k) const {
        return grid_.origin + Vec3{i * grid_.cell.x, j * grid_.cell.y, k * grid_.cell.z};
    }
    Vec3 place(const std::array<int, 3>& at, int corner) const {
        return place(at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2));
    }

    void find_cells() {
        int side = 1;
        for (int cells : grid_.cells)
            while (side * block < cells) side *= 2;
        gather({0, 0, 0}, side);
        std::vector<std::vector<CrossedCell>> found(blocks_.size());
#pragma omp parallel for schedule(dynamic, 1)
        for (std::size_t b = 0; b < blocks_.size(); ++b) look_at(blocks_[b], found[b]);
        for (const auto& cells : found) cells_.insert(cells_.end(), cells.begin(), cells.end());
        for (std::size_t c = 0; c < cells_.size(); ++c) index_.emplace(key(cells_[c].at), c);
    }

    /// The blocks that the level may cross, of a cube of side^3 blocks.
    void gather(const std::array<int, 3>& low, int side) {
        for (int k = 0; k < 3; ++k)
            if (low[k] >= grid_.cells[k]) return;
        const int width = side * block;
        if (!may_cross_({place(low, 0), place(low[0] + width, low[1] + width, low[2] + width)})) return;
        if (side == 1) {
            if (blocks_.size() == most_blocks)
                throw GeometryError(
                    fmt::format("The surface is too large for cells of {:.3g} m: take larger ones.", grid_.cell.x));
            blocks_.push_back(low);
            return;
        }
        const int s = side / 2;
        for (int c = 0; c < 8; ++c)
            gather({low[0] + (c & 1) * s * block, low[1] + (c >> 1 & 1) * s * block, low[2] + (c >> 2) * s * block}, s);
    }

    void look_at(const std::array<int, 3>& low, std::vector<CrossedCell>& found) const {
        std::array<int, 3> n;
        for (int k = 0; k < 3; ++k) n[k] = std::min(block, grid_.cells[k] - low[k]);
        std::vector<double> values;
        for (int k = 0; k <= n[2]; ++k)
            for (int j = 0; j <= n[1]; ++j)
                for (int i = 0; i <= n[0]; ++i) values.push_back(field_(place(low[0] + i, low[1] + j, low[2] + k)));
        for (int k = 0; k < n[2]; ++k)
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i) {
                    CrossedCell cell{{low[0] + i, low[1] + j, low[2] + k}, {}};
                    int inside = 0;
                    for (int c = 0; c < 8; ++c) {
                        const int x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
                        cell.values[c] =
                            values[(std::size_t(z) * std::size_t(n[1] + 1) + std::size_t(y)) * std::size_t(n[0] + 1) +
                                   std::size_t(x)];
                        inside += cell.values[c] < 0;
                    }
                    if (inside > 0 && inside < 8) found.push_back(cell);
                }
    }

    void place_points() {
        std::vector<std::array<int, 3>> home;
        for (const CrossedCell& cell : cells_) {
            const std::array<int, 12> sheet = find_sheets(cell.values);
            auto& point = point_.emplace_back();
            for (int first = 0; first < 12; ++first) {
                if (sheet[first] != first) continue;   // the lowest edge of a sheet names it
                Vec3 sum{};
                double count = 0;
                for (int e = first; e < 12; ++e) {
                    if (sheet[e] != first) continue;
                    const double a = cell.values[start_of(e)], b = cell.values[end_of(e)], t = a / (a - b);
                    const Vec3 from = place(cell.at, start_of(e));
                    sum += from + t * (place(cell.at, end_of(e)) - from);
                    ++count;
                    point[e] = std::uint32_t(points_.size());
                }
                points_.push_back(sum / count);
                home.push_back(cell.at);
            }
        }
        for_each_index(points_.size(), [&](std::size_t i) { move_onto_level(points_[i], home[i]); });
    }

    /// Newton's steps, as long as they stay in the point's own cell or nearly so: triangles cannot fold over.
    void move_onto_level(Vec3& x, const std::array<int, 3>& cell) const {
        const Vec3 low = place(cell, 0) - 0.2 * grid_.cell, high = place(cell, 7) + 0.2 * grid_.cell;
        for (int n = 0; n < 4; ++n) {
            const double f = field_(x);
            const Vec3 slope = gradient(field_, x, step_);
            const Vec3 next = x - (f / std::max(dot(slope, slope), 1e-12)) * slope;
            const bool stays = next.x >= low.x && next.x <= high.x && next.y >= low.y && next.y <= high.y &&
                               next.z >= low.z && next.z <= high.z;
            if (!stays || std::abs(field_(next)) >= std::abs(f)) return;
            x = next;
        }
    }

    std::vector<std::array<std::uint32_t, 4>> quads() const {
        std::vector<std::array<std::uint32_t, 4>> result;
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (int axis = 0; axis < 3; ++axis) {   // the edges from the cell's lowest corner
                const CellValues& values = cells_[c].values;
                const bool starts_inside = values[0] < 0, ends_inside = values[1 << axis] < 0;
                if (starts_inside == ends_inside) continue;
                std::array<std::uint32_t, 4> quad;
                bool is_whole = true;
                for (int n = 0; n < 4 && is_whole; ++n) {   // the cells around it, counter-clockwise
                    const int m = n ^ (n >> 1);             // the edge's place in that cell: 0, 1, 3, 2
                    std::array<int, 3> at = cells_[c].at;
                    at[(axis + 1) % 3] -= m & 1, at[(axis + 2) % 3] -= m >> 1;
                    const auto found = index_.find(key(at));
                    is_whole = found != index_.end();
                    if (is_whole) quad[n] = point_[found->second][4 * axis + m];
                }
                if (!is_whole) continue;
                if (!starts_inside) std::swap(quad[1], quad[3]);
                result.push_back(quad);
            }
        return result;
    }

    std::int64_t key(const std::array<int, 3>& at) const {
        return ((std::int64_t(at[2]) + 1) * (grid_.cells[1] + 2) + at[1] + 1) * (grid_.cells[0] + 2) + at[0] + 1;
    }

    const LevelField& field_;
    const LevelGrid grid_;
    const std::function<bool(const Bounds&)>& may_cross_;
    const double step_;
    std::vector<std::array<int, 3>> blocks_;
    std::vector<CrossedCell> cells_;
    std::unordered_map<std::int64_t, std::size_t> index_;
    std::vector<std::array<std::uint32_t, 12>> point_;   // of every cell and edge; void where the level does not cross
    std::vector<Vec3> points_;
};

}   // namespace

Vec3 gradient(const LevelField& field, const Vec3& x, double step) {
    const auto slope = [&](const Vec3& e) { return (field(x + step * e) - field(x - step * e)) / (2 * step); };
    return {slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
}

LevelGrid level_grid_around(const Bounds& box, double cell) {
    const auto count = [&](double low, double high) {
        const double cells = std::ceil((high - low) / cell);
        if (!(cells < 1e6))
            throw GeometryError(fmt::format("A box of {:.3g} m has too many cells of {:.3g} m.", high - low, cell));
        return std::max(1, int(cells));
    };
    return {box.low,
            {cell, cell, cell},
            {count(box.low.x, box.high.x), count(box.low.y, box.high.y), count(box.low.z, box.high.z)}};
}

Surface make_level_surface(const LevelField& field, const LevelGrid& grid,
                           const std::function<bool(const Bounds&)>& may_cross) {
    return Mesher(field, grid, may_cross).mesh();
}

double volume_beyond(const Surface& surface, const LevelField& field) {
    return sum_of(surface.triangles.size(), [&](std::size_t k) {
        const Triangle& t = surface.triangles[k];
        double missing = 0;
        for (int side = 0; side < 3; ++side) {   // the middles of the sides integrate a quadratic exactly
            const Vec3 &a = surface.points[t[side]], &b = surface.points[t[(side + 1) % 3]], x = 0.5 * (a + b);
            const double slope = norm(gradient(field, x, 1e-3 * norm(b - a)));
            if (slope > 0) missing -= field(x) / slope / 3;
        }
        return missing * norm(area_vector(surface, t));
    });
}

}   // namespace patency
