// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "patency/base/errors.h"
#include "patency/shape/surface_repair.h"
#include "patency/shape/triangle_pairs.h"

namespace patency {

namespace {

// What an open end is. A star of triangles that is missing leaves six edges, a few neighbours more leave eight but lie in
// the wall; an end cut by hand is off its plane by a few percent and its rim zigzags by half an edge.
constexpr std::size_t fewest_edges = 8;
constexpr double largest_flatness = 0.1;     // of the diameter
constexpr double smallest_roundness = 0.5;   // a zigzag of 45 degrees halves a circle's
constexpr double largest_wall_slope = 0.7;   // mean of wall normal * end normal: 0 for a tube, 1 for a hole

constexpr std::size_t most_pairs = 10000;   // enough to show what is wrong
constexpr int fold_rings = 3;               // triangles so near along the surface crumple; farther ones are other parts

std::string place_text(const Vec3& x) {
    return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", 1e3 * x.x, 1e3 * x.y, 1e3 * x.z);
}

void append(std::vector<Finding>& all, std::vector<Finding> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// The lines with the points they use.
void show_lines(const Surface& surface, const std::vector<std::vector<std::uint32_t>>& lines, Finding& finding) {
    for (const auto& line : lines) {
        auto& shown = finding.lines.emplace_back();
        for (std::uint32_t point : line) {
            shown.push_back(std::uint32_t(finding.shown.points.size()));
            finding.shown.points.push_back(surface.points[point]);
        }
    }
    finding.shown.space = surface.space;
}

std::vector<Finding> find_crowded_edges(const Surface& surface, const std::vector<EdgeUse>& uses) {
    std::vector<std::vector<std::uint32_t>> lines;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() > 2) lines.push_back({edge[0].low, edge[0].high});
    });
    if (lines.empty()) return {};
    const Vec3 &a = surface.points[lines[0][0]], &b = surface.points[lines[0][1]];
    Finding finding{"non_manifold_edges", Verdict::refused, lines.size(), 0.5 * (a + b), norm(b - a), ""};
    finding.sentence = fmt::format(
        "{} edges belong to more than two triangles, the first at {}. Remove the inner walls or flaps there.",
        lines.size(), place_text(finding.place));
    show_lines(surface, lines, finding);
    return {finding};
}

/// Sorts the loops into ends and holes.
std::vector<Finding> find_holes(CheckedSurface& checked, const std::vector<EdgeUse>& boundary) {
    const Surface& surface = checked.surface;
    std::vector<std::vector<std::uint32_t>> rims;
    Finding finding{"holes", Verdict::refused, 0, {}, -1, ""};
    std::string reason;
    for (FlatLoop& loop : find_loops(surface, boundary)) {
        std::string why = why_not_an_end(surface, loop, boundary);
        if (why.empty()) {
            checked.ends.push_back(std::move(loop));
            continue;
        }
        rims.push_back(loop.rim);
        rims.back().push_back(loop.rim[0]);   // as a closed line
        if (2 * loop.reach > finding.size)
            finding.size = 2 * loop.reach, finding.place = loop.centre, reason = std::move(why);
    }
    std::stable_sort(checked.ends.begin(), checked.ends.end(),
                     [](const auto& a, const auto& b) { return a.area > b.area; });
    if (rims.empty()) return {};
    finding.count = rims.size();
    finding.sentence = fmt::format(
        "{} holes that are no open ends; the largest, {:.3g} mm wide at {}, {}. Close them, or cut the ends flat.",
        rims.size(), 1e3 * finding.size, place_text(finding.place), reason);
    show_lines(surface, rims, finding);
    return {finding};
}

/// The triangles around each point.
std::vector<std::vector<std::uint32_t>> triangles_of_points(const Surface& surface) {
    std::vector<std::vector<std::uint32_t>> around(surface.points.size());
    for (std::uint32_t k = 0; k < surface.triangles.size(); ++k)
        for (std::uint32_t point : surface.triangles[k]) around[point].push_back(k);
    return around;
}

