// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/solid_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "patency/bodies/stent.h"

namespace patency {

namespace {

using std::numbers::pi;

int parts(double length, double spacing) { return std::max(1, int(std::lround(length / spacing))); }

/// Vertices on circles around an axis at several heights, all the same number, and what joins them.
class TubeMesh {
public:
    explicit TubeMesh(SurfaceElements& mesh) : mesh_(mesh) {}

    std::uint16_t face(const std::string& name) {
        mesh_.faces.push_back(name);
        return std::uint16_t(mesh_.faces.size() - 1);
    }
    /// Numbers of `count` vertices on a circle; a radius of zero gives one vertex.
    std::vector<std::uint32_t> circle(const Vec3& centre, const Vec3& e1, const Vec3& e2, double radius, int count) {
        std::vector<std::uint32_t> numbers;
        for (int k = 0; k < (radius > 0 ? count : 1); ++k) {
            const double angle = 2 * pi * k / count;
            numbers.push_back(std::uint32_t(mesh_.vertices.size()));
            mesh_.vertices.push_back(centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2));
        }
        return numbers;
    }
    void segments(const std::vector<std::uint32_t>& circle, std::uint16_t face, bool inward) {
        for (std::size_t k = 0; k < circle.size(); ++k) {
            const std::uint32_t a = circle[k], b = circle[(k + 1) % circle.size()];
            add(inward ? std::array{b, a, a} : std::array{a, b, b}, face);
        }
    }
    /// Triangles between two circles, whose numbers may differ: the one whose next vertex comes first around steps on.
    /// `flip` turns their normals, which otherwise point along (around the circle) x (from a to b).
    void stitch(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b, std::uint16_t face,
                bool flip) {
        const auto at = [](const std::vector<std::uint32_t>& c, std::size_t k) { return c[k % c.size()]; };
        const auto turn = [](const std::vector<std::uint32_t>& c, std::size_t k) {
            return c.size() == 1 ? 2.0 : double(k) / double(c.size());
        };
        std::size_t i = 0, j = 0;
        while (i < (a.size() == 1 ? 0 : a.size()) || j < (b.size() == 1 ? 0 : b.size())) {
            const bool step_a = a.size() > 1 && i < a.size() &&
                                (j >= (b.size() == 1 ? 0 : b.size()) || turn(a, i + 1) <= turn(b, j + 1));
            const std::array<std::uint32_t, 3> t =
                step_a ? std::array{at(a, i), at(a, i + 1), at(b, j)} : std::array{at(a, i), at(b, j + 1), at(b, j)};
            add(flip ? std::array{t[0], t[2], t[1]} : t, face);
            ++(step_a ? i : j);
        }
    }

private:
    void add(const std::array<std::uint32_t, 3>& element, std::uint16_t face) {
        mesh_.elements.push_back(element);
        mesh_.face.push_back(face);
    }
    SurfaceElements& mesh_;
};

/// The six faces of a box as grids of triangles that share their edges.
void mesh_box(const Vec3& low, const std::array<int, 3>& n, const std::array<double, 3>& h, SurfaceElements& mesh) {
    std::map<std::array<int, 3>, std::uint32_t> number;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [entry, is_new] = number.emplace(at, std::uint32_t(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(low + Vec3{at[0] * h[0], at[1] * h[1], at[2] * h[2]});
        return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool is_high : {false, true}) {
            mesh.faces.push_back(std::string(1, char('x' + int(axis))) + (is_high ? "_high" : "_low"));
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int i = 0; i < n[u]; ++i)
                for (int j = 0; j < n[v]; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> at{};
                        at[axis] = is_high ? n[axis] : 0, at[u] = i + a, at[v] = j + b;
                        return vertex(at);
                    };
                    std::array<std::uint32_t, 4> q = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    if (!is_high) std::swap(q[1], q[3]);
                    // The diagonals alternate, so that no direction is preferred.
                    if ((i + j) % 2 == 0)
                        mesh.elements.push_back({q[0], q[1], q[2]}), mesh.elements.push_back({q[0], q[2], q[3]});
                    else
                        mesh.elements.push_back({q[0], q[1], q[3]}), mesh.elements.push_back({q[1], q[2], q[3]});
                    mesh.face.insert(mesh.face.end(), 2, std::uint16_t(mesh.faces.size() - 1));
                }
        }
}

