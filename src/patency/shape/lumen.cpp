// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/lumen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "patency/base/errors.h"
#include "patency/shape/measure.h"

namespace patency {

namespace {

constexpr double pi = std::numbers::pi;

Opening round_opening(std::string name, const Vec3& centre, const Vec3& normal, double radius) {
    return {std::move(name), centre, normal, pi * radius * radius, radius, radius, false, radius * radius / 2};
}

void expect_positive(const char* what, double value) {
    if (!(value > 0) || !std::isfinite(value))
        throw GeometryError(fmt::format("The {} is {} m: it must be positive and finite.", what, value));
}

double component(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
Vec3 along(int axis, double value) {
    return {axis == 0 ? value : 0.0, axis == 1 ? value : 0.0, axis == 2 ? value : 0.0};
}

}   // namespace

OpeningCoordinates opening_coordinates(const Opening& opening, const Vec3& x) {
    const Vec3 from_centre = x - opening.centre;
    const double s = dot(from_centre, opening.normal);
    return {s, from_centre - s * opening.normal};
}

int opening_beyond(const Lumen& lumen, const Vec3& x, double margin) {
    for (std::size_t k = 0; k < lumen.openings.size(); ++k) {
        const Opening& opening = lumen.openings[k];
        const auto [s, radial] = opening_coordinates(opening, x);
        // Behind `extension` the distance may end in a round cap.
        if (s > 0 && s < lumen.extension + 2 * opening.reach + margin &&
            norm(radial) <= (1 + 1e-9) * opening.reach + margin)
            return int(k);
    }
    return -1;
}

bool contains(const Lumen& lumen, const Vec3& x) { return lumen.distance.value(x) < 0 && opening_beyond(lumen, x) < 0; }

Lumen moved(Lumen lumen, const RigidMotion& motion) {
    const auto differs = [](const Vec3& a, const Vec3& b) { return norm(a - b) > 1e-14; };
    if (lumen.planar && (differs(motion.rotation.z, {0, 0, 1}) || motion.origin.z != 0))
        throw GeometryError("A planar lumen lies in z = 0: turn it about the z axis only.");
    if (dot(lumen.period, lumen.period) > 0 &&
        (differs(motion.rotation.x, {1, 0, 0}) || differs(motion.rotation.y, {0, 1, 0})))
        throw GeometryError("A periodic lumen cannot be turned: its period follows the axes.");
    lumen.distance = moved(std::move(lumen.distance), motion);
    if (lumen.exact) lumen.exact = moved(std::move(*lumen.exact), motion);
    lumen.bounds = moved(lumen.bounds, motion);
    lumen.frame = motion.after(lumen.frame);
    for (Opening& opening : lumen.openings) {
        opening.centre = motion.place(opening.centre);
        opening.normal = motion.turn(opening.normal);
    }
    return lumen;
}

Lumen make_box(const BoxShape& shape) {
    const int axes = shape.planar ? 2 : 3;
    std::array<bool, 3> walled{};
    Vec3 size = shape.size, period{};
    if (shape.planar) size.z = 0;
    double volume = 1;
    for (int k = 0; k < axes; ++k) {
        expect_positive("size of the box", component(size, k));
        volume *= component(size, k);
        walled[k] = shape.sides[k] == Side::wall;
        if (shape.sides[k] == Side::periodic) period += along(k, component(size, k));
    }
    Lumen lumen{.distance = box_between({}, size, walled),
                .openings = {},
                .volume = volume,
                .wall_area = 0,
                .planar = shape.planar,
                .bounds = {{}, size},
                .period = period,
                .fit = size};
    const char* names[3][2] = {{"inlet", "outlet"}, {"y_low", "y_high"}, {"z_low", "z_high"}};
    for (int k = 0; k < axes; ++k) {
        const double area = volume / component(size, k);
        if (walled[k]) lumen.wall_area += 2 * area;
        if (shape.sides[k] != Side::open) continue;
        const double reach = 0.5 * norm(size - along(k, component(size, k)));
        for (int high = 0; high < 2; ++high) {
            const Vec3 centre = 0.5 * size + along(k, (high ? 0.5 : -0.5) * component(size, k));
            lumen.openings.push_back({names[k][high], centre, along(k, high ? 1 : -1), area,
                                      shape.planar ? 0.5 * area : std::sqrt(area / pi), reach, shape.planar,
                                      reach * reach / 3});   // of a rectangle, and of a line
        }
    }
    return lumen;
}

Lumen make_channel(const ChannelShape& shape) {
    return make_box(
        {.size = {shape.length, shape.gap, 0}, .sides = {shape.ends, Side::wall, Side::wall}, .planar = true});
}

Lumen make_step(const StepShape& shape) {
    expect_positive("length of the channel behind the step", shape.length - shape.at);
    expect_positive("length of the channel ahead of the step", shape.at);
    expect_positive("height of the step", shape.height);
    expect_positive("gap over the step", shape.gap - shape.height);
    const auto opening = [](std::string name, double x, double low, double high, double out) {
        const double half = 0.5 * (high - low);
        return Opening{std::move(name), {x, low + half, 0}, {out, 0, 0}, 2 * half, half, half, true, half * half / 3};
    };
    return {.distance = stepped_gap(shape.gap, shape.height, shape.at),
            .openings = {opening("inlet", 0, shape.height, shape.gap, -1),
                         opening("outlet", shape.length, 0, shape.gap, 1)},
            .volume = shape.length * shape.gap - shape.at * shape.height,
            .wall_area = 2 * shape.length + shape.height,
            .planar = true,
            .bounds = {{}, {shape.length, shape.gap, 0}},
            .fit = {shape.length, 0, 0}};
}

Lumen make_tube(const TubeShape& shape) {
    expect_positive("length of the tube", shape.length);
    expect_positive("radius of the tube", shape.radius);
    Lumen lumen = make_nozzle({{{0, shape.radius}, {shape.length, shape.radius}}});
    lumen.distance = round_tube(shape.radius);   // one piece instead of three
    if (shape.ends == Side::wall) throw GeometryError("A tube's ends are open or periodic.");
    if (shape.ends == Side::periodic) {
        lumen.openings.clear();
        lumen.period.x = shape.length;
    }
    return lumen;
}

Lumen make_cone(const ConeShape& shape) {
    expect_positive("length of the cone", shape.length);
    return make_nozzle({{{0, shape.inlet_radius}, {shape.length, shape.outlet_radius}}});
}

Lumen make_nozzle(const NozzleShape& shape) {
    const std::vector<AxialRadius>& outline = shape.outline;
    SignedDistance distance = body_of_revolution(outline, TubeEnds::open);   // checks the outline's order
    double volume = 0, area = 0, largest = 0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        expect_positive("radius of the tube", outline[k].radius);
        largest = std::max(largest, outline[k].radius);
        if (k == 0) continue;
        const double r = outline[k - 1].radius, q = outline[k].radius, da = outline[k].axial - outline[k - 1].axial;
        volume += pi / 3 * da * (r * r + r * q + q * q);   // a frustum; a step has da = 0
        area += pi * (r + q) * std::hypot(da, q - r);
    }
    const AxialRadius first = outline.front(), last = outline.back();
    const double length = last.axial - first.axial;
    expect_positive("length of the tube", length);
    const Vec3 start{first.axial, 0, 0}, end{last.axial, 0, 0};
    return {.distance = std::move(distance),
            .openings = {round_opening("inlet", start, {-1, 0, 0}, first.radius),
                         round_opening("outlet", end, {1, 0, 0}, last.radius)},
            .volume = volume,
            .wall_area = area,
            .bounds = {{first.axial, -largest, -largest}, {last.axial, largest, largest}},
            .frame = {identity<double>(), start},
            .fit = {length, 0, 0}};
}

Lumen make_branches(const BranchesShape& shape) {
    expect_positive("extension of the branches", shape.extension);
    std::vector<RoundCone> pieces;   // of the lumen, then its straight continuations
    std::vector<RoundCone> extensions;
    std::vector<std::size_t> first_piece, owner;   // per branch; per opening
    std::vector<Opening> openings;
    double smallest = Bounds::infinity;
    for (std::size_t k = 0; k < shape.branches.size(); ++k) {
        const BranchShape& b = shape.branches[k];
        if (b.points.size() < 2 || b.points.size() != b.radii.size())
            throw GeometryError(
                fmt::format("Branch {} has {} points and {} radii: it needs two or more of each, as "
                            "many radii as points.",
                            k + 1, b.points.size(), b.radii.size()));
        first_piece.push_back(pieces.size());
        for (std::size_t p = 0; p < b.points.size(); ++p) {
            expect_positive("radius of a branch", b.radii[p]);
            smallest = std::min(smallest, b.radii[p]);
            if (p > 0) pieces.push_back({b.points[p - 1], b.points[p], b.radii[p - 1], b.radii[p]});
        }
        const auto open = [&](const std::string& name, std::size_t at, std::size_t before) {
            if (name.empty()) return;
            const Vec3 step = b.points[at] - b.points[before];
            const double length = norm(step), narrowing = (b.radii[before] - b.radii[at]) / length;
            if (!(length > 0) || std::abs(narrowing) >= 1)
                throw GeometryError(
                    fmt::format("Branch {} ends at opening '{}' with a piece too short for its taper: "
                                "move the point before it away.",
                                k + 1, name));
            // The wall is tangent to the spheres: where it narrows, the plane through the last centre cuts it at
            // r / cos; the continuation takes that radius, so that the wall goes on without a step.
            const double radius = narrowing > 0 ? b.radii[at] / std::sqrt(1 - narrowing * narrowing) : b.radii[at];
            const Vec3 normal = step / length, centre = b.points[at];
            openings.push_back(round_opening(name, centre, normal, radius));
            extensions.push_back({centre, centre + shape.extension * normal, radius, radius});
            owner.push_back(k);
        };
        open(b.start, 0, 1);
        open(b.end, b.points.size() - 1, b.points.size() - 2);
    }
    first_piece.push_back(pieces.size());
    if (pieces.empty()) throw GeometryError("A vessel network needs at least one branch.");

    for (std::size_t k = 0; k < openings.size(); ++k) {
        std::vector<RoundCone> others;
        for (std::size_t b = 0; b + 1 < first_piece.size(); ++b)
            if (b != owner[k])
                others.insert(others.end(), pieces.begin() + std::ptrdiff_t(first_piece[b]),
                              pieces.begin() + std::ptrdiff_t(first_piece[b + 1]));
        for (std::size_t j = 0; j < openings.size(); ++j)
            if (j != k) others.push_back(extensions[j]);
        if (others.empty()) continue;
        const SignedDistance rest = union_of_round_cones(others);
        const double radius = openings[k].radius;
        for (double s = 0; s <= shape.extension; s += 0.25 * radius)
            if (rest.value(openings[k].centre + s * openings[k].normal) < radius)
                throw GeometryError(
                    fmt::format("Opening '{}' runs into another branch {:.3g} m past its plane: move "
                                "the opening or shorten the extension of {:.3g} m.",
                                openings[k].name, s, shape.extension));
    }

    const Bounds bounds = union_of_round_cones(pieces).bounds();
    pieces.insert(pieces.end(), extensions.begin(), extensions.end());
    Lumen lumen{.distance = union_of_round_cones(pieces),
                .openings = std::move(openings),
                .volume = 0,
                .wall_area = 0,
                .extension = shape.extension,
                .bounds = bounds};
    const Measures measures = measure(lumen, smallest / 24);
    lumen.volume = measures.volume;
    lumen.wall_area = measures.wall_area;
    return lumen;
}

}   // namespace patency
