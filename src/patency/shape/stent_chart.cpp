// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

constexpr double sliver = 0.02;   // a cut is at least this part of an edge away from its ends

// A corner of the cut-out metal: a node of the grid, or where an edge of the grid meets the strut's edge.
struct Corner {
    std::uint32_t id;   // the same for all triangles that share it
    FlatPoint at;       // not wrapped within a triangle
    bool is_cut;
};

class Chart {
public:
    Chart(const StrutCurves& curves, double resolution) : map_(curves) {
        double thinnest = Bounds::infinity;
        for (const Strut& strut : curves.struts) thinnest = std::min(thinnest, 2 * strut.half_width);
        const double step = resolution > 0 ? resolution : thinnest / 6;
        around_ = std::uint32_t(std::max(8.0, std::ceil(map_.circumference() / step)));
        along_ = std::uint32_t(std::ceil(curves.length / step)) + 4;
        if (double(around_) * along_ > 4e8)
            throw GeometryError(fmt::format("A grid of {:.3g} mm is too fine for this stent.", 1e3 * step));
        step_around_ = map_.circumference() / around_;
        step_along_ = curves.length / (along_ - 4);
        low_ = -curves.length / 2 - 2 * step_along_;
        value_.resize(std::size_t(around_) * (along_ + 1));
        for_each_index(value_.size(), [&](std::size_t n) {
            value_[n] = map_.value(place(std::uint32_t(n % around_), std::uint32_t(n / around_)));
        });
    }

    const StrutMap& map() const { return map_; }
    std::uint32_t nodes() const { return std::uint32_t(value_.size()); }
    bool is_metal(std::uint32_t node) const { return value_[node] < 0; }
    double value(std::uint32_t node) const { return value_[node]; }
    double triangle_area() const { return 0.5 * step_around_ * step_along_; }
    double step() const { return std::max(step_around_, step_along_); }
    FlatPoint place_of(std::uint32_t node) const { return place(node % around_, node / around_); }
    bool is_at_end(std::uint32_t node) const { return node < around_ || node >= nodes() - around_; }

    /// visit(three nodes, polygon of metal) for every triangle of the grid.
    template <class Visit>
    void for_each_triangle(Visit visit) const {
        for (std::uint32_t j = 0; j < along_; ++j)
            for (std::uint32_t i = 0; i < around_; ++i) {
                const Node a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
                // Edges are known by the node they start at: 0 around, 1 along, 2 across the square.
                cut({a, b, c}, {3 * a.id, 3 * b.id + 1, 3 * a.id + 2}, visit);
                cut({a, c, d}, {3 * a.id + 2, 3 * d.id, 3 * a.id + 1}, visit);
            }
    }

private:
    struct Node {
        std::uint32_t id;
        FlatPoint at;
    };
    FlatPoint place(std::uint32_t i, std::uint32_t j) const { return {i * step_around_, low_ + j * step_along_}; }
    Node node(std::uint32_t i, std::uint32_t j) const { return {i % around_ + around_ * j, place(i, j)}; }

    template <class Visit>
    void cut(const std::array<Node, 3>& n, const std::array<std::uint32_t, 3>& edges, Visit& visit) const {
        std::array<Corner, 4> metal;
        std::size_t count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Node &p = n[k], &q = n[(k + 1) % 3];
            if (is_metal(p.id)) metal[count++] = {p.id, p.at, false};
            if (is_metal(p.id) == is_metal(q.id)) continue;
            // The same cut from both sides of the edge, to the last bit: from the lower node on.
            const Node &from = p.id < q.id ? p : q, &to = p.id < q.id ? q : p;
            const double t = std::clamp(value_[from.id] / (value_[from.id] - value_[to.id]), sliver, 1 - sliver);
            metal[count++] = {nodes() + edges[k],
                              {from.at.around + t * (to.at.around - from.at.around),
                               from.at.along + t * (to.at.along - from.at.along)},
                              true};
        }
        visit(std::array{n[0].id, n[1].id, n[2].id}, std::span<const Corner>(metal.data(), count));
    }

    StrutMap map_;
    std::uint32_t around_, along_;
    double step_around_, step_along_, low_;
    std::vector<double> value_;
};

double area_of(std::span<const Corner> polygon) {
    double sum = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const FlatPoint &a = polygon[k].at, &b = polygon[(k + 1) % polygon.size()].at, &o = polygon[0].at;
        sum += 0.5 * ((a.around - o.around) * (b.along - o.along) - (b.around - o.around) * (a.along - o.along));
    }
    return sum;
}

// The strut's edge in a triangle: from one cut to the next, metal on its left.
std::optional<std::array<Corner, 2>> strut_edge(std::span<const Corner> polygon) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Corner &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        if (a.is_cut && b.is_cut) return std::array{a, b};
    }
    return {};
}
double length_of(const std::array<Corner, 2>& edge) {
    return std::hypot(edge[1].at.around - edge[0].at.around, edge[1].at.along - edge[0].at.along);
}

