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
    const auto beyond = [](double low, double high, double at) { return std::max({low - at, at - high, 0.0}); };
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
    double a[3][size], b[3][size], c[3][size];   // corners

    void set(int n, const std::array<Vec3, 3>& p) {
        a[0][n] = p[0].x, a[1][n] = p[0].y, a[2][n] = p[0].z;
        b[0][n] = p[1].x, b[1][n] = p[1].y, b[2][n] = p[1].z;
        c[0][n] = p[2].x, c[1][n] = p[2].y, c[2][n] = p[2].z;
    }
    /// The squares of their distances from x, to round-off. Without branches, so that triangles go side by side.
    void squares_from(const Vec3& x, double* square) const {
        const auto dot = [](double ux, double uy, double uz, double vx, double vy, double vz) { return ux * vx + uy * vy + uz * vz; };
        const auto inverse = [](double length) { return 1 / std::max(length, 1e-300); };
        for (int n = 0; n < size; ++n) {
            const double px = x.x - a[0][n], py = x.y - a[1][n], pz = x.z - a[2][n];
            const double qx = x.x - b[0][n], qy = x.y - b[1][n], qz = x.z - b[2][n];
            const double ux = b[0][n] - a[0][n], uy = b[1][n] - a[1][n], uz = b[2][n] - a[2][n];   // ab, ac, bc
            const double vx = c[0][n] - a[0][n], vy = c[1][n] - a[1][n], vz = c[2][n] - a[2][n];
            const double wx = vx - ux, wy = vy - uy, wz = vz - uz;
            const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
            const double uu = dot(ux, uy, uz, ux, uy, uz), uv = dot(ux, uy, uz, vx, vy, vz), vv = dot(vx, vy, vz, vx, vy, vz),
                         nn = dot(nx, ny, nz, nx, ny, nz);
            const double pu = dot(px, py, pz, ux, uy, uz), pv = dot(px, py, pz, vx, vy, vz), pn = dot(px, py, pz, nx, ny, nz);
            const double per_nn = inverse(nn), s = (vv * pu - uv * pv) * per_nn, t = (uu * pv - uv * pu) * per_nn;
            const auto to_side = [&](double dx, double dy, double dz, double ex, double ey, double ez) {
                const double along = std::min(std::max(dot(dx, dy, dz, ex, ey, ez) * inverse(dot(ex, ey, ez, ex, ey, ez)), 0.0), 1.0);
                const double fx = dx - along * ex, fy = dy - along * ey, fz = dz - along * ez;
                return dot(fx, fy, fz, fx, fy, fz);
            };
            const double to_sides = std::min(std::min(to_side(px, py, pz, ux, uy, uz), to_side(px, py, pz, vx, vy, vz)),
                                             to_side(qx, qy, qz, wx, wy, wz));
            const double inside = std::min(std::min(s, t), 1 - s - t);   // nothing is over a triangle without area
            square[n] = inside > 0 && nn > 0 ? pn * pn * per_nn : to_sides;
        }
    }
};

/// A closed surface with the normals of its sides and corners.
struct ExactSurface {
    Surface surface;
    TriangleTree tree;
    std::vector<Leaf> leaves;
    std::vector<std::uint32_t> leaf_of;   // per node of the tree
    std::vector<std::array<Vec3, 7>> normals;   // per triangle and feature; of any length
    std::vector<bool> crumpled;                 // triangles whose normals do not tell the side


    explicit ExactSurface(Surface closed)
        : surface(std::move(closed)), tree(surface), leaf_of(tree.nodes().size(), 0), normals(surface.triangles.size()) {
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
        for (const TrianglePair& pair : find_crossing_triangles(surface, surface.triangles.size())) mark(pair.a), mark(pair.b);
        constexpr double folded = -0.5;   // cosine between neighbours' normals, of an edge sharper than 60 degrees: one may lie on the other
        for_each_edge(std::span<const EdgeUse>(uses), [&](std::span<const EdgeUse> edge) {
            for (const EdgeUse& use : edge)
                if (dot(normals[edge[0].triangle][0], normals[use.triangle][0]) < folded) mark(edge[0].triangle), mark(use.triangle);
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

    std::pair<std::uint32_t, NearestPlace> nearest(const Vec3& x) const {
        const auto& nodes = tree.nodes();
        std::uint32_t triangle = 0;
        NearestPlace best{};
        double least = Bounds::infinity;                            // the square of its distance
        std::array<std::pair<std::uint32_t, double>, 64> waiting;   // the tree is at most 32 deep, two nodes each
        std::size_t count = 0;
        waiting[count++] = {0, square_to(nodes[0].box, x)};
        while (count > 0) {
            const auto [index, square] = waiting[--count];
            if (square >= least) continue;
            const TriangleTree::Node& node = nodes[index];
            if (!node.is_leaf()) {
                std::pair nearer(node.left, square_to(nodes[node.left].box, x)),
                    farther(node.right, square_to(nodes[node.right].box, x));
                if (farther.second < nearer.second) std::swap(nearer, farther);
                waiting[count++] = farther, waiting[count++] = nearer;
                continue;
            }
            constexpr double round_off = 1e-9;   // a hundred thousand times that of both squares
            double square_of[Leaf::size];
            leaves[leaf_of[index]].squares_from(x, square_of);
            for (std::uint32_t k = node.begin; k < node.end; ++k) {
                if (square_of[k - node.begin] > least * (1 + round_off)) continue;
                const NearestPlace next = nearest_of(corners_of(tree.order()[k]), x);
                const Vec3 d = x - next.place;
                if (dot(d, d) < least) least = dot(d, d), best = next, triangle = tree.order()[k];
            }
        }
        return {triangle, best};
    }

    DistanceSample sample(const Vec3& x) const {
        const auto [t, near] = nearest(x);
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
    return {[exact](const Vec3& x) { return exact->sample(x); }, bounds(exact->surface)};
}

}   // namespace patency
