// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "patency/shape/flat_loop.h"

namespace patency {

namespace {

constexpr double dust_share = 0.01;   // of the area: what a segmentation leaves beside the vessel, never a branch
constexpr double relative_tolerance =
    1e-6;   // of the diagonal: 0.1 um in a coronary tree; a float there is good to 0.01 um

using Chosen = std::vector<std::uint32_t>;   // indices of triangles

void keep_only(Surface& surface, const std::vector<char>& keep) {
    Chosen kept;
    for (std::uint32_t t = 0; t < keep.size(); ++t)
        if (keep[t]) kept.push_back(t);
    surface = part_of(surface, kept);
}

void turn_over(Triangle& t) { std::swap(t[1], t[2]); }

/// A finding about some triangles of the surface as it is now; the sentence begins with their number.
Finding about(const Surface& surface, const Chosen& triangles, std::string kind, Verdict verdict,
              std::string_view rest) {
    Finding finding{std::move(kind),
                    verdict,
                    triangles.size(),
                    {},
                    -1,
                    fmt::format("{} {}", triangles.size(), rest),
                    part_of(surface, triangles)};
    for (const Triangle& t : finding.shown.triangles) {
        const auto& p = finding.shown.points;
        const double side = std::max({norm(p[t[1]] - p[t[0]]), norm(p[t[2]] - p[t[1]]), norm(p[t[0]] - p[t[2]])});
        if (side > finding.size) finding.size = side, finding.place = centroid(finding.shown, t);
    }
    return finding;
}

/// The side (0, 1, 2) that begins at t[side], or -1 if the triangle is higher over it than the tolerance.
int longest_side_if_flat(const Surface& surface, const Triangle& t, double tolerance) {
    const auto& p = surface.points;
    const auto length = [&](int side) { return norm(p[t[(side + 1) % 3]] - p[t[side]]); };
    int longest = 0;
    for (int side : {1, 2})
        if (length(side) > length(longest)) longest = side;
    return 2 * norm(area_vector(surface, t)) <= tolerance * length(longest) ? longest : -1;
}

/// One pass: flat triangles go, and those across their longest sides are split. Returns the flat ones.
Chosen remove_flat(Surface& surface, double tolerance) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>
        beside;   // of the flat ones' sides only
    Chosen flat;
    std::vector<int> side(surface.triangles.size());
    for (std::uint32_t k = 0; k < surface.triangles.size(); ++k) {
        const Triangle& t = surface.triangles[k];
        side[k] = longest_side_if_flat(surface, t, tolerance);
        if (side[k] < 0) continue;
        flat.push_back(k);
        beside[std::minmax({t[side[k]], t[(side[k] + 1) % 3]})];
    }
    if (flat.empty()) return flat;
    std::vector<char> keep(surface.triangles.size(), 1);
    for (std::uint32_t k = 0; k < surface.triangles.size(); ++k)
        for (int s = 0; s < 3; ++s) {
            const Triangle& t = surface.triangles[k];
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;   // it goes, and its sides with it
            const auto found = beside.find(std::minmax({t[s], t[(s + 1) % 3]}));
            if (found != beside.end()) found->second.push_back(k);
        }
    std::vector<char> is_changed(surface.triangles.size());
    for (std::uint32_t k : flat) {
        if (is_changed[k]) continue;   // the next pass looks at what became of it
        const Triangle t = surface.triangles[k];
        const std::uint32_t a = t[side[k]], c = t[(side[k] + 1) % 3], b = t[(side[k] + 2) % 3];
        const auto& both = beside.at(std::minmax({a, c}));
        const bool splits = a != b && b != c && c != a && both.size() == 2;
        const std::uint32_t other = !splits ? k : both[0] == k ? both[1] : both[0];
        if (splits && (is_changed[other] || !keep[other])) continue;   // the next pass knows its new neighbour
        keep[k] = 0;
        if (!splits) continue;
        Triangle& split = surface.triangles[other];
        Triangle second = split;
        std::replace(split.begin(), split.end(), a, b);
        std::replace(second.begin(), second.end(), c, b);
        surface.triangles.push_back(second);
        if (!surface.face_ids.empty()) surface.face_ids.push_back(surface.face_ids[other]);
        keep.push_back(1);
        is_changed[other] = 1;
    }
    keep_only(surface, keep);
    return flat;
}

/// Whether the triangle runs through its points in rising order (after turning the smallest to the front).
bool runs_up(const Triangle& t) { return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2; }

double area_of(const Surface& surface, const Chosen& triangles) {
    double sum = 0;
    for (std::uint32_t t : triangles) sum += norm(area_vector(surface, surface.triangles[t]));
    return sum;
}

/// The triangles of each piece, joined across edges; the largest area first.
std::vector<Chosen> find_components(const Surface& surface) {
    Groups groups(surface.triangles.size());
    const std::vector<EdgeUse> uses = edge_uses(surface);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        for (const EdgeUse& use : edge) groups.join(edge[0].triangle, use.triangle);
    });
    std::map<std::uint32_t, Chosen> pieces;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) pieces[groups.group_of(t)].push_back(t);
    std::vector<std::pair<double, Chosen>> sorted;
    for (auto& [group, piece] : pieces) sorted.emplace_back(area_of(surface, piece), std::move(piece));
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Chosen> result;
    for (auto& [piece_area, piece] : sorted) result.push_back(std::move(piece));
    return result;
}