// The largest circle near a place: uphill in ever smaller steps.
void climb(const StrutMap& map, StentCell& cell, double step) {
    double best = map.value(cell.centre);
    for (double s = step; s > step / 256; s /= 2)
        for (bool moved = true; moved;) {
            moved = false;
            for (int k = 0; k < 8; ++k) {
                const double angle = k * std::numbers::pi / 4;
                const FlatPoint next{cell.centre.around + s * std::cos(angle), cell.centre.along + s * std::sin(angle)};
                if (const double v = map.value(next); v > best) best = v, cell.centre = next, moved = true;
            }
        }
    cell.inscribed = 2 * best;
}

}   // namespace

StentMeasures measure_stent(const StrutCurves& curves, double resolution) {
    const Chart chart(curves, resolution);
    Groups groups(chart.nodes());   // of metal and of what is free
    chart.for_each_triangle([&](const auto& nodes, auto) {
        for (int k = 0; k < 3; ++k)
            if (const std::uint32_t a = nodes[k], b = nodes[(k + 1) % 3]; chart.is_metal(a) == chart.is_metal(b))
                groups.join(a, b);
    });

    StentMeasures result{};
    std::map<std::uint32_t, StentCell> cells;
    std::map<std::uint32_t, bool> pieces, ends;
    for (std::uint32_t n = 0; n < chart.nodes(); ++n) {
        const std::uint32_t group = groups.group_of(n);
        if (chart.is_metal(n)) {
            pieces[group] = true;
            continue;
        }
        if (chart.is_at_end(n)) ends[group] = true;
        StentCell& cell = cells[group];
        if (chart.value(n) > cell.inscribed) cell.inscribed = chart.value(n), cell.centre = chart.place_of(n);
    }
    chart.for_each_triangle([&](const auto& nodes, std::span<const Corner> metal) {
        const double cut_out = area_of(metal);
        result.plan_area += cut_out;
        const auto free = std::find_if(nodes.begin(), nodes.end(), [&](auto n) { return !chart.is_metal(n); });
        if (free == nodes.end()) return;
        StentCell& cell = cells[groups.group_of(*free)];
        cell.area += chart.triangle_area() - cut_out;
        if (const auto edge = strut_edge(metal)) {
            cell.perimeter += length_of(*edge);
            result.edge_length += length_of(*edge);
        }
    });
    for (auto& [group, cell] : cells) {
        if (ends.contains(group)) continue;
        climb(chart.map(), cell, chart.step());
        result.cells.push_back(cell);
    }
    const double e = curves.edge_radius, pi = std::numbers::pi;
    result.volume = curves.thickness * result.plan_area - (2 - pi / 2) * e * e * result.edge_length;
    result.surface_area = 2 * result.plan_area + (curves.thickness - (4 - pi) * e) * result.edge_length;
    result.metal_ratio = result.plan_area / (curves.circumference() * curves.length);
    if (pieces.size() != 1)
        throw GeometryError(fmt::format("The stent falls into {} pieces: its struts do not join.", pieces.size()));
    if (curves.cells >= 0 && result.cells.size() != std::size_t(curves.cells))
        throw GeometryError(
            fmt::format("The stent has {} cells where its pattern has {}: struts overlap. Reduce strut_width, "
                        "connector_width or connector_swing, or widen gap.",
                        result.cells.size(), curves.cells));
    return result;
}

Surface make_stent_surface(const StrutCurves& curves, const StentAxis& axis, double resolution) {
    const Chart chart(curves, resolution);
    Surface surface;
    std::vector<std::uint32_t> number(4 * std::size_t(chart.nodes()), 0);   // of nodes and edges, from 1
    const auto outer = [&](const Corner& corner) {
        std::uint32_t& known = number[corner.id];
        if (known == 0) {
            for (double side : {0.5, -0.5})
                surface.points.push_back(axis.place({curves.middle_radius + side * curves.thickness,
                                                     corner.at.around / curves.middle_radius, corner.at.along}));
            known = std::uint32_t(surface.points.size() / 2);
        }
        return 2 * (known - 1);   // the inner face's point follows
    };
    chart.for_each_triangle([&](const auto&, std::span<const Corner> metal) {
        for (std::size_t k = 2; k < metal.size(); ++k) {
            const std::uint32_t a = outer(metal[0]), b = outer(metal[k - 1]), c = outer(metal[k]);
            surface.triangles.push_back({a, b, c});
            surface.triangles.push_back({a + 1, c + 1, b + 1});
        }
        if (const auto edge = strut_edge(metal)) {
            const std::uint32_t a = outer((*edge)[0]), b = outer((*edge)[1]);
            surface.triangles.push_back({a + 1, b + 1, b});
            surface.triangles.push_back({a + 1, b, a});
        }
    });
    return surface;
}

}   // namespace patency
