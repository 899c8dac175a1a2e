// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_openings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"

namespace patency {

namespace {

// What a flat face that closes an end is.
constexpr double coplanar_degrees = 2;   // between neighbours of one face; what rounding in files leaves is below
constexpr double crease_degrees = 30;    // at its rim; a tube's facets meet at less, a cap cut across it at about 90
constexpr double crease_share = 0.9;     // of the rim that must be so sharp
constexpr double largest_flatness =
    0.02;   // of the diameter; a face with an id or a crease of its own may be cut by hand or bent
constexpr double largest_bent_flatness = 0.1;
constexpr double smallest_roundness = 0.7;   // an ellipse cut at 60 degrees has 0.84, a square 0.79, a triangle 0.60
constexpr double smallest_flat_share =
    0.95;   // |sum of area vectors| / area of a face with an id or a crease: a tube's is 0
constexpr std::size_t fewest_edges = 4;   // a triangle is part of a wall

constexpr double smallest_inlet = 0.5e-3,
                 largest_inlet = 40e-3;   // m: below a coronary branch, above an aneurysm's aorta

double cosine(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

using Chosen = std::vector<std::uint32_t>;

/// A connected part of the surface and the line around it.
struct Face {
    Chosen triangles{};
    std::vector<EdgeUse> rim{};            ///< sides of its triangles that it shares with others
    std::vector<std::uint32_t> beyond{};   ///< the triangle on the other side, per side of the rim
    Vec3 area_sum{};                       ///< of its triangles' area vectors [m^2]
    double area = 0;
};

/// Parts of the surface whose neighbours belong together.
template <class BelongTogether>
std::vector<Face> find_faces(const Surface& surface, const std::vector<EdgeUse>& uses, BelongTogether belong_together) {
    Groups groups(surface.triangles.size());
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2 && belong_together(edge[0].triangle, edge[1].triangle))
            groups.join(edge[0].triangle, edge[1].triangle);
    });
    std::map<std::uint32_t, Face> faces;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        Face& face = faces[groups.group_of(t)];
        const Vec3 area = area_vector(surface, surface.triangles[t]);
        face.triangles.push_back(t);
        face.area_sum += area;
        face.area += norm(area);
    }
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() != 2 || groups.group_of(edge[0].triangle) == groups.group_of(edge[1].triangle)) return;
        for (int k : {0, 1}) {
            Face& face = faces[groups.group_of(edge[k].triangle)];
            face.rim.push_back(edge[k]);
            face.beyond.push_back(edge[1 - k].triangle);
        }
    });
    std::vector<Face> result;
    for (auto& [group, face] : faces) result.push_back(std::move(face));
    return result;
}

/// The rim of a flat face as a loop that looks outward, or one without area if the face has holes or none around it.
FlatLoop rim_of(const Surface& surface, const Face& face) {
    std::vector<EdgeUse> around = face.rim;
    for (EdgeUse& use : around) use.rises = !use.rises;   // find_loops runs as the closing face does: this one
    const std::vector<FlatLoop> loops = find_loops(surface, around);
    return loops.size() == 1 ? loops[0] : FlatLoop{};
}

/// Whether the wall turns away sharply, and backward, nearly all around.
bool has_sharp_rim(const Surface& surface, const Face& face, const FlatLoop& loop) {
    double sharp = 0, length = 0;
    for (std::size_t k = 0; k < face.rim.size(); ++k) {
        const EdgeUse& side = face.rim[k];
        const Triangle& outside = surface.triangles[face.beyond[k]];
        const Vec3 &low = surface.points[side.low], &high = surface.points[side.high];
        const double edge = norm(high - low);
        const double turn = dot(normalized(area_vector(surface, outside)),
                                normalized(area_vector(surface, surface.triangles[side.triangle])));
        // From the edge, not from the plane: a rim may be bent by more than slivers are long.
        const bool goes_back = dot(centroid(surface, outside) - 0.5 * (low + high), loop.normal) < 0;
        length += edge;
        if (turn < cosine(crease_degrees) && goes_back) sharp += edge;
    }
    return sharp > crease_share * length;
}

