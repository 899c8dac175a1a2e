// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/cell_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/cells/cell_shape.h"

namespace patency {

using namespace cell_shapes;

namespace {

constexpr double least_wall_distance = 0.25;   // of a point, in spacings: half of what it keeps in an even row
constexpr double most_outside = 1;             // of a point that is led back, in spacings
constexpr double wall_reach = 2.5;             // deeper points have no neighbour at the wall, in spacings
constexpr std::size_t task_size = 256;         // cells
constexpr double round_off = 1e-11;            // of a cell's area

/// body(begin, end) for runs of indices, on all threads; what the first of them throws comes out.
template <class Body>
void for_each_run(std::size_t count, Body body) {
    std::vector<std::exception_ptr> failures((count + task_size - 1) / task_size);
    for_each_task(failures.size(), [&](std::size_t t) {
        try {
            body(t, t * task_size, std::min(count, (t + 1) * task_size));
        } catch (...) {
            failures[t] = std::current_exception();
        }
    });
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

std::string text_of(const Vec3& x) {
    return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", 1e3 * x.x, 1e3 * x.y, 1e3 * x.z);
}

class MeshMaker {
public:
    MeshMaker(std::span<const Vec3> points, std::span<const double> spacing, const Lumen& lumen) : lumen_(lumen) {
        if (points.empty() || points.size() != spacing.size())
            throw GeometryError("Cells need points, and a spacing for each.");
        for (std::size_t i = 0; i < points.size(); ++i)
            if (!std::isfinite(points[i].x + points[i].y + points[i].z) || !(spacing[i] > 0) ||
                !std::isfinite(spacing[i]))
                throw GeometryError(fmt::format("Point {} is no place, or its spacing no length.", i));
        if (lumen.period.x > 0 || lumen.period.y > 0 || lumen.period.z > 0)
            throw GeometryError("Cells cannot be periodic; give the lumen openings.");
        lumen.distance.value(points[0]);   // those that are made when asked are made now, by all threads
        if (lumen.exact) lumen.exact->value(points[0]);
        mesh_.source = find_compact_order(points);
        for (const std::uint32_t i : mesh_.source) {
            mesh_.point.push_back(points[i]);
            spacing_.push_back(spacing[i]);
        }
    }

    CellMesh make() {
        find_walls();
        cut_cells();
        join_faces();
        fit_openings();
        close_cells();
        return std::move(mesh_);
    }

private:
    std::size_t size() const { return mesh_.point.size(); }

    void find_walls() {
        mesh_.wall_distance.resize(size());
        mesh_.wall_normal.resize(size());
        std::vector<std::size_t> led_back((size() + task_size - 1) / task_size);
        for_each_run(size(), [&](std::size_t task, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const double h = spacing_[i];
                mesh_.wall_distance[i] = CellMesh::far;
                const double depth = -lumen_.distance.value(mesh_.point[i]);
                if (!(depth < (wall_reach + 0.5) * h)) continue;
                if (depth < -most_outside * h)
                    throw GeometryError(fmt::format("A particle lies {:.3g} mm outside of the lumen, at {}.",
                                                    -1e3 * depth, text_of(mesh_.point[i])));
                NearestWall wall = find_wall(lumen_, mesh_.point[i], h);
                if (wall.distance < least_wall_distance * h) {
                    mesh_.point[i] += (wall.distance - least_wall_distance * h) * wall.normal;
                    wall = find_wall(lumen_, mesh_.point[i], h);
                    ++led_back[task];
                }
                mesh_.wall_distance[i] = wall.distance;
                mesh_.wall_normal[i] = wall.normal;
            }
        });
        for (const std::size_t n : led_back) mesh_.led_back += n;
        for (const Opening& opening : lumen_.openings)
            for (std::size_t i = 0; i < size(); ++i) {
                const auto [s, radial] = opening_coordinates(opening, mesh_.point[i]);
                if (s > 0 && s < spacing_[i] && norm(radial) < opening.reach)
                    throw GeometryError(fmt::format("A particle lies past the opening '{}', at {}.", opening.name,
                                                    text_of(mesh_.point[i])));
            }
    }

    void cut_cells() {
        const PointTree tree(mesh_.point);
        if (lumen_.planar) mesh_.depth = *std::min_element(spacing_.begin(), spacing_.end());
        const PointCloud cloud{mesh_.point, spacing_, tree, lumen_, 0.5 * mesh_.depth};
        mesh_.volume.resize(size());
        sides_.resize(size());
        for_each_run(size(), [&](std::size_t, std::size_t begin, std::size_t end) {
            CellMaker maker(cloud);
            for (std::size_t i = begin; i < end; ++i) {
                mesh_.volume[i] =
                    maker.make(std::uint32_t(i), {mesh_.wall_distance[i], mesh_.wall_normal[i], {}}, sides_[i]);
                std::sort(sides_[i].begin(), sides_[i].end(),
                          [](const CellSide& a, const CellSide& b) { return a.label < b.label; });
            }
        });
    }

    const CellSide* side_towards(std::size_t i, std::size_t j) const {
        const auto& sides = sides_[i];
        const auto found = std::lower_bound(sides.begin(), sides.end(), int(j),
                                            [](const CellSide& s, int label) { return s.label < label; });
        return found != sides.end() && found->label == int(j) ? &*found : nullptr;
    }

    void add_face(std::size_t a, std::size_t b, const CellSide* from_a, const CellSide* from_b) {
        const double seen_a = from_a ? from_a->area : 0, seen_b = from_b ? from_b->area : 0, both = seen_a + seen_b;
        if (!(both > 0)) return;
        const Vec3 way = mesh_.point[b] - mesh_.point[a];
        const double r = norm(way), area = 0.5 * both;
        Vec3 centroid{};
        if (from_a) centroid += seen_a / both * from_a->centroid;
        if (from_b) centroid += seen_b / both * from_b->centroid;
        mesh_.faces.push_back({std::uint32_t(a), std::uint32_t(b), area / r * way, centroid, area / r});
    }

    void join_faces() {
        for (std::size_t i = 0; i < size(); ++i)
            for (const CellSide& side : sides_[i]) {
                if (side.label < 0) continue;
                const auto j = std::size_t(side.label);
                const CellSide* back = side_towards(j, i);
                if (i < j)
                    add_face(i, j, &side, back);
                else if (!back)
                    add_face(j, i, nullptr, &side);
            }
        std::sort(mesh_.faces.begin(), mesh_.faces.end(),
                  [](const CellFace& p, const CellFace& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
        mesh_.row_start.assign(size() + 1, 0);
        for (const CellFace& face : mesh_.faces) ++mesh_.row_start[face.a + 1], ++mesh_.row_start[face.b + 1];
        for (std::size_t i = 0; i < size(); ++i) mesh_.row_start[i + 1] += mesh_.row_start[i];
        mesh_.row.resize(2 * mesh_.faces.size());
        // Those of smaller index come first, so every row rises.
        std::vector<std::uint32_t> next(mesh_.row_start.begin(), mesh_.row_start.end() - 1);
        for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
            mesh_.row[next[mesh_.faces[f].b]++] = {mesh_.faces[f].a, f};
        for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
            mesh_.row[next[mesh_.faces[f].a]++] = {mesh_.faces[f].b, f};
    }

    static int opening_of(const CellSide& side) {
        return side.label == wall_label       ? CellPatch::wall
               : side.label == symmetry_label ? CellPatch::symmetry
                                              : opening_label - side.label;
    }

    /// Tangent planes let the cells at the rim of a round opening reach a little too far: those give back what is too much.
    void fit_openings() {
        const std::size_t count = lumen_.openings.size();
        std::vector<double> inner(count), rim(count);
        const auto is_at_wall = [&](std::size_t i) {
            return std::any_of(sides_[i].begin(), sides_[i].end(),
                               [](const CellSide& s) { return s.label == wall_label; });
        };
        for (std::size_t i = 0; i < size(); ++i)
            for (const CellSide& side : sides_[i])
                if (side.label < 0 && opening_of(side) >= 0)
                    (is_at_wall(i) ? rim : inner)[std::size_t(opening_of(side))] += side.area;
        std::vector<double> scale(count, 1);
        for (std::size_t k = 0; k < count; ++k) {
            const double wanted = lumen_.openings[k].area * mesh_.depth;
            scale[k] = rim[k] > 0 ? (wanted - inner[k]) / rim[k] : 1;
            if (!(inner[k] + rim[k] > 0.8 * wanted) || !(scale[k] > 0.5) || !(scale[k] < 2))
                throw GeometryError(fmt::format(
                    "The particles at the opening '{}' cover {:.3g} mm2 instead of {:.3g} mm2: too few lie across it.",
                    lumen_.openings[k].name, 1e6 * (inner[k] + rim[k]), 1e6 * wanted));
            mesh_.opening_area.push_back(inner[k] + scale[k] * rim[k]);
        }
        mesh_.patch_start.assign(1, 0);
        for (std::size_t i = 0; i < size(); ++i) {
            const bool at_wall = is_at_wall(i);
            for (const CellSide& side : sides_[i]) {
                if (side.label >= 0) break;
                const int opening = opening_of(side);
                const double area = side.area * (opening >= 0 && at_wall ? scale[std::size_t(opening)] : 1);
                mesh_.patches.push_back(
                    {std::uint32_t(i), opening, area * side.normal, side.centroid, side.normal, side.distance});
            }
            mesh_.patch_start.push_back(std::uint32_t(mesh_.patches.size()));
        }
    }

    /// What the sides of a cell lack to a closed surface is the wall's: its neighbours saw other planes than its own.
    void close_cells() {
        std::vector<Vec3> open(size());
        std::vector<double> area(size());
        for (std::size_t i = 0; i < size(); ++i) {
            for (const CellNeighbour& n : mesh_.neighbours(i)) {
                const CellFace& face = mesh_.faces[n.face];
                open[i] += face.a == i ? face.area : -face.area;
                area[i] += norm(face.area);
            }
            for (const CellPatch& patch : mesh_.patches_of(i)) open[i] += patch.area;
        }
        std::vector<CellPatch> all;
        std::vector<std::uint32_t> start(1, 0);
        for (std::size_t i = 0; i < size(); ++i) {
            const std::size_t first = all.size();
            for (const CellPatch& patch : mesh_.patches_of(i)) all.push_back(patch);
            CellPatch* largest = nullptr;
            for (std::size_t k = first; k < all.size(); ++k)
                if (all[k].opening == CellPatch::wall &&
                    (!largest || dot(all[k].area, all[k].area) > dot(largest->area, largest->area)))
                    largest = &all[k];
            if (largest)
                largest->area -= open[i];
            else if (norm(open[i]) > round_off * area[i]) {
                if (!(mesh_.wall_distance[i] < CellMesh::far))
                    throw GeometryError(fmt::format("The cell at {} does not close.", text_of(mesh_.point[i])));
                const double d = mesh_.wall_distance[i];
                all.push_back({std::uint32_t(i), CellPatch::wall, -open[i], mesh_.point[i] + d * mesh_.wall_normal[i],
                               mesh_.wall_normal[i], d});
            }
            start.push_back(std::uint32_t(all.size()));
        }
        mesh_.patches = std::move(all);
        mesh_.patch_start = std::move(start);
    }

    const Lumen& lumen_;
    CellMesh mesh_;
    std::vector<double> spacing_;
    std::vector<std::vector<CellSide>> sides_;   // by label: boundaries, then neighbours in rising order
};

}   // namespace

CellMesh make_cell_mesh(std::span<const Vec3> points, std::span<const double> spacing, const Lumen& lumen) {
    return MeshMaker(points, spacing, lumen).make();
}

}   // namespace patency
