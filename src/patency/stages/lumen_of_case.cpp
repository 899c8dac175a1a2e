// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/lumen_of_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/io/network_file.h"
#include "patency/shape/network_lumen.h"
#include "patency/shape/surface_lumen.h"

namespace patency {

namespace {

std::vector<AxialRadius> outline_of(const deck::Shape& shape) {
    switch (shape.type) {
        case deck::ShapeType::channel: return {{0, 0.5 * shape.gap}, {shape.length, 0.5 * shape.gap}};
        case deck::ShapeType::box: return {{0, 0.5 * shape.size.y}, {shape.size.x, 0.5 * shape.size.y}};
        case deck::ShapeType::tube: return {{0, 0.5 * shape.diameter}, {shape.length, 0.5 * shape.diameter}};
        case deck::ShapeType::cone:
            return {{0, 0.5 * shape.diameters.at(0)}, {shape.length, 0.5 * shape.diameters.at(1)}};
        case deck::ShapeType::nozzle: {
            std::vector<AxialRadius> outline;
            for (const deck::NozzleSection& s : shape.sections) outline.push_back({s.z, 0.5 * s.diameter});
            return outline;
        }
        case deck::ShapeType::step:
        case deck::ShapeType::branches: break;
    }
    return {};
}

/// How far a distance goes on past openings: for the buffer, the wall beyond it and its kernels; of cells, whose spacing
/// follows the vessel, for the lattice that points rest against.
double extension_for(const deck::Numerics& numerics, double widest) {
    return numerics.follows_vessel() ? 4 * widest / *numerics.across : 12 * numerics.spacing;
}

/// The finest spacing of a vessel.
double finest_spacing(const deck::Numerics& numerics, double narrowest) {
    if (!numerics.follows_vessel()) return numerics.spacing;
    return std::max(narrowest / *numerics.across, numerics.smallest_spacing.value_or(0));
}

Lumen make_box_of(const deck::Case& config, const deck::Shape& shape) {
    const char* names[3][2] = {{"inlet", "outlet"}, {"y_low", "y_high"}, {"z_low", "z_high"}};
    BoxShape box{.size = shape.size, .planar = shape.planar};
    for (std::size_t k = 0; k < 3; ++k) {
        const bool is_open = config.openings.contains(names[k][0]) || config.openings.contains(names[k][1]);
        box.sides[k] = shape.periodic[k] ? Side::periodic : is_open ? Side::open : Side::wall;
    }
    return make_box(box);
}

/// Ends of branches that lie in no other branch are openings: inlet at the only free `from`, outlet_NAME at a free `to`.
Lumen make_branches_of(const deck::Case& config, const deck::Shape& shape) {
    const auto& branches = shape.branches;
    const auto is_free = [&](const Vec3& x, std::size_t self) {
        for (std::size_t k = 0; k < branches.size(); ++k) {
            if (k == self) continue;
            const deck::Branch& b = branches[k];
            const SignedDistance other =
                union_of_round_cones({{b.from, b.to, 0.5 * b.diameters.at(0), 0.5 * b.diameters.at(1)}});
            if (other.value(x) < 0) return false;
        }
        return true;
    };
    std::vector<std::size_t> starts, ends;
    for (std::size_t k = 0; k < branches.size(); ++k) {
        if (is_free(branches[k].from, k)) starts.push_back(k);
        if (is_free(branches[k].to, k)) ends.push_back(k);
    }
    double widest = 0;
    for (const deck::Branch& branch : shape.branches)
        for (const double d : branch.diameters) widest = std::max(widest, d);
    BranchesShape result{.branches = {}, .extension = extension_for(config.numerics, widest)};
    for (std::size_t k = 0; k < branches.size(); ++k) {
        const deck::Branch& b = branches[k];
        BranchShape branch{.points = {b.from, b.to},
                           .radii = {0.5 * b.diameters.at(0), 0.5 * b.diameters.at(1)},
                           .start = {},
                           .end = {}};
        if (std::find(starts.begin(), starts.end(), k) != starts.end())
            branch.start = starts.size() == 1 ? "inlet" : "inlet_" + b.name;
        if (std::find(ends.begin(), ends.end(), k) != ends.end())
            branch.end = ends.size() == 1 ? "outlet" : "outlet_" + b.name;
        result.branches.push_back(branch);
    }
    return make_branches(result);
}

double narrowest_width(const deck::Shape& shape) {
    if (shape.type == deck::ShapeType::box)
        return shape.planar ? std::min(shape.size.x, shape.size.y)
                            : std::min({shape.size.x, shape.size.y, shape.size.z});
    if (shape.type == deck::ShapeType::step) return shape.gap - shape.step_height;
    double width = Bounds::infinity;
    for (const AxialRadius& a : outline_of(shape)) width = std::min(width, 2 * a.radius);
    for (const deck::Branch& b : shape.branches)
        for (const double d : b.diameters) width = std::min(width, d);
    return width;
}

Lumen make_network_of(const deck::Case& config) {
    const deck::Geometry& g = config.geometry;
    const Network network = read_network_of(config);
    const double narrowest = narrowest_diameter(network), dp = finest_spacing(config.numerics, narrowest);
    constexpr double least_across = 4;   // as for shapes (config/checks.cpp)
    if (narrowest < least_across * dp)
        throw DeckError(fmt::format(
            "numerics.spacing: leaves fewer than 4 particles across the narrowest place, {:.3g} mm; at least 12 give "
            "a sensible answer",
            1e3 * narrowest));
    // Cells see triangles, not voxels, and at 12 to 20 across finer ones do not change their answer (docs/VERIFICATION.md, cells_bifurcation).
    constexpr double finest_across_radius = 12;
    const double resolution =
        config.numerics.follows_vessel() ? std::max(0.5 * dp, 0.5 * narrowest / finest_across_radius) : 0.5 * dp;
    Lumen lumen = make_network_lumen(network, extension_for(config.numerics, widest_diameter(network)), resolution);
    expect_vessel_size({.opening = lumen.openings[0], .perimeter = 0, .flatness = 0}, g.unit.value_or("mm"));
    return lumen;
}

Lumen make_unchecked(const deck::Case& config, const deck::Shape& shape) {
    const auto ends = config.openings.empty() ? Side::periodic : Side::open;
    const auto along_axis = [&] { return motion_along(shape.axis, shape.start); };
    switch (shape.type) {
        case deck::ShapeType::channel: return make_channel({.length = shape.length, .gap = shape.gap, .ends = ends});
        case deck::ShapeType::step:
            return make_step(
                {.length = shape.length, .gap = shape.gap, .height = shape.step_height, .at = shape.step_at});
        case deck::ShapeType::box: return make_box_of(config, shape);
        case deck::ShapeType::tube:
            return moved(make_tube({.length = shape.length, .radius = 0.5 * shape.diameter, .ends = ends}),
                         along_axis());
        case deck::ShapeType::cone:
        case deck::ShapeType::nozzle: return moved(make_nozzle({outline_of(shape)}), along_axis());
        case deck::ShapeType::branches: return make_branches_of(config, shape);
    }
    throw GeometryError("geometry.shape.type is none of the known ones");
}

Lumen make_lumen_of_surface(const deck::Case& config, const Vessel& vessel) {
    const deck::Geometry& geometry = config.geometry;
    double narrowest = narrowest_diameter(*vessel.along), widest = 0;
    for (const SurfaceOpening& opening : vessel.openings) {
        narrowest = std::min(narrowest, 2 * opening.opening.radius);
        widest = std::max(widest, 2 * opening.opening.radius);
    }
    const double dp = finest_spacing(config.numerics, narrowest);
    // Half a spacing: the distance errs by less than a twentieth of it. Ten voxels hold the wall's points and those that may
    // become some; the continuations hold the buffer, the wall beyond it and its kernels.
    Lumen lumen = make_surface_lumen(vessel.checked, vessel.openings,
                                     {.voxel = 0.5 * dp,
                                      .outside = 5 * dp,
                                      .extension = extension_for(config.numerics, widest),
                                      .straight = geometry.extensions.diameters});
    std::vector<double> outlets;
    for (std::size_t k = 1; k < lumen.openings.size(); ++k) outlets.push_back(2 * lumen.openings[k].radius);
    lumen.narrowest = narrowest;
    lumen.passage = passage_of(*vessel.along, outlets);
    return lumen;
}

void expect_same_names(const deck::Case& config, const Lumen& lumen) {
    std::vector<std::string> names;
    for (const Opening& opening : lumen.openings) names.push_back(opening.name);
    for (const auto& [name, opening] : config.openings) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        const std::string nearest = nearest_name(name, names);
        throw DeckError(fmt::format("openings.{}: the lumen has no such opening{}; it has {}", name,
                                    nearest.empty() ? "" : ", did you mean " + nearest + "?",
                                    names.empty() ? "none" : join(names, ", ", " and ")));
    }
    for (const std::string& name : names)
        if (!config.openings.contains(name))
            throw DeckError(fmt::format("openings.{}: what happens at this opening is missing; the lumen has {}", name,
                                        join(names, ", ", " and ")));
}

}   // namespace

