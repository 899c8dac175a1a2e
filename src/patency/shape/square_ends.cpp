// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/square_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "patency/base/errors.h"
#include "patency/base/units.h"
#include "patency/shape/surface_cut.h"

namespace patency {

namespace {

// The axis near an end is where the sections behind it have their centres. The line itself will not do: its last part is
// bent so that it ends along the opening's normal. A fit over two radii follows a bend and does not see single bumps.
constexpr double fitted_radii = 2;
constexpr int fitted_sections = 5;
constexpr double least_radii = 0.75;   // below, what the sections' centres are off turns the fit by degrees
constexpr double inside_share =
    0.02;   // of the radius: the first section lies so far behind the plane, never in a cap's

// Corners nearer to a cut than this share of the radius move onto it, so that no slivers arise: a tenth of a usual edge.
constexpr double snap_share = 0.02;

bool is_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

bool holds_point(const std::vector<Vec3>& sorted, const Vec3& x) {
    return std::binary_search(sorted.begin(), sorted.end(), x, is_before);
}

/// Of the section's area.
Vec3 centre_of(const CrossSection& section) {
    Vec3 sum{};
    double area = 0;
    for (std::size_t k = 0; k < section.outline.size(); ++k) {
        const Vec3 a = section.outline[k] - section.place,
                   b = section.outline[(k + 1) % section.outline.size()] - section.place;
        const double twice = dot(cross(a, b), section.normal);
        area += twice, sum += (twice / 3) * (a + b);
    }
    return section.place + sum / area;
}

/// The direction at the first of the places of the parabola through them, each known by how far it lies along `axis`.
Vec3 direction_at_first(const std::vector<Vec3>& places, const Vec3& from, const Vec3& axis, double length) {
    Mat3 normal{};
    Mat3 right{};   // rows: moments of the places
    for (const Vec3& place : places) {
        const double t = dot(place - from, axis) / length;
        const Vec3 basis{1, t, t * t};
        normal += outer(basis, basis);
        right += outer(basis, place - from);
    }
    return normalized((inverse(normal) * right).y);
}

double height_of_lowest(const std::vector<Vec3>& points, const SquareCut& cut) {
    double lowest = Bounds::infinity;
    for (const Vec3& x : points) lowest = std::min(lowest, dot(x - cut.point, cut.normal));
    return lowest;
}

/// The cut sees the end and what hangs together with it past the plane, and the corners next to that.
struct Seen {
    std::vector<char> past, around;
};
Seen find_seen(const Surface& surface, const std::vector<Vec3>& rim, const SquareCut& cut) {
    std::vector<char> is_past(surface.points.size());
    for (std::size_t k = 0; k < is_past.size(); ++k)
        is_past[k] = dot(surface.points[k] - cut.point, cut.normal) > 0 || holds_point(rim, surface.points[k]);
    Groups groups(surface.points.size());
    for (const Triangle& t : surface.triangles)
        for (int side = 0; side < 3; ++side)
            if (is_past[t[side]] && is_past[t[(side + 1) % 3]]) groups.join(t[side], t[(side + 1) % 3]);
    std::vector<char> is_seen(surface.points.size());   // by group
    for (std::uint32_t k = 0; k < is_past.size(); ++k)
        if (holds_point(rim, surface.points[k])) is_seen[groups.group_of(k)] = 1;
    Seen seen{std::vector<char>(surface.points.size()), std::vector<char>(surface.points.size())};
    for (std::uint32_t k = 0; k < is_past.size(); ++k) seen.past[k] = is_past[k] && is_seen[groups.group_of(k)];
    for (const Triangle& t : surface.triangles)
        if (seen.past[t[0]] || seen.past[t[1]] || seen.past[t[2]])
            for (const std::uint32_t point : t) seen.around[point] = 1;
    return seen;
}

}   // namespace

CentrelinePoint AxisEnd::at(double depth) const {
    CentrelinePoint p = point_at(*line, is_start ? depth : line->length() - depth);
    if (is_start) p.tangent = -p.tangent;
    return p;
}

std::vector<AxisEnd> find_ends(const CheckedSurface& checked, std::span<const SurfaceOpening> openings,
                               const BranchedLines& lines) {
    std::vector<AxisEnd> ends;
    for (std::size_t k = 0; k < openings.size(); ++k) {
        const Opening& o = openings[k].opening;
        const Centreline& line = lines.lines.at(k == 0 ? 0 : k - 1);
        AxisEnd end{o.name, o.normal, o.radius, {}, &line, k == 0, line.length()};
        for (const Branch& b : lines.branches) {
            if (k == 0 && b.parent < 0 && lines.branches.size() > 1) end.room = lines.end_arc(b);
            if (k > 0 && b.parent >= 0 && b.lines.size() == 1 && b.lines[0] == k - 1)
                end.room = std::min(end.room, line.length() - lines.start_arc(b));
        }
        for (const std::uint32_t t : openings[k].triangles)
            for (const std::uint32_t point : checked.surface.triangles[t])
                end.rim.push_back(checked.surface.points[point]);
        if (end.rim.empty()) {   // open: the loop that it was made of
            const auto away = [&](const FlatLoop& loop) { return norm(loop.centre - o.centre); };
            const auto loop = std::min_element(checked.ends.begin(), checked.ends.end(),
                                               [&](const auto& a, const auto& b) { return away(a) < away(b); });
            if (loop != checked.ends.end())
                for (const std::uint32_t point : loop->rim) end.rim.push_back(checked.surface.points[point]);
        }
        std::sort(end.rim.begin(), end.rim.end(), is_before);
        ends.push_back(std::move(end));
    }
    return ends;
}

std::optional<SquareCut> square_cut_at(const SectionCutter& cutter, const AxisEnd& end, double depth) {
    const double radius = end.at(std::min(depth + end.radius, end.room)).radius;
    const double length = std::min(fitted_radii * radius, end.room - depth);
    if (length < least_radii * radius) return {};
    const Vec3 point = end.at(depth).place;
    Vec3 axis = normalized(point - end.at(depth + length).place);
    constexpr int rounds = 20;
    constexpr double same = 1e-4;   // rad
    for (int round = 0; round < rounds; ++round) {
        std::vector<Vec3> centres;
        for (int k = 0; k < fitted_sections; ++k) {
            const double behind = inside_share * radius + k * (length - inside_share * radius) / (fitted_sections - 1);
            const CrossSection section = cutter.cut(end.at(depth + behind).place, axis);
            if (!section.is_closed || !section.holds_place || !(section.area > 0)) return {};
            centres.push_back(centre_of(section));
        }
        const Vec3 next = direction_at_first(centres, point, axis, length);
        if (!(dot(next, axis) > 0)) return {};
        const double turned = norm(next - axis);
        axis = next;
        if (turned < same) return SquareCut{depth, point, axis};
    }
    return {};
}

std::optional<SquareCut> least_square_cut(const SectionCutter& cutter, const AxisEnd& end) {
    if (end.rim.empty()) return {};
    const auto try_at = [&](double depth) {
        std::optional<SquareCut> cut = square_cut_at(cutter, end, depth);
        // What rounding leaves of a flat rim is no part of the vessel.
        if (cut && height_of_lowest(end.rim, *cut) < -1e-6 * end.radius) cut.reset();
        return cut;
    };
    if (const auto own = try_at(0)) return own;
    const Vec3 centre = end.at(0).place;
    double reach = 0;
    for (const Vec3& x : end.rim) reach = std::max(reach, norm(x - centre));
    const double step = 0.05 * reach;   // past two reaches no plane meets the rim, unless the vessel turns back
    for (double depth = step; depth < std::min(end.room, 2 * reach); depth += step) {
        std::optional<SquareCut> best = try_at(depth);
        if (!best) continue;
        double low = depth - step, high = depth;
        while (high - low > 1e-3 * step) {
            const double middle = 0.5 * (low + high);
            if (const auto cut = try_at(middle))
                high = middle, best = cut;
            else
                low = middle;
        }
        return best;
    }
    return {};
}

double off_square(const AxisEnd& end, const SquareCut& least) {
    return std::atan2(norm(cross(end.normal, least.normal)), dot(end.normal, least.normal));
}

Finding cut_end(Surface& surface, std::span<const AxisEnd> ends, std::size_t which, const SquareCut& cut) {
    const AxisEnd& end = ends[which];
    const double mm = 1e3 * cut.depth;
    if (height_of_lowest(end.rim, cut) < -1e-6 * end.radius)
        throw GeometryError(fmt::format("a cut {:.3g} mm before {} does not take its whole rim", mm, end.name));
    const Seen seen = find_seen(surface, end.rim, cut);
    for (const AxisEnd& other : ends)
        if (&other != &end)
            for (std::size_t k = 0; k < seen.past.size(); ++k)
                if (seen.past[k] && holds_point(other.rim, surface.points[k]))
                    throw GeometryError(fmt::format("a cut {:.3g} mm before {} would take {} away too; cut less of it",
                                                    mm, end.name, other.name));
    std::vector<std::uint32_t> gone;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        if (seen.past[surface.triangles[t][0]] || seen.past[surface.triangles[t][1]] ||
            seen.past[surface.triangles[t][2]])
            gone.push_back(t);
    Surface shown = part_of(surface, gone), kept = surface;
    if (cut_flat(kept, {.point = cut.point, .normal = cut.normal, .points = seen.around}, snap_share * end.radius) != 1)
        throw GeometryError(
            fmt::format("a plane across the vessel {:.3g} mm before {} cuts it in more than one ring; cut it elsewhere",
                        mm, end.name));
    surface = std::move(kept);
    const double size = diagonal(bounds(shown));
    return {"cut_back",
            Verdict::repaired,
            1,
            cut.point,
            size,
            fmt::format("{} was cut off square to the centreline {:.3g} mm before its end, which was {:.0f} degrees "
                        "off; geometry.cut_back asks for it.",
                        end.name, mm, in_unit(off_square(end, cut), "deg")),
            std::move(shown)};
}

}   // namespace patency
