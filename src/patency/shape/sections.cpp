// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "patency/base/parallel.h"

namespace patency {

namespace {

constexpr int width_directions = 90;   // two degrees apart: an ellipse's widths are right to 1e-3
constexpr double end_share = 0.02;     // of the radius: the end sections are cut so far inside

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The chains of edges that a plane cuts, neighbours joined by a triangle; a closed one does not repeat its first.
struct Chain {
    std::vector<Edge> edges{};
    bool is_closed = false;
};

std::vector<Chain> chains_of(const std::vector<std::pair<Edge, Edge>>& pieces) {
    std::map<Edge, std::vector<std::uint32_t>> pieces_at;
    for (std::uint32_t k = 0; k < pieces.size(); ++k)
        pieces_at[pieces[k].first].push_back(k), pieces_at[pieces[k].second].push_back(k);
    std::vector<char> is_used(pieces.size());
    const auto follow = [&](const Edge& start) {
        Chain chain{{start}};
        for (Edge at = start;;) {
            const auto& here = pieces_at[at];
            const auto next = std::find_if(here.begin(), here.end(), [&](std::uint32_t k) { return !is_used[k]; });
            if (next == here.end()) return chain;
            is_used[*next] = 1;
            at = pieces[*next].first == at ? pieces[*next].second : pieces[*next].first;
            if (at == start) {
                chain.is_closed = true;
                return chain;
            }
            chain.edges.push_back(at);
        }
    };
    std::vector<Chain> chains;
    for (const auto& [edge, here] : pieces_at)   // first those that begin at the surface's border
        if (here.size() == 1 && !is_used[here[0]]) chains.push_back(follow(edge));
    for (const auto& [edge, here] : pieces_at)
        if (std::any_of(here.begin(), here.end(), [&](std::uint32_t k) { return !is_used[k]; }))
            chains.push_back(follow(edge));
    return chains;
}

/// Coordinates in the plane, the place at 0.
struct Flat {
    double u, v;
};

double signed_area(const std::vector<Flat>& p) {
    double sum = 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
        const Flat &a = p[k], &b = p[(k + 1) % p.size()];
        sum += 0.5 * (a.u * b.v - a.v * b.u);
    }
    return sum;
}

bool holds(const std::vector<Flat>& p, const Flat& x) {   // by the crossings of a ray
    bool inside = false;
    for (std::size_t k = 0; k < p.size(); ++k) {
        const Flat &a = p[k], &b = p[(k + 1) % p.size()];
        if ((a.v > x.v) != (b.v > x.v) && x.u - a.u < (x.v - a.v) / (b.v - a.v) * (b.u - a.u)) inside = !inside;
    }
    return inside;
}

double nearest(const std::vector<Flat>& p) {
    double square = Bounds::infinity;
    for (const Flat& x : p) square = std::min(square, x.u * x.u + x.v * x.v);
    return square;
}

void measure_widths(CrossSection& section, const std::vector<Flat>& p) {
    section.least_width = Bounds::infinity;
    for (int k = 0; k < width_directions; ++k) {
        const double angle = std::numbers::pi * k / width_directions, c = std::cos(angle), s = std::sin(angle);
        double low = Bounds::infinity, high = -low;
        for (const Flat& x : p) low = std::min(low, c * x.u + s * x.v), high = std::max(high, c * x.u + s * x.v);
        section.least_width = std::min(section.least_width, high - low);
        section.most_width = std::max(section.most_width, high - low);
    }
}

/// Edges cut by a plane. A point on the plane counts as before it, so that a triangle has always two of them or none.
struct Cut {
    const Surface& surface;
    Vec3 place, normal;

    double height(std::uint32_t point) const { return dot(surface.points[point] - place, normal); }
    bool may_cut(const Bounds& box) const {
        const Vec3 centre = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
        const double reach = half.x * std::abs(normal.x) + half.y * std::abs(normal.y) + half.z * std::abs(normal.z);
        return std::abs(dot(centre - place, normal)) <= reach * (1 + 1e-9);
    }
    /// The two edges of every triangle that is cut.
    std::vector<std::pair<Edge, Edge>> pieces(const TriangleTree& tree) const {
        std::vector<std::pair<Edge, Edge>> found;
        std::vector<std::uint32_t> open;
        if (!tree.nodes().empty()) open.push_back(0);
        while (!open.empty()) {
            const TriangleTree::Node& node = tree.nodes()[open.back()];
            open.pop_back();
            if (!may_cut(node.box)) continue;
            if (node.is_leaf())
                for (std::uint32_t k = node.begin; k < node.end; ++k) add(tree.order()[k], found);
            else
                open.insert(open.end(), {node.right, node.left});
        }
        return found;
    }
    void add(std::uint32_t triangle, std::vector<std::pair<Edge, Edge>>& found) const {
        const Triangle& t = surface.triangles[triangle];
        std::array<Edge, 3> cut;
        std::size_t count = 0;
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t a = t[side], b = t[(side + 1) % 3];
            if ((height(a) >= 0) != (height(b) >= 0)) cut[count++] = std::minmax(a, b);
        }
        if (count == 2 && cut[0] != cut[1]) found.push_back({cut[0], cut[1]});
    }
    Vec3 crossing(const Edge& edge) const {
        const double a = height(edge.first), b = height(edge.second);
        return surface.points[edge.first] + (a / (a - b)) * (surface.points[edge.second] - surface.points[edge.first]);
    }
};

}   // namespace

