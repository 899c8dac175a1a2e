// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/measure.h"

namespace patency {

namespace {

double stretched(double spacing, double length) {
    return length > 0 ? length / std::max(1.0, std::round(length / spacing)) : spacing;
}

// A lattice point that may be taken: where, how deep, and in which part of the lumen.
struct Candidate {
    Vec3 x;
    double depth;
    std::size_t part;   // 0: the lumen; 2k + 1: fluid past opening k; 2k + 2: farther out
};

// The box around the lumen and its continuations, not past the ends of periodic axes.
Bounds region_of(const Lumen& lumen, const PointsExtent& extent, double spacing) {
    const double margin = extent.wall_thickness + spacing;
    Bounds region = grown(lumen.bounds, margin);
    for (const Opening& opening : lumen.openings) {
        const Vec3 end = opening.centre + (extent.wall_extension + spacing) * opening.normal;
        region = joined(region, grown({end, end}, opening.reach + margin));
    }
    if (lumen.period.x > 0) region.low.x = lumen.bounds.low.x, region.high.x = lumen.bounds.high.x;
    if (lumen.period.y > 0) region.low.y = lumen.bounds.low.y, region.high.y = lumen.bounds.high.y;
    if (lumen.period.z > 0) region.low.z = lumen.bounds.low.z, region.high.z = lumen.bounds.high.z;
    return region;
}

// The length past an opening [m], rounded to whole cells if the lattice lies along the opening's normal.
double whole_cells(const Lattice& lattice, const Opening& opening, double length) {
    const Vec3 n = transpose(lattice.frame.rotation) * opening.normal;
    const double along[3] = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const double cells[3] = {lattice.cell.x, lattice.cell.y, lattice.cell.z};
    for (int k = 0; k < 3; ++k)
        if (along[k] > 1 - 1e-12) return cells[k] * std::round(length / cells[k]);
    return length;
}

// The volume between the wall and its outer face, per part [m^3].
std::vector<double> wall_volumes(const Lumen& lumen, double spacing, double thickness, const FittedPoints& ends) {
    if (thickness <= 0) return std::vector<double>(1 + 2 * lumen.openings.size(), 0.0);
    Lumen outer = lumen;
    outer.distance = offset_by(lumen.distance, thickness);
    outer.bounds = grown(lumen.bounds, thickness);
    for (Opening& opening : outer.openings) opening.reach += thickness;
    std::vector<double> volumes{measure(outer, 0.5 * spacing).volume - lumen.volume};
    for (std::size_t k = 0; k < lumen.openings.size(); ++k) {
        const double r = lumen.openings[k].radius;
        const double ring = std::numbers::pi * thickness * (2 * r + thickness);
        volumes.push_back(ring * ends.fluid_end[k]);
        volumes.push_back(ring * (ends.wall_end[k] - ends.fluid_end[k]));
    }
    return volumes;
}

}  // namespace

Lattice fitted_lattice(const Lumen& lumen, double spacing) {
    if (!(spacing > 0) || !std::isfinite(spacing))
        throw GeometryError(fmt::format("The particle spacing is {} m: it must be positive and finite.", spacing));
    Vec3 cell{stretched(spacing, lumen.fit.x), stretched(spacing, lumen.fit.y), stretched(spacing, lumen.fit.z)};
    const int free_axes = (lumen.fit.x > 0 ? 0 : 1) + (lumen.fit.y > 0 ? 0 : 1) + (lumen.planar || lumen.fit.z > 0 ? 0 : 1);
    const double volume = lumen.planar ? cell.x * cell.y : cell.x * cell.y * cell.z;
    if (free_axes > 0 && lumen.volume > 0 && std::isfinite(lumen.volume)) {   // a whole number of cells makes up the volume
        const double whole = lumen.volume / std::max(1.0, std::round(lumen.volume / volume));
        const double factor = std::pow(whole / volume, 1.0 / free_axes);
        if (!(lumen.fit.x > 0)) cell.x *= factor;
        if (!(lumen.fit.y > 0)) cell.y *= factor;
        if (!lumen.planar && !(lumen.fit.z > 0)) cell.z *= factor;
    }
    return {lumen.frame, cell, lumen.planar};
}

std::vector<Vec3> lattice_points(const Lattice& lattice, const Bounds& region,
                                 const std::function<bool(const Vec3&)>& wanted) {
    const Mat3 back = transpose(lattice.frame.rotation);
    const Bounds own = moved(region, {back, -(back * lattice.frame.origin)});
    const auto range = [](double low, double high, double cell) {
        // The points (k + 1/2) cell in [low, high], a rounding error included.
        return std::array<long, 2>{long(std::ceil(low / cell - 0.5 - 1e-9)), long(std::floor(high / cell - 0.5 + 1e-9))};
    };
    const auto [i0, i1] = range(own.low.x, own.high.x, lattice.cell.x);
    const auto [j0, j1] = range(own.low.y, own.high.y, lattice.cell.y);
    auto [k0, k1] = range(own.low.z, own.high.z, lattice.cell.z);
    if (lattice.planar) k0 = k1 = 0;
    std::vector<Vec3> points;
    for (long k = k0; k <= k1; ++k)
        for (long j = j0; j <= j1; ++j)
            for (long i = i0; i <= i1; ++i) {
                const Vec3 own_point{(double(i) + 0.5) * lattice.cell.x, (double(j) + 0.5) * lattice.cell.y,
                                     lattice.planar ? 0.0 : (double(k) + 0.5) * lattice.cell.z};
                const Vec3 x = lattice.frame.place(own_point);
                if (wanted(x)) points.push_back(x);
            }
    return points;
}

std::vector<Vec3> make_lattice(const Lumen& lumen, double spacing) {
    return lattice_points(fitted_lattice(lumen, spacing), region_of(lumen, {}, spacing),
                          [&](const Vec3& x) { return contains(lumen, x); });
}

bool lattice_fits(const Lumen& lumen) {
    return lumen.fit.x > 0 && lumen.fit.y > 0 && (lumen.planar || lumen.fit.z > 0);
}

FittedPoints make_fitted_points(const Lumen& lumen, double spacing, const PointsExtent& extent) {
    const Lattice lattice = fitted_lattice(lumen, spacing);
    const std::size_t openings = lumen.openings.size(), parts = 1 + 2 * openings;
    FittedPoints result;
    result.volume = lattice.cell_volume();
    for (const Opening& opening : lumen.openings) {
        result.fluid_end.push_back(whole_cells(lattice, opening, extent.fluid_extension));
        result.wall_end.push_back(
            whole_cells(lattice, opening, std::max(extent.wall_extension, extent.fluid_extension)));
    }

    std::vector<Candidate> candidates;
    const bool fits = lattice_fits(lumen);
    // Points a little farther out may be needed to make up a volume.
    const double outermost = extent.wall_thickness + (fits ? 0 : spacing);
    lattice_points(lattice, region_of(lumen, extent, spacing), [&](const Vec3& x) {
        const double depth = lumen.distance.value(x);
        if (depth >= outermost) return false;
        const int opening = opening_beyond(lumen, x, outermost);
        if (opening < 0) {
            candidates.push_back({x, depth, 0});
            return false;   // they are kept here, with their depths
        }
        const std::size_t k = std::size_t(opening);
        const double s = opening_coordinates(lumen.openings[k], x).s;
        if (s <= result.wall_end[k]) candidates.push_back({x, depth, 2 * k + (s <= result.fluid_end[k] ? 1 : 2)});
        return false;
    });

    std::vector<std::vector<std::size_t>> of_part(parts);   // in lattice order
    for (std::size_t k = 0; k < candidates.size(); ++k) of_part[candidates[k].part].push_back(k);
    const auto shell = fits ? std::vector<double>(parts, Bounds::infinity) : wall_volumes(lumen, spacing, extent.wall_thickness, result);
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t k = part == 0 ? 0 : (part - 1) / 2;
        const bool filler = part > 0 && part % 2 == 0;
        const double volume = part == 0 ? lumen.volume
                                        : lumen.openings[k].area * (filler ? result.wall_end[k] - result.fluid_end[k]
                                                                           : result.fluid_end[k]);
        const auto inside = std::size_t(std::llround(volume / result.volume));
        const std::size_t all = std::isinf(shell[part])
                                    ? of_part[part].size()
                                    : std::size_t(std::llround((volume + shell[part]) / result.volume));
        std::vector<std::size_t> by_depth = of_part[part];
        std::stable_sort(by_depth.begin(), by_depth.end(), [&](std::size_t a, std::size_t b) {
            return candidates[a].depth < candidates[b].depth;
        });
        if (by_depth.size() < inside)
            throw GeometryError(fmt::format("A spacing of {:.3g} m gives {} points where {} are needed: the lumen is "
                                            "too narrow for it; take a smaller spacing.",
                                            spacing, by_depth.size(), inside));
        // In lattice order, for neighbours in space to be neighbours in memory.
        const std::size_t end = std::min(all, by_depth.size());
        std::sort(by_depth.begin(), by_depth.begin() + std::ptrdiff_t(inside));
        std::sort(by_depth.begin() + std::ptrdiff_t(inside), by_depth.begin() + std::ptrdiff_t(end));
        for (std::size_t n = 0; n < end; ++n)
            (n >= inside ? result.wall : filler ? result.filler : result.fluid).push_back(candidates[by_depth[n]].x);
        if (!filler) result.fluid_count.push_back(inside);
    }
    return result;
}

}  // namespace patency