Network read_network_of(const deck::Case& config) {
    const deck::Geometry& g = config.geometry;
    Network network;
    try {
        network = read_network(g.network.value(), g.unit.value_or(""), g.space.value_or(""));
    } catch (const UsageError& error) {   // of the unit or the space that the deck gives
        throw DeckError(fmt::format("geometry: {}", error.what()));
    }
    if (const auto& lesion = g.lesion) try {
            add_lesion(network, {.tube = lesion->branch,
                                 .position = lesion->position,
                                 .length = lesion->length,
                                 .stenosis = lesion->diameter_stenosis_percent / 100,
                                 .eccentricity = lesion->eccentricity,
                                 .side = lesion->side});
        } catch (const GeometryError& error) {   // what the deck asks for is not to be had of this network
            throw DeckError(fmt::format("geometry.lesion: {}", error.what()));
        }
    return network;
}

Lumen make_lumen_of_shape(const deck::Case& config) { return make_unchecked(config, config.geometry.shape.value()); }

Lumen make_lumen(const deck::Case& config, const Vessel* known) {
    const deck::Geometry& g = config.geometry;
    Lumen lumen = g.shape     ? make_unchecked(config, *g.shape)
                  : g.network ? make_network_of(config)
                  : known     ? make_lumen_of_surface(config, *known)
                              : make_lumen_of_surface(config, read_vessel(config));
    if (g.shape) {
        const double width = lumen.narrowest = narrowest_width(*g.shape);
        if (g.shape->type != deck::ShapeType::box && !is_branching(g))
            lumen.passage.tightest_area = lumen.planar ? width : 0.25 * std::numbers::pi * width * width;
    }
    // Cells are few enough to ask the triangles, and a vessel's own spacings would need a grid of its finest everywhere.
    if (config.numerics.follows_vessel() && lumen.exact) lumen.distance = *lumen.exact;
    expect_same_names(config, lumen);
    return lumen;
}

