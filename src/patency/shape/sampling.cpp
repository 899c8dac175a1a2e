// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "patency/base/errors.h"

namespace patency {

namespace {

double stretched(double spacing, double length) {
    return length > 0 ? length / std::max(1.0, std::round(length / spacing)) : spacing;
}

// One candidate: where, how deep, and to which part it belongs (0: the lumen, k + 1: past opening k).
struct Candidate {
    Vec3 x;
    double depth;
    std::size_t part;
    bool reached_by_fluid;
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

// The length past an opening, rounded to whole cells [m].
double whole_cells(const Lattice& lattice, const Opening& opening, double length) {
    const Vec3 n = transpose(lattice.frame.rotation) * opening.normal;
    const double cell = std::abs(n.x) * lattice.cell.x + std::abs(n.y) * lattice.cell.y + std::abs(n.z) * lattice.cell.z;
    return cell * std::round(length / cell);
}

}  // namespace

Lattice fitted_lattice(const Lumen& lumen, double spacing) {
    if (!(spacing > 0) || !std::isfinite(spacing))
        throw GeometryError(fmt::format("The particle spacing is {} m: it must be positive and finite.", spacing));
    return {lumen.frame,
            {stretched(spacing, lumen.fit.x), stretched(spacing, lumen.fit.y), stretched(spacing, lumen.fit.z)},
            lumen.planar};
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

FittedPoints make_fitted_points(const Lumen& lumen, double spacing, const PointsExtent& extent) {
    const Lattice lattice = fitted_lattice(lumen, spacing);
    FittedPoints result{{}, {}, {}, {}, lattice.cell_volume()};
    const double outermost = std::max(extent.wall_thickness, spacing);   // points just outside may become fluid
    for (const Opening& opening : lumen.openings)
        result.fluid_extension.push_back(whole_cells(lattice, opening, extent.fluid_extension));

    std::vector<Candidate> candidates;
    const auto keep = [&](const Vec3& x) {
        const double depth = lumen.distance.value(x);
        if (depth >= outermost) return false;
        const int opening = opening_beyond(lumen, x, outermost);
        const std::size_t part = std::size_t(opening + 1);
        const double s = part == 0 ? 0 : opening_coordinates(lumen.openings[part - 1], x).s;
        const double fluid_end = part == 0 ? 0 : result.fluid_extension[part - 1];
        if (s > std::max(extent.wall_extension, fluid_end)) return false;
        candidates.push_back({x, depth, part, s <= fluid_end});
        return false;   // they are kept here, with their depths
    };
    lattice_points(lattice, region_of(lumen, extent, spacing), keep);

    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return candidates[a].depth < candidates[b].depth; });
    std::vector<bool> is_fluid(candidates.size());
    for (std::size_t part = 0; part <= lumen.openings.size(); ++part) {
        const double volume = part == 0 ? lumen.volume : lumen.openings[part - 1].area * result.fluid_extension[part - 1];
        const auto wanted = std::size_t(std::llround(volume / result.volume));
        std::size_t count = 0;
        for (std::size_t k : order) {
            if (count == wanted) break;
            if (candidates[k].part != part || !candidates[k].reached_by_fluid) continue;
            is_fluid[k] = true;
            ++count;
        }
        if (count < wanted)
            throw GeometryError(fmt::format("A spacing of {:.3g} m gives {} points where {} are needed: the lumen is "
                                            "too narrow for it; take a smaller spacing.", spacing, count, wanted));
        result.fluid_count.push_back(count);
        for (std::size_t k = 0; k < candidates.size(); ++k)   // in lattice order
            if (is_fluid[k] && candidates[k].part == part) result.fluid.push_back(candidates[k].x);
    }
    for (std::size_t k = 0; k < candidates.size(); ++k)
        if (!is_fluid[k] && candidates[k].depth < extent.wall_thickness &&
            (candidates[k].depth > 0 || candidates[k].reached_by_fluid))   // inside, past the fluid's end: nobody's
            result.wall.push_back(candidates[k].x);
    return result;
}

}  // namespace patency
