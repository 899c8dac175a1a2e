// SPDX-License-Identifier: Apache-2.0
// Surfaces made for tests: tubes, tori, any lumen's wall, finer ones of the same shape.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

struct TubeMesh {
    double radius = 1e-3, length = 6e-3;   // m, around the x axis from x = 0
    std::uint32_t around = 48, along = 40;
    bool start_cap = false, end_cap = false, round_end = false;
    double flat_share = 1;   ///< of the radius: the height of the section over its width
};
inline Surface make_tube_mesh(const TubeMesh& tube) {
    Surface s;
    const auto ring = [&](double x, double scale) {
        const auto first = std::uint32_t(s.points.size());
        for (std::uint32_t k = 0; k < tube.around; ++k) {
            const double angle = 2 * std::numbers::pi * k / tube.around, r = tube.radius * scale;
            s.points.push_back({x, r * std::cos(angle), r * tube.flat_share * std::sin(angle)});
        }
        return first;
    };
    const auto join_rings = [&](std::uint32_t a, std::uint32_t b, std::int32_t id) {
        for (std::uint32_t k = 0; k < tube.around; ++k) {
            const std::uint32_t next = (k + 1) % tube.around;
            s.triangles.push_back({a + k, a + next, b + k});
            s.triangles.push_back({b + k, a + next, b + next});
            s.face_ids.insert(s.face_ids.end(), 2, id);
        }
    };
    const auto close = [&](std::uint32_t rim, const Vec3& tip, bool is_start, std::int32_t id) {
        const auto centre = std::uint32_t(s.points.size());
        s.points.push_back(tip);
        for (std::uint32_t k = 0; k < tube.around; ++k) {
            const std::uint32_t next = (k + 1) % tube.around;
            s.triangles.push_back({centre, rim + (is_start ? next : k), rim + (is_start ? k : next)});
            s.face_ids.push_back(id);
        }
    };
    const std::uint32_t first = ring(0, 1);
    std::uint32_t last = first;
    for (std::uint32_t j = 1; j <= tube.along; ++j) {
        const std::uint32_t next = ring(tube.length * j / tube.along, 1);
        join_rings(last, next, 1);
        last = next;
    }
    if (tube.start_cap) close(first, {0, 0, 0}, true, 2);
    if (tube.end_cap) close(last, {tube.length, 0, 0}, false, 3);
    if (tube.round_end) {   // a half sphere
        constexpr int rings = 12;
        for (int j = 1; j < rings; ++j) {
            const double angle = 0.5 * std::numbers::pi * j / rings;
            const std::uint32_t next = ring(tube.length + tube.radius * std::sin(angle), std::cos(angle));
            join_rings(last, next, 1);
            last = next;
        }
        close(last, {tube.length + tube.radius, 0, 0}, false, 1);
    }
    return s;
}

inline Surface make_torus_mesh(double large, double small, std::uint32_t around, std::uint32_t across) {
    Surface s;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across,
                         r = large + small * std::cos(b);
            s.points.push_back({r * std::cos(a), r * std::sin(a), small * std::sin(b)});
            const auto at = [&](std::uint32_t m, std::uint32_t n) { return (m % around) * across + n % across; };
            s.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            s.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    return s;
}

/// The zero level of a distance within a box, on cells of that size, by marching tetrahedra: open where the box cuts it,
/// every corner of every triangle a point of its own, slivers where the level passes near a corner of a cell.
inline Surface make_level_mesh(const SignedDistance& distance, const Bounds& box, double cell) {
    Surface s;
    const auto count = [&](double low, double high) { return int(std::lround((high - low) / cell)); };
    const int nx = count(box.low.x, box.high.x), ny = count(box.low.y, box.high.y), nz = count(box.low.z, box.high.z);
    const auto place = [&](int i, int j, int k) { return box.low + cell * Vec3{double(i), double(j), double(k)}; };
    std::vector<double> value(std::size_t(nx + 1) * (ny + 1) * (nz + 1));
    const auto at = [&](int i, int j, int k) -> double& {
        return value[(std::size_t(i) * (ny + 1) + j) * (nz + 1) + k];
    };
    for (int i = 0; i <= nx; ++i)
        for (int j = 0; j <= ny; ++j)
            for (int k = 0; k <= nz; ++k) at(i, j, k) = distance.value(place(i, j, k));
    struct Corner {
        Vec3 x;
        double d;
    };
    const auto cut = [](Corner a, Corner b) {
        if (std::tuple(a.x.x, a.x.y, a.x.z) > std::tuple(b.x.x, b.x.y, b.x.z))
            std::swap(a, b);   // the same point from every cell
        return a.x + (a.d / (a.d - b.d)) * (b.x - a.x);
    };
    const auto add = [&](const Vec3& a, Vec3 b, Vec3 c, const Vec3& inside) {
        if (dot(cross(b - a, c - a), a - inside) < 0) std::swap(b, c);
        const auto first = std::uint32_t(s.points.size());
        s.points.insert(s.points.end(), {a, b, c});
        s.triangles.push_back({first, first + 1, first + 2});
    };
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
            for (int k = 0; k < nz; ++k)
                for (const auto& path : {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
                    std::array<int, 3> n{i, j, k};   // six tetrahedra around the cell's diagonal
                    std::vector<Corner> in, out;
                    for (int step = 0; step < 4; ++step) {
                        const Corner corner{place(n[0], n[1], n[2]), at(n[0], n[1], n[2])};
                        (corner.d < 0 ? in : out).push_back(corner);
                        if (step < 3) ++n[path[step]];
                    }
                    if (in.size() == 1) add(cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2]), in[0].x);
                    if (in.size() == 3)
                        add(cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0]),
                            in[0].x + in[1].x + in[2].x - 2.0 * out[0].x);
                    if (in.size() == 2) {
                        add(cut(in[0], out[0]), cut(in[0], out[1]), cut(in[1], out[0]), 0.5 * (in[0].x + in[1].x));
                        add(cut(in[1], out[1]), cut(in[0], out[1]), cut(in[1], out[0]), 0.5 * (in[0].x + in[1].x));
                    }
                }
    return s;
}

/// Every triangle as four.
inline Surface subdivided(const Surface& surface) {
    Surface s{.points = surface.points, .space = surface.space};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), std::uint32_t(s.points.size()));
        if (is_new) s.points.push_back(0.5 * (s.points[a] + s.points[b]));
        return found->second;
    };
    for (const auto& [a, b, c] : surface.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        s.triangles.insert(s.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return s;
}

inline Surface joined_surfaces(Surface a, const Surface& b, const Vec3& shift) {
    const auto first = std::uint32_t(a.points.size());
    for (const Vec3& x : b.points) a.points.push_back(x + shift);
    for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    a.face_ids.clear();
    return a;
}

}   // namespace patency