void mesh_rectangle(const Vec3& low, const std::array<int, 3>& n, const std::array<double, 3>& h,
                    SurfaceElements& mesh) {
    mesh.faces = {"x_low", "x_high", "y_low", "y_high"};
    const int around = 2 * (n[0] + n[1]);
    int x = 0, y = 0;
    for (int k = 0; k < around; ++k) {   // counter-clockwise from the lowest corner
        mesh.vertices.push_back(low + Vec3{x * h[0], y * h[1], 0});
        const std::uint32_t a = std::uint32_t(k), b = std::uint32_t((k + 1) % around);
        mesh.elements.push_back({a, b, b});
        mesh.face.push_back(k < n[0] ? 2 : k < n[0] + n[1] ? 1 : k < 2 * n[0] + n[1] ? 3 : 0);
        if (k < n[0])
            ++x;
        else if (k < n[0] + n[1])
            ++y;
        else if (k < 2 * n[0] + n[1])
            --x;
        else
            --y;
    }
}

}   // namespace

SolidFill fill_box(const Vec3& low, const Vec3& high, double spacing, bool planar) {
    const Vec3 size = high - low;
    const std::array<int, 3> n = {parts(size.x, spacing), parts(size.y, spacing), planar ? 1 : parts(size.z, spacing)};
    const std::array<double, 3> h = {size.x / n[0], size.y / n[1], planar ? 0.0 : size.z / n[2]};
    SolidFill fill;
    const Vec3 corner{low.x, low.y, planar ? 0 : low.z};
    for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i)
                fill.places.push_back(corner + Vec3{(i + 0.5) * h[0], (j + 0.5) * h[1], (k + 0.5) * h[2]});
    fill.volumes.assign(fill.places.size(), h[0] * h[1] * (planar ? 1 : h[2]));
    if (planar)
        mesh_rectangle(corner, n, h, fill.surface);
    else
        mesh_box(corner, n, h, fill.surface);
    return fill;
}