bool closes_an_end(const FlatLoop& loop, double flatness) {
    return loop.rim.size() >= fewest_edges && loop.area > 0 && loop.roundness() >= smallest_roundness &&
           loop.flatness <= flatness * loop.diameter();
}

SurfaceOpening make_opening(const FlatLoop& loop) {
    return {.opening = {.name = {},
                        .centre = loop.centre,
                        .normal = loop.normal,
                        .area = loop.area,
                        .radius = 0.5 * loop.diameter(),
                        .reach = loop.reach,
                        .planar = false,
                        .mean_square = loop.area / (2 * std::numbers::pi)},   // of a disc of that area
            .perimeter = loop.perimeter,
            .flatness = loop.flatness};
}

/// Flat faces that have an id of their own.
std::vector<SurfaceOpening> find_labelled(const Surface& surface, const std::vector<EdgeUse>& uses) {
    std::vector<SurfaceOpening> openings;
    if (surface.face_ids.empty()) return openings;
    const auto same_id = [&](auto a, auto b) { return surface.face_ids[a] == surface.face_ids[b]; };
    for (const Face& face : find_faces(surface, uses, same_id)) {
        if (norm(face.area_sum) < smallest_flat_share * face.area) continue;
        const FlatLoop loop = rim_of(surface, face);
        if (!closes_an_end(loop, largest_bent_flatness)) continue;
        openings.push_back(make_opening(loop));
        openings.back().face_id = surface.face_ids[face.triangles[0]];
        openings.back().triangles = face.triangles;
    }
    return openings;
}

/// Flat regions within sharp edges, and what is nearly flat between them: a cap that smoothing or noise has bent.
std::vector<SurfaceOpening> find_flat_regions(const Surface& surface, const std::vector<EdgeUse>& uses) {
    std::vector<Vec3> normals;
    for (const Triangle& t : surface.triangles) normals.push_back(normalized(area_vector(surface, t)));
    std::vector<SurfaceOpening> openings;
    std::vector<bool> is_taken(surface.triangles.size(), false);
    const auto find = [&](double degrees, double flatness, double flat_share) {
        const auto belong_together = [&](auto a, auto b) { return dot(normals[a], normals[b]) > cosine(degrees); };
        for (const Face& face : find_faces(surface, uses, belong_together)) {
            if (face.rim.size() < fewest_edges || norm(face.area_sum) < flat_share * face.area) continue;
            if (std::any_of(face.triangles.begin(), face.triangles.end(), [&](std::uint32_t t) { return is_taken[t]; }))
                continue;
            const FlatLoop loop = rim_of(surface, face);
            if (!closes_an_end(loop, flatness) || !has_sharp_rim(surface, face, loop)) continue;
            openings.push_back(make_opening(loop));
            openings.back().triangles = face.triangles;
            if (!surface.face_ids.empty()) openings.back().face_id = surface.face_ids[face.triangles[0]];
            for (const std::uint32_t t : face.triangles) is_taken[t] = true;
        }
    };
    find(coplanar_degrees, largest_flatness, 0);
    find(crease_degrees, largest_bent_flatness, smallest_flat_share);
    return openings;
}

bool has_more_area(const SurfaceOpening& a, const SurfaceOpening& b) { return a.opening.area > b.opening.area; }

void give_names(std::vector<SurfaceOpening>& openings) {
    for (std::size_t k = 0; k < openings.size(); ++k)
        openings[k].opening.name = k == 0 ? "inlet" : fmt::format("outlet_{}", k);
}

bool is_vessel_size(double diameter) { return diameter >= smallest_inlet && diameter <= largest_inlet; }

}   // namespace