/// For each triangle whether it must be turned over to agree with the first of its piece; edges where that fails are
/// counted.
struct Sides {
    std::vector<char> is_turned;
    std::size_t conflicts = 0;
};
Sides find_sides(const Surface& surface) {
    struct Neighbour {
        std::uint32_t triangle;
        bool agrees;
    };
    std::vector<std::vector<Neighbour>> beside(surface.triangles.size());
    const std::vector<EdgeUse> uses = edge_uses(surface);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() != 2) return;   // where more than two meet there is no telling
        const bool agrees = edge[0].rises != edge[1].rises;
        beside[edge[0].triangle].push_back({edge[1].triangle, agrees});
        beside[edge[1].triangle].push_back({edge[0].triangle, agrees});
    });
    Sides sides{std::vector<char>(surface.triangles.size(), -1)};
    for (std::uint32_t seed = 0; seed < surface.triangles.size(); ++seed) {
        if (sides.is_turned[seed] >= 0) continue;
        sides.is_turned[seed] = 0;
        Chosen piece{seed};
        for (std::size_t next = 0; next < piece.size(); ++next)
            for (const Neighbour& neighbour : beside[piece[next]]) {
                const char turned = char(sides.is_turned[piece[next]] ^ char(!neighbour.agrees));
                char& known = sides.is_turned[neighbour.triangle];
                if (known < 0)
                    known = turned, piece.push_back(neighbour.triangle);
                else if (known != turned)
                    ++sides.conflicts;
            }
        Chosen turned;
        std::copy_if(piece.begin(), piece.end(), std::back_inserter(turned),
                     [&](auto t) { return sides.is_turned[t]; });
        if (2 * area_of(surface, turned) > area_of(surface, piece))
            for (std::uint32_t t : piece) sides.is_turned[t] ^= 1;
    }
    sides.conflicts /= 2;   // each is met from both ends
    return sides;
}

}   // namespace

std::string word_of(Verdict verdict) {
    return verdict == Verdict::repaired ? "repaired" : verdict == Verdict::harmless ? "harmless" : "refused";
}

double same_place_tolerance(const Surface& surface) {
    return surface.points.empty() ? 0 : relative_tolerance * diagonal(bounds(surface));
}

std::vector<Finding> repair_equal_points(Surface& surface, double tolerance) {
    const Vec3 place = surface.points.empty() ? Vec3{} : surface.points[0];
    const std::size_t gone = merge_points(surface, tolerance);
    if (gone == 0) return {};
    return {{"equal_points", Verdict::repaired, gone, place, tolerance,
             fmt::format("{} points stood where another one stands, or in no triangle; they were merged or dropped.",
                         gone)}};
}

std::vector<Finding> repair_flat_triangles(Surface& surface, double tolerance) {
    std::vector<Finding> findings;
    constexpr int passes = 8;   // chains of flat triangles side by side take one each; longer ones are refused as holes
    for (int pass = 0; pass < passes; ++pass) {
        const Surface before = surface;
        const Chosen flat = remove_flat(surface, tolerance);
        if (flat.empty()) break;
        if (findings.empty())   // later passes meet what this one put off
            findings.push_back(about(
                before, flat, "zero_area_triangles", Verdict::repaired,
                "triangles without area were dropped; those beside them were split where a slit would have stayed."));
    }
    return findings;
}