SolidFill fill_cylinder(const Vec3& from, const Vec3& to, double inner_radius, double outer_radius, double spacing,
                        bool planar) {
    const Vec3 axis = planar ? Vec3{0, 0, 1} : normalized(to - from);
    const Vec3 other = std::abs(axis.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 e1 = planar ? Vec3{1, 0, 0} : normalized(other - dot(other, axis) * axis), e2 = cross(axis, e1);
    const Vec3 start = planar ? Vec3{from.x, from.y, 0} : from;
    const double length = planar ? 0 : norm(to - from);
    const int rings = parts(outer_radius - inner_radius, spacing), layers = planar ? 1 : parts(length, spacing);
    const double dr = (outer_radius - inner_radius) / rings, dz = length / layers;
    const auto count_at = [&](double r) { return std::max(3, int(std::lround(2 * pi * r / spacing))); };

    SolidFill fill;
    for (int layer = 0; layer < layers; ++layer)
        for (int k = 0; k < rings; ++k) {
            const double a = inner_radius + k * dr, b = a + dr, r = 0.5 * (a + b);
            const int count = count_at(r);
            for (int i = 0; i < count; ++i) {
                const double angle = 2 * pi * (i + 0.5) / count;
                fill.places.push_back(start + (planar ? 0 : (layer + 0.5) * dz) * axis +
                                      r * (std::cos(angle) * e1 + std::sin(angle) * e2));
                fill.volumes.push_back(pi * (b * b - a * a) / count * (planar ? 1 : dz));
            }
        }

    TubeMesh mesh(fill.surface);
    const bool hollow = inner_radius > 0;
    const std::uint16_t inner = hollow ? mesh.face("inner") : 0, outer = mesh.face("outer");
    if (planar) {
        if (hollow)
            mesh.segments(mesh.circle(start, e1, e2, inner_radius, count_at(inner_radius + 0.5 * dr)), inner, true);
        mesh.segments(mesh.circle(start, e1, e2, outer_radius, count_at(outer_radius - 0.5 * dr)), outer, false);
        return fill;
    }
    using Circle = std::vector<std::uint32_t>;
    const auto circle_at = [&](double r, int layer) {
        return mesh.circle(start + layer * dz * axis, e1, e2, r, count_at(std::max(r, 0.5 * dr)));
    };
    std::array<Circle, 2> first, last;   // at inner and outer radius
    for (int side = hollow ? 0 : 1; side < 2; ++side) {
        const double r = side == 0 ? inner_radius : outer_radius;
        Circle below = circle_at(r, 0);
        first[std::size_t(side)] = below;
        for (int layer = 1; layer <= layers; ++layer) {
            Circle above = circle_at(r, layer);
            mesh.stitch(below, above, side == 0 ? inner : outer, side == 0);
            below = std::move(above);
        }
        last[std::size_t(side)] = below;
    }
    for (const bool is_end : {false, true}) {
        const std::uint16_t cap = mesh.face(is_end ? "to" : "from");
        const auto& rim = is_end ? last : first;
        Circle within = hollow ? rim[0] : circle_at(0, is_end ? layers : 0);
        for (int k = 1; k <= rings; ++k) {
            Circle around = k == rings ? rim[1] : circle_at(inner_radius + k * dr, is_end ? layers : 0);
            mesh.stitch(within, around, cap, is_end);
            within = std::move(around);
        }
    }
    return fill;
}

SolidFill fill_sphere(const Vec3& centre, double radius, double spacing) {
    SolidFill fill;
    const auto ball = [=](const Vec3& x) {
        const Vec3 d = x - centre;
        const double r = norm(d);
        return DistanceSample{r - radius, r > 0 ? d / r : Vec3{1, 0, 0}, 2 / radius};
    };
    const Vec3 corner = 1.2 * radius * Vec3{1, 1, 1};
    StentParticles particles;
    make_stent_particles(SignedDistance{ball, {centre - corner, centre + corner}},
                         4 * pi / 3 * radius * radius * radius, spacing, particles);
    fill.places.assign(particles.position.begin(), particles.position.end());
    fill.volumes.assign(particles.volume.begin(), particles.volume.end());
    // Circles of latitude, a spacing apart, stitched.
    TubeMesh mesh(fill.surface);
    const std::uint16_t outer = mesh.face("outer");
    const int bands = std::max(4, parts(pi * radius, spacing));
    std::vector<std::uint32_t> below = mesh.circle(centre - radius * Vec3{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0, 1);
    for (int k = 1; k <= bands; ++k) {
        const double polar = pi * k / bands, r = k == bands ? 0 : radius * std::sin(polar);
        auto above = mesh.circle(centre - radius * std::cos(polar) * Vec3{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, r,
                                 std::max(6, parts(2 * pi * r, spacing)));
        mesh.stitch(below, above, outer, false);
        below = std::move(above);
    }
    return fill;
}

SolidFill cut_to_box(const SolidFill& fill, const Vec3& low, const Vec3& high) {
    const auto holds = [&](const Vec3& x) {
        return x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y && x.z >= low.z && x.z <= high.z;
    };
    SolidFill cut;
    for (std::size_t i = 0; i < fill.places.size(); ++i)
        if (holds(fill.places[i])) cut.places.push_back(fill.places[i]), cut.volumes.push_back(fill.volumes[i]);
    const SurfaceElements& from = fill.surface;
    cut.surface.faces = from.faces;
    constexpr std::uint32_t unused = -1;
    std::vector<std::uint32_t> number(from.vertices.size(), unused);
    for (std::size_t e = 0; e < from.elements.size(); ++e) {
        auto element = from.elements[e];
        if (!std::all_of(element.begin(), element.end(), [&](std::uint32_t v) { return holds(from.vertices[v]); }))
            continue;
        for (std::uint32_t& v : element) {
            if (number[v] == unused)
                number[v] = std::uint32_t(cut.surface.vertices.size()),
                cut.surface.vertices.push_back(from.vertices[v]);
            v = number[v];
        }
        cut.surface.elements.push_back(element);
        cut.surface.face.push_back(from.face[e]);
    }
    return cut;
}

}   // namespace patency