std::vector<SurfaceOpening> find_openings(const CheckedSurface& checked) {
    std::vector<SurfaceOpening> openings;
    for (const FlatLoop& loop : checked.ends) openings.push_back(make_opening(loop));
    const std::vector<EdgeUse> uses = edge_uses(checked.surface);
    std::vector<SurfaceOpening> closed = find_labelled(checked.surface, uses);
    if (closed.empty()) closed = find_flat_regions(checked.surface, uses);
    openings.insert(openings.end(), closed.begin(), closed.end());
    std::stable_sort(openings.begin(), openings.end(), has_more_area);
    give_names(openings);
    return openings;
}

void choose_inlet(std::vector<SurfaceOpening>& openings, std::string_view name_or_number) {
    std::size_t chosen = openings.size(), number = 0;
    std::vector<std::string> names;
    const auto [end, error] =
        std::from_chars(name_or_number.data(), name_or_number.data() + name_or_number.size(), number);
    if (error == std::errc{} && end == name_or_number.data() + name_or_number.size() && number >= 1)
        chosen = number - 1;
    for (std::size_t k = 0; k < openings.size(); ++k) {
        names.push_back(openings[k].opening.name);
        if (names.back() == name_or_number) chosen = k;
    }
    if (chosen >= openings.size())
        throw UsageError(
            fmt::format("there is no opening '{}' to be the inlet; the surface has {}, or their numbers 1 to {}.",
                        shortened(name_or_number), names.empty() ? "none" : join(names, ", ", " and "), names.size()));
    std::rotate(openings.begin(), openings.begin() + std::ptrdiff_t(chosen),
                openings.begin() + std::ptrdiff_t(chosen) + 1);
    std::stable_sort(openings.begin() + 1, openings.end(), has_more_area);
    give_names(openings);
}

void rename_openings(std::vector<SurfaceOpening>& openings, const std::map<std::string, std::string>& names) {
    for (const auto& [found, own] : names)
        if (std::none_of(openings.begin(), openings.end(),
                         [&found = found](const SurfaceOpening& o) { return o.opening.name == found; }))
            throw UsageError(fmt::format("there is no opening '{}' to be named", shortened(found)));
    for (SurfaceOpening& o : openings)
        if (const auto own = names.find(o.opening.name); own != names.end()) o.opening.name = own->second;
    for (std::size_t k = 0; k < openings.size(); ++k)
        for (std::size_t j = 0; j < k; ++j)
            if (openings[j].opening.name == openings[k].opening.name)
                throw UsageError(fmt::format("two openings would be '{}'", shortened(openings[k].opening.name)));
}

void expect_vessel_size(const SurfaceOpening& inlet, std::string_view unit) {
    const double diameter = 2 * inlet.opening.radius;
    if (is_vessel_size(diameter)) return;
    const double number = in_unit(diameter, unit);
    std::vector<std::string> fitting;
    for (const std::string& other : unit_names(Dimension::length)) {
        const double in_other = number / in_unit(1, other);
        if (is_vessel_size(in_other)) fitting.push_back(fmt::format("--unit {} ({:.3g} mm)", other, 1e3 * in_other));
    }
    throw GeometryError(fmt::format(
        "the inlet is {:.4g} {} = {:.4g} mm wide, which no vessel's is (0.5 to 40 mm). Is the unit right? {}", number,
        unit, 1e3 * diameter,
        fitting.empty() ? "No unit fits; scale the surface." : "Did you mean " + join(fitting, ", ", " or ") + "?"));
}

std::vector<Finding> find_missing_openings(const std::vector<SurfaceOpening>& openings) {
    if (openings.size() >= 2) return {};
    const Vec3 place = openings.empty() ? Vec3{} : openings[0].opening.centre;
    return {{"missing_openings", Verdict::refused, 2 - openings.size(), place, 0,
             fmt::format("{} found, and blood needs an inlet and an outlet. An opening is an open or a flat end; cut "
                         "rounded ends flat.",
                         openings.empty() ? "no opening was" : "only one opening was")}};
}

}   // namespace patency
