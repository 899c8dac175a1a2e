// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/exact_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "patency/base/errors.h"
#include "patency/base/pack.h"
#include "patency/shape/ray_parity.h"
#include "patency/shape/triangle_pairs.h"
#include "patency/shape/triangle_tree.h"

namespace patency {

namespace {

/// The nearest place of the segment from a along ab.
double along(const Vec3& a, const Vec3& ab, const Vec3& x) {
    const double square = dot(ab, ab);
    return square > 0 ? std::clamp(dot(x - a, ab) / square, 0.0, 1.0) : 0;
}

double square_to(const Bounds& box, const Vec3& x) {
    const auto beyond = [](double low, double high, double at) { return std::max(std::max(low - at, at - high), 0.0); };
    const Vec3 d{beyond(box.low.x, box.high.x, x.x), beyond(box.low.y, box.high.y, x.y),
                 beyond(box.low.z, box.high.z, x.z)};
    return dot(d, d);
}

/// The nearest place of a triangle, and on which of its features it is: 0 inside, 1..3 on the side that starts at corner
/// 0..2, 4..6 in corner 0..2.
struct NearestPlace {
    Vec3 place{};
    std::size_t feature = 0;
};

NearestPlace nearest_of(const std::array<Vec3, 3>& p, const Vec3& x) {
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    bool is_above = dot(n, n) > 0;   // over the triangle
    for (std::size_t k = 0; k < 3 && is_above; ++k) is_above = dot(cross(n, p[(k + 1) % 3] - p[k]), x - p[k]) > 0;
    if (is_above) return {x - (dot(x - p[0], n) / dot(n, n)) * n, 0};
    NearestPlace best{p[0], 4};
    double nearest = Bounds::infinity;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 ab = p[(k + 1) % 3] - p[k];
        const double t = along(p[k], ab, x);
        const Vec3 place = p[k] + t * ab;
        const double square = dot(x - place, x - place);
        if (!(square < nearest)) continue;
        nearest = square;
        best = {place, t == 0 ? 4 + k : t == 1 ? 4 + (k + 1) % 3 : 1 + k};
    }
    return best;
}

/// The triangles of a leaf side by side, the last of them again to fill it.
struct Leaf {
    static constexpr int size = int(TriangleTree::leaf_size);
    using P = Pack<double, size>;
    Vec<P> a, b, c;   // corners

    void set(int n, const std::array<Vec3, 3>& p) {
        for (const auto& [corner, at] : {std::pair{&a, p[0]}, {&b, p[1]}, {&c, p[2]}})
            corner->x.v[n] = at.x, corner->y.v[n] = at.y, corner->z.v[n] = at.z;
    }
    /// The squares of their distances from x, to round-off. Without branches, so that triangles go side by side.
    void squares_from(const Vec3& x, std::array<double, std::size_t(size)>& square) const {
        const auto inverse = [](P length) { return P(1) / max(length, P(1e-300)); };
        const Vec<P> at{P(x.x), P(x.y), P(x.z)}, p = at - a, q = at - b, ab = b - a, ac = c - a, normal = cross(ab, ac);
        const P bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), nn = dot(normal, normal);
        const P pb = dot(p, ab), pc = dot(p, ac), pn = dot(p, normal), per_nn = inverse(nn);
        const P s = (cc * pb - bc * pc) * per_nn, t = (bb * pc - bc * pb) * per_nn;
        const auto to_side = [&](const Vec<P>& from_start, const Vec<P>& side) {
            const P along = min(max(dot(from_start, side) * inverse(dot(side, side)), P(0)), P(1));
            const Vec<P> d = from_start - along * side;
            return dot(d, d);
        };
        const P to_sides = min(min(to_side(p, ab), to_side(p, ac)), to_side(q, ac - ab)), to_plane = pn * pn * per_nn;
        const P inside = min(min(s, t), P(1) - s - t);   // nothing is over a triangle without area
        for (std::size_t n = 0; n < square.size(); ++n)
            square[n] = inside[int(n)] > 0 && nn[int(n)] > 0 ? to_plane[int(n)] : to_sides[int(n)];
    }
};

/// A closed surface with the normals of its sides and corners.
struct ExactSurface {
    Surface surface;
    TriangleTree tree;
    std::vector<Leaf> leaves;
    std::vector<std::uint32_t> leaf_of;         // per node of the tree
    std::vector<std::array<Vec3, 7>> normals;   // per triangle and feature; of any length
    std::vector<bool> crumpled;                 // triangles whose normals do not tell the side