double StraightAxis::radial(const Vec3& x) const {
    const Vec3 d = x - start;
    return norm(d - dot(d, direction) * direction);
}

double StraightAxis::radius_at(double place) const {
    if (place <= outline.front().axial) return outline.front().radius;
    for (std::size_t k = 1; k < outline.size(); ++k) {
        const AxialRadius &a = outline[k - 1], &b = outline[k];
        if (place <= b.axial && b.axial > a.axial)
            return a.radius + (place - a.axial) / (b.axial - a.axial) * (b.radius - a.radius);
    }
    return outline.back().radius;
}

bool is_branching(const deck::Geometry& geometry) {
    return geometry.network || geometry.surface ||
           (geometry.shape && geometry.shape->type == deck::ShapeType::branches);
}

std::optional<StraightAxis> find_straight_axis(const deck::Geometry& geometry) {
    if (!geometry.shape) return {};
    const deck::Shape& shape = *geometry.shape;
    const std::vector<AxialRadius> outline = outline_of(shape);
    if (outline.empty() || (shape.type == deck::ShapeType::box && !shape.planar)) return {};
    const double length = outline.back().axial - outline.front().axial;
    if (shape.is_planar())
        return StraightAxis{{0, outline.front().radius, 0}, {1, 0, 0}, length, Section::planar, outline};
    return StraightAxis{shape.start, normalized(shape.axis), length, Section::circular, outline};
}

std::string_view plane_wall_name(const Vec3& n) {
    if (std::abs(n.x) > std::abs(n.y) && std::abs(n.x) > std::abs(n.z)) return n.x < 0 ? "x_low" : "x_high";
    if (std::abs(n.y) > std::abs(n.z)) return n.y < 0 ? "y_low" : "y_high";
    return n.z < 0 ? "z_low" : "z_high";
}

}   // namespace patency