bool are_near_along_surface(const Surface& surface, const std::vector<std::vector<std::uint32_t>>& around,
                            const TrianglePair& pair) {
    std::set<std::uint32_t> seen{pair.a};
    std::vector<std::uint32_t> ring{pair.a};
    for (int step = 0; step < fold_rings; ++step) {
        std::vector<std::uint32_t> next;
        for (std::uint32_t triangle : ring)
            for (std::uint32_t point : surface.triangles[triangle])
                for (std::uint32_t other : around[point])
                    if (seen.insert(other).second) next.push_back(other);
        if (seen.contains(pair.b)) return true;
        ring = std::move(next);
    }
    return false;
}

std::vector<Finding> find_crossings(const Surface& surface) {
    const std::vector<TrianglePair> pairs = find_crossing_triangles(surface, most_pairs);
    if (pairs.empty()) return {};
    const auto around = triangles_of_points(surface);
    struct Kind {
        std::size_t pairs = 0;
        Vec3 place{};
        std::set<std::uint32_t> triangles{};
    } folds, crossings;
    for (const TrianglePair& pair : pairs) {
        Kind& kind = are_near_along_surface(surface, around, pair) ? folds : crossings;
        if (kind.pairs++ == 0) kind.place = pair.place;
        kind.triangles.insert({pair.a, pair.b});
    }
    std::vector<Finding> findings;
    const auto report = [&](const Kind& kind, const char* name, Verdict verdict, const char* what) {
        if (kind.pairs == 0) return;
        const std::vector<std::uint32_t> triangles(kind.triangles.begin(), kind.triangles.end());
        Surface shown = part_of(surface, triangles);
        const double size = diagonal(bounds(shown));
        findings.push_back(
            {name, verdict, kind.pairs, kind.place, size,
             fmt::format("{}{} pairs of triangles {}, the first at {}.", pairs.size() == most_pairs ? "at least " : "",
                         kind.pairs, what, place_text(kind.place)),
             std::move(shown)});
    };
    report(folds, "folds", Verdict::harmless, "beside each other are crumpled into each other");
    report(crossings, "crossings", Verdict::refused,
           "of different parts of the surface pass through or lie on each other (separate them there)");
    return findings;
}

}   // namespace

std::string why_not_an_end(const Surface& surface, const FlatLoop& loop, const std::vector<EdgeUse>& boundary) {
    if (loop.rim.size() < fewest_edges) return fmt::format("has only {} edges", loop.rim.size());
    std::vector<std::uint32_t> rim = loop.rim;
    std::sort(rim.begin(), rim.end());
    const auto is_on_rim = [&](std::uint32_t point) { return std::binary_search(rim.begin(), rim.end(), point); };
    double slope = 0, length = 0;
    for (const EdgeUse& use : boundary) {
        if (!is_on_rim(use.low) || !is_on_rim(use.high)) continue;
        const double edge = norm(surface.points[use.high] - surface.points[use.low]);
        slope += edge * dot(normalized(area_vector(surface, surface.triangles[use.triangle])), loop.normal);
        length += edge;
    }
    if (slope > largest_wall_slope * length) return "lies within the wall";
    if (loop.roundness() < smallest_roundness)
        return fmt::format("is long and thin (roundness {:.2f})", loop.roundness());
    if (loop.flatness > largest_flatness * loop.diameter())
        return fmt::format("is not flat ({:.2g} mm off its plane)", 1e3 * loop.flatness);
    return {};
}

std::string refusals(const std::vector<Finding>& findings) {
    std::string text;
    for (const Finding& finding : findings)
        if (finding.verdict == Verdict::refused)
            text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", finding.kind, finding.sentence);
    return text;
}

CheckedSurface check_surface(Surface surface) {
    CheckedSurface checked{.surface = std::move(surface)};
    Surface& s = checked.surface;
    const double tolerance = same_place_tolerance(s);
    append(checked.findings, repair_equal_points(s, tolerance));
    append(checked.findings, repair_flat_triangles(s, tolerance));
    append(checked.findings, repair_duplicates(s));
    if (s.triangles.empty()) throw GeometryError("the surface has no triangle with an area. Export it again.");
    append(checked.findings, repair_components(s));
    append(checked.findings, repair_orientation(s));

    const std::vector<EdgeUse> uses = edge_uses(s), boundary = boundary_edges(uses);
    append(checked.findings, find_crowded_edges(s, uses));
    append(checked.findings, find_holes(checked, boundary));
    append(checked.findings, find_crossings(s));
    checked.volume = closed_volume(s, find_loops(s, boundary));
    return checked;
}

}   // namespace patency