double CrossSection::diameter() const { return 2 * std::sqrt(area / std::numbers::pi); }

CrossSection SectionCutter::cut(const Vec3& place, const Vec3& normal) const {
    const Vec3 u = normalized(cross(normal, std::abs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
               v = cross(normal, u);
    const Cut cut{surface_, place, normal};
    CrossSection best{.place = place, .normal = normal};
    std::vector<Flat> best_flat;
    double best_nearest = Bounds::infinity;
    for (const Chain& chain : chains_of(cut.pieces(tree_))) {
        if (chain.edges.size() < 3) continue;
        CrossSection section{.place = place, .normal = normal, .is_closed = chain.is_closed};
        std::vector<Flat> flat;
        for (const Edge& edge : chain.edges) {
            section.outline.push_back(cut.crossing(edge));
            const Vec3 d = section.outline.back() - place;
            flat.push_back({dot(d, u), dot(d, v)});
        }
        section.area = std::abs(signed_area(flat));
        section.holds_place = holds(flat, {0, 0});
        const double distance = nearest(flat);
        const bool is_better = section.holds_place != best.holds_place ? section.holds_place
                               : section.holds_place                   ? section.area < best.area
                                                                       : distance < best_nearest;
        if (!is_better) continue;
        best = std::move(section), best_flat = std::move(flat), best_nearest = distance;
    }
    if (best_flat.empty()) return best;
    if (signed_area(best_flat) < 0) std::reverse(best.outline.begin(), best.outline.end());
    for (std::size_t k = 0; k < best.outline.size(); ++k)
        best.perimeter += norm(best.outline[(k + 1) % best.outline.size()] - best.outline[k]);
    measure_widths(best, best_flat);
    return best;
}

namespace {

/// Whether the line passes through the section.
bool passes_through(const Centreline& line, const CrossSection& section) {
    const Vec3 n = section.normal;
    const Vec3 u = normalized(cross(n, std::abs(n.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), v = cross(n, u);
    std::vector<Flat> flat;
    for (std::size_t k = 1; k < line.points.size(); ++k) {
        const Vec3 a = line.points[k - 1].place - section.place, b = line.points[k].place - section.place;
        const double before = dot(a, n), after = dot(b, n);
        if ((before < 0) == (after < 0)) continue;
        const Vec3 x = a + (before / (before - after)) * (b - a);
        if (dot(x, x) > section.most_width * section.most_width) continue;
        if (flat.empty())
            for (const Vec3& corner : section.outline)
                flat.push_back({dot(corner - section.place, u), dot(corner - section.place, v)});
        if (holds(flat, {dot(x, u), dot(x, v)})) return true;
    }
    return false;
}

}   // namespace

std::vector<std::vector<CrossSection>> cut_sections(const Surface& surface, const BranchedLines& vessel) {
    const SectionCutter cutter(surface);
    std::vector<std::vector<CrossSection>> sections;
    for (std::size_t j = 0; j < vessel.lines.size(); ++j) {
        const auto& points = vessel.lines[j].points;
        std::vector<CrossSection>& row = sections.emplace_back(points.size());
        for_each_task(points.size(), [&](std::size_t k) {
            const CentrelinePoint& p = points[k];
            for (std::size_t i = 0; i < j; ++i)
                if (k < sections[i].size() && vessel.lines[i].points[k].place == p.place) {
                    row[k] = sections[i][k];
                    return;
                }
            const double inwards = k == 0 ? 1 : k + 1 == points.size() ? -1 : 0;
            row[k] = cutter.cut(p.place + (end_share * inwards * p.radius) * p.tangent, p.tangent);
            const int branch = vessel.branch_ids[j][k];
            row[k].is_shared = branch < 0;
            if (branch < 0) return;
            const auto& own = vessel.branches[std::size_t(branch)].lines;
            for (std::size_t i = 0; i < vessel.lines.size() && !row[k].is_shared; ++i)
                row[k].is_shared =
                    std::find(own.begin(), own.end(), i) == own.end() && passes_through(vessel.lines[i], row[k]);
        });
    }
    return sections;
}

}   // namespace patency