std::vector<Finding> repair_duplicates(Surface& surface) {
    std::map<Triangle, Chosen> equal;
    for (std::uint32_t k = 0; k < surface.triangles.size(); ++k) {
        Triangle sorted = surface.triangles[k];
        std::sort(sorted.begin(), sorted.end());
        equal[sorted].push_back(k);
    }
    Chosen twice, back_to_back;
    for (const auto& [points, same] : equal) {
        if (same.size() < 2) continue;
        const bool is_fold =
            same.size() == 2 && runs_up(surface.triangles[same[0]]) != runs_up(surface.triangles[same[1]]);
        if (is_fold) back_to_back.push_back(same[0]);
        twice.insert(twice.end(), same.begin() + 1, same.end());
    }
    if (twice.empty()) return {};
    // A surface given with both its sides is no fold: one side of it stays.
    if (double(back_to_back.size()) < dust_share * double(surface.triangles.size()))
        twice.insert(twice.end(), back_to_back.begin(), back_to_back.end());
    Finding finding =
        about(surface, twice, "duplicate_triangles", Verdict::repaired, "triangles that lay on others were dropped.");
    std::vector<char> keep(surface.triangles.size(), 1);
    for (std::uint32_t t : twice) keep[t] = 0;
    keep_only(surface, keep);
    return {finding};
}

std::vector<Finding> repair_components(Surface& surface) {
    const std::vector<Chosen> pieces = find_components(surface);
    if (pieces.size() < 2) return {};
    const double total = area(surface);
    Chosen rest;
    for (std::size_t k = 1; k < pieces.size(); ++k) rest.insert(rest.end(), pieces[k].begin(), pieces[k].end());
    const double share = area_of(surface, rest) / total;
    const bool is_dust = share < dust_share;
    Finding finding = about(surface, rest, "components", is_dust ? Verdict::repaired : Verdict::refused, "");
    const Surface largest = part_of(surface, pieces[1]);
    finding.count = pieces.size() - 1;
    finding.size = diagonal(bounds(largest));
    finding.place = 0.5 * (bounds(largest).low + bounds(largest).high);
    finding.sentence =
        is_dust
            ? fmt::format("{} loose pieces beside the vessel, {:.2g} % of its area together, were dropped.",
                          finding.count, 100 * share)
            : fmt::format(
                  "{} more pieces beside the largest have {:.3g} % of the area together. Leave one vessel in the file.",
                  finding.count, 100 * share);
    if (is_dust) surface = part_of(surface, pieces[0]);
    return {finding};
}

std::vector<Finding> repair_orientation(Surface& surface) {
    std::vector<Finding> findings;
    const Sides sides = find_sides(surface);
    Chosen turned;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        if (sides.is_turned[t]) turned.push_back(t);
    if (sides.conflicts > 0) {   // the rest goes on, so that all that is wrong is named at once
        findings.push_back(about(surface, turned, "one_sided", Verdict::refused, ""));
        findings.back().count = sides.conflicts;
        findings.back().sentence = fmt::format(
            "beside {} edges the triangles disagree on which side is outward, however they are turned: flaps, or a "
            "one-sided surface. Make it anew from the image or the model.",
            sides.conflicts);
    }
    if (!turned.empty()) {
        findings.push_back(about(surface, turned, "turned_triangles", Verdict::repaired,
                                 "triangles had the other side outward than their neighbours; they were turned over."));
        for (std::uint32_t t : turned) turn_over(surface.triangles[t]);
    }
    const std::vector<FlatLoop> loops = find_loops(surface, boundary_edges(edge_uses(surface)));
    if (closed_volume(surface, loops) < 0) {
        Chosen all(surface.triangles.size());
        std::iota(all.begin(), all.end(), 0u);
        findings.push_back(about(surface, all, "inside_out", Verdict::repaired,
                                 "triangles, the whole surface, had their inner side outward; they were turned over."));
        findings.back().size = diagonal(bounds(surface));
        findings.back().shown = {};   // the cleaned surface shows it
        for (Triangle& t : surface.triangles) turn_over(t);
    }
    return findings;
}

}   // namespace patency