    explicit ExactSurface(Surface closed)
        : surface(std::move(closed)),
          tree(surface),
          leaf_of(tree.nodes().size(), 0),
          normals(surface.triangles.size()) {
        make_leaves();
        std::vector<Vec3> corner(surface.points.size());
        for (std::size_t k = 0; k < normals.size(); ++k) {
            const Triangle& t = surface.triangles[k];
            const Vec3 area = area_vector(surface, t);
            const Vec3 n = norm(area) > 0 ? normalized(area) : Vec3{};
            normals[k].fill(n);
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3 u = surface.points[t[(c + 1) % 3]] - surface.points[t[c]],
                           v = surface.points[t[(c + 2) % 3]] - surface.points[t[c]];
                corner[t[c]] += std::atan2(norm(cross(u, v)), dot(u, v)) * n;
            }
        }
        for (std::size_t k = 0; k < normals.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c) normals[k][4 + c] = corner[surface.triangles[k][c]];
        const std::vector<EdgeUse> uses = edge_uses(surface);
        for_each_edge(std::span<const EdgeUse>(uses), [&](std::span<const EdgeUse> edge) {
            if (edge.size() == 1) {
                const Vec3 x = 1e3 * surface.points[edge[0].low];
                throw GeometryError(
                    fmt::format("The surface is not closed: an edge at ({:.3f}, {:.3f}, {:.3f}) mm has "
                                "only one triangle.",
                                x.x, x.y, x.z));
            }
            Vec3 sum{};
            for (const EdgeUse& use : edge) sum += normals[use.triangle][0];
            for (const EdgeUse& use : edge) {
                const Triangle& t = surface.triangles[use.triangle];
                const std::uint32_t start = use.rises ? use.low : use.high;
                for (std::size_t c = 0; c < 3; ++c)
                    if (t[c] == start) normals[use.triangle][1 + c] = sum;
            }
        });
        find_crumpled(uses);
    }

    /// Those that pass through another or fold back on it, and all that touch them.
    void find_crumpled(const std::vector<EdgeUse>& uses) {
        std::vector<bool> at_point(surface.points.size(), false);
        const auto mark = [&](std::uint32_t triangle) {
            for (const std::uint32_t point : surface.triangles[triangle]) at_point[point] = true;
        };
        for (const TrianglePair& pair : find_crossing_triangles(surface, surface.triangles.size()))
            mark(pair.a), mark(pair.b);
        constexpr double folded =
            -0.5;   // cosine between neighbours' normals, of an edge sharper than 60 degrees: one may lie on the other
        for_each_edge(std::span<const EdgeUse>(uses), [&](std::span<const EdgeUse> edge) {
            for (const EdgeUse& use : edge)
                if (dot(normals[edge[0].triangle][0], normals[use.triangle][0]) < folded)
                    mark(edge[0].triangle), mark(use.triangle);
        });
        crumpled.resize(surface.triangles.size());
        for (std::size_t k = 0; k < crumpled.size(); ++k)
            for (const std::uint32_t point : surface.triangles[k]) crumpled[k] = crumpled[k] || at_point[point];
    }

    std::array<Vec3, 3> corners_of(std::uint32_t triangle) const {
        const Triangle& t = surface.triangles[triangle];
        return {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
    }

    void make_leaves() {
        for (std::size_t k = 0; k < tree.nodes().size(); ++k) {
            const TriangleTree::Node& node = tree.nodes()[k];
            if (!node.is_leaf()) continue;
            leaf_of[k] = std::uint32_t(leaves.size());
            Leaf& leaf = leaves.emplace_back();
            for (int n = 0; n < Leaf::size; ++n)
                leaf.set(n, corners_of(tree.order()[std::min(node.begin + std::uint32_t(n), node.end - 1)]));
        }
    }

    struct Nearest {
        std::uint32_t triangle;
        NearestPlace near;
        bool is_within;   ///< reach; if not, triangle and place are none
        double
            least_square;   ///< what no triangle's squared distance is less than, and at least that of reach if none is within it
    };
    Nearest nearest(const Vec3& x, double reach) const {
        const auto& nodes = tree.nodes();
        std::uint32_t triangle = 0;
        NearestPlace best{};
        double least = reach * reach;                               // the square of its distance
        double beyond = Bounds::infinity;                           // that of all which are left out for being farther
        std::array<std::pair<std::uint32_t, double>, 64> waiting;   // the tree is at most 32 deep, two nodes each
        std::size_t count = 0;
        waiting[count++] = {0, square_to(nodes[0].box, x)};
        while (count > 0) {
            const auto [index, square] = waiting[--count];
            if (square >= least) {
                beyond = std::min(beyond, square);
                continue;
            }
            const TriangleTree::Node& node = nodes[index];
            if (!node.is_leaf()) {
                std::pair nearer(node.left, square_to(nodes[node.left].box, x)),
                    farther(node.right, square_to(nodes[node.right].box, x));
                if (farther.second < nearer.second) std::swap(nearer, farther);
                waiting[count++] = farther, waiting[count++] = nearer;
                continue;
            }
            constexpr double round_off = 1e-9;   // a hundred thousand times that of both squares
            std::array<double, std::size_t(Leaf::size)> square_of;
            leaves[leaf_of[index]].squares_from(x, square_of);
            for (std::uint32_t k = node.begin; k < node.end; ++k) {
                beyond = std::min(beyond, square_of[k - node.begin] * (1 - round_off));
                if (square_of[k - node.begin] > least * (1 + round_off)) continue;
                const NearestPlace next = nearest_of(corners_of(tree.order()[k]), x);
                const Vec3 d = x - next.place;
                if (dot(d, d) < least) least = dot(d, d), best = next, triangle = tree.order()[k];
            }
        }
        const bool is_within = !(least == reach * reach && reach < Bounds::infinity);
        return {triangle, best, is_within, is_within ? least : std::max(beyond, least)};
    }

    DistanceSample sample(const Vec3& x, double reach) const {
        const auto [t, near, is_within, least_square] = nearest(x, reach);
        if (!is_within) return {-std::sqrt(least_square), {}, 0};
        const Vec3 n = normals[t][near.feature];
        const double distance = norm(x - near.place);
        const bool inside = crumpled[t] ? is_enclosed(surface, tree, x) : dot(x - near.place, n) < 0;
        const double sign = inside ? -1 : 1;
        if (distance == 0) return {0, norm(n) > 0 ? normalized(n) : Vec3{1, 0, 0}, 0};
        return {sign * distance, (sign / distance) * (x - near.place), 0};
    }
};

}   // namespace

SignedDistance make_exact_distance(Surface closed) {
    if (closed.triangles.empty()) throw GeometryError("A surface without triangles has no distance.");
    const auto exact = std::make_shared<const ExactSurface>(std::move(closed));
    return {[exact](const Vec3& x) { return exact->sample(x, Bounds::infinity); }, bounds(exact->surface),
            [exact](const Vec3& x, double reach) { return exact->sample(x, reach); }};
}

}   // namespace patency
