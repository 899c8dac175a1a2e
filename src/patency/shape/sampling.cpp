// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
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
Bounds region_of(const Lumen& lumen, const PointsExtent& extent, double spacing, double margin) {
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

// The lattice points of a box: (k + 1/2) cells along each axis, a rounding error included.
struct LatticeRange {
    Lattice lattice;
    std::array<long, 3> first, last;

    LatticeRange(const Lattice& of, const Bounds& region) : lattice(of) {
        const Mat3 back = transpose(lattice.frame.rotation);
        const Bounds own = moved(region, {back, -(back * lattice.frame.origin)});
        const double low[3] = {own.low.x, own.low.y, own.low.z}, high[3] = {own.high.x, own.high.y, own.high.z};
        const double cell[3] = {lattice.cell.x, lattice.cell.y, lattice.cell.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = long(std::ceil(low[axis] / cell[axis] - 0.5 - 1e-9));
            last[axis] = long(std::floor(high[axis] / cell[axis] - 0.5 + 1e-9));
        }
        if (lattice.planar) first[2] = last[2] = 0;
    }
    Vec3 place(double i, double j, double k) const {
        return lattice.frame.place({(i + 0.5) * lattice.cell.x, (j + 0.5) * lattice.cell.y,
                                    lattice.planar ? 0.0 : (k + 0.5) * lattice.cell.z});
    }
};

// The lattice points nearer to the wall than `outermost`, x fastest, and how much of the space up to `thickness` outside
// of it lies behind the openings.
struct LumenCandidates {
    std::vector<Candidate> points;
    double cells_within_thickness = 0;
};

LumenCandidates find_candidates(const Lumen& lumen, const Lattice& lattice, const PointsExtent& extent,
                                const FittedPoints& ends, double spacing, double outermost, double band) {
    // A distance changes by at most the length of the way: blocks that are too far away are left out.
    constexpr long side = 3;
    const LatticeRange range(lattice, region_of(lumen, extent, spacing, outermost + spacing));
    // Not by a structured binding: OpenMP and older Clangs do not hand those on.
    const long i0 = range.first[0], j0 = range.first[1], k0 = range.first[2];
    const long i1 = range.last[0], j1 = range.last[1], k1 = range.last[2];
    if (i1 < i0 || j1 < j0 || k1 < k0) return {};
    const double reach = outermost + norm(Vec3{lattice.cell.x, lattice.cell.y, lattice.planar ? 0 : lattice.cell.z});
    const std::size_t slabs = std::size_t((k1 - k0) / side + 1);
    std::vector<LumenCandidates> of_slab(slabs);
    const auto visit = [&](const Vec3& x, LumenCandidates& found) {
        const double depth = lumen.distance.value(x);
        if (depth >= outermost) return;
        double share = smooth_step((extent.wall_thickness - depth) / band);
        for (const Opening& opening : lumen.openings) {
            if (share == 0) break;
            const auto [s, radial] = opening_coordinates(opening, x);
            if (s > -band && s < lumen.extension + 2 * opening.reach + outermost &&
                norm(radial) < opening.reach + outermost)
                share *= smooth_step(-s / band);
        }
        found.cells_within_thickness += share;
        const int opening = opening_beyond(lumen, x, outermost);
        std::size_t part = 0;
        if (opening >= 0) {
            const std::size_t k = std::size_t(opening);
            const double s = opening_coordinates(lumen.openings[k], x).s;
            if (s > ends.wall_end[k]) return;
            part = 2 * k + (s <= ends.fluid_end[k] ? 1 : 2);
        }
        found.points.push_back({x, depth, part});
    };
    for_each_task(slabs, [&](std::size_t slab) {
        const long low = k0 + side * long(slab), high = std::min(k1, low + side - 1);
        const long rows = (j1 - j0) / side + 1, blocks = (i1 - i0) / side + 1;
        std::vector<char> is_near(std::size_t(rows * blocks));
        for (long b = 0; b < rows; ++b)
            for (long a = 0; a < blocks; ++a) {
                const Vec3 middle = range.place(double(i0 + side * a) + 1, double(j0 + side * b) + 1, double(low) + 1);
                is_near[std::size_t(b * blocks + a)] = lumen.distance.value(middle) < reach;
            }
        for (long k = low; k <= high; ++k)
            for (long j = j0; j <= j1; ++j)
                for (long i = i0; i <= i1; ++i)
                    if (is_near[std::size_t((j - j0) / side * blocks + (i - i0) / side)])
                        visit(range.place(double(i), double(j), double(k)), of_slab[slab]);
    });
    LumenCandidates all;
    for (const LumenCandidates& slab : of_slab) {
        all.points.insert(all.points.end(), slab.points.begin(), slab.points.end());
        all.cells_within_thickness += slab.cells_within_thickness;
    }
    return all;
}

// The volume between the wall and its outer face, per part [m^3].
std::vector<double> wall_volumes(const Lumen& lumen, double thickness, double within, const FittedPoints& ends) {
    if (thickness <= 0) return std::vector<double>(1 + 2 * lumen.openings.size(), 0.0);
    std::vector<double> volumes{std::max(0.0, within - lumen.volume)};
    for (std::size_t k = 0; k < lumen.openings.size(); ++k) {
        const double r = lumen.openings[k].radius;
        const double ring = std::numbers::pi * thickness * (2 * r + thickness);
        volumes.push_back(ring * ends.fluid_end[k]);
        volumes.push_back(ring * (ends.wall_end[k] - ends.fluid_end[k]));
    }
    return volumes;
}

}   // namespace

Lattice fitted_lattice(const Lumen& lumen, double spacing) {
    if (!(spacing > 0) || !std::isfinite(spacing))
        throw GeometryError(fmt::format("The particle spacing is {} m: it must be positive and finite.", spacing));
    Vec3 cell{stretched(spacing, lumen.fit.x), stretched(spacing, lumen.fit.y), stretched(spacing, lumen.fit.z)};
    const int free_axes =
        (lumen.fit.x > 0 ? 0 : 1) + (lumen.fit.y > 0 ? 0 : 1) + (lumen.planar || lumen.fit.z > 0 ? 0 : 1);
    const double volume = lumen.planar ? cell.x * cell.y : cell.x * cell.y * cell.z;
    if (free_axes > 0 && lumen.volume > 0 &&
        std::isfinite(lumen.volume)) {   // a whole number of cells makes up the volume
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
    const LatticeRange range(lattice, region);
    std::vector<Vec3> points;
    for (long k = range.first[2]; k <= range.last[2]; ++k)
        for (long j = range.first[1]; j <= range.last[1]; ++j)
            for (long i = range.first[0]; i <= range.last[0]; ++i) {
                const Vec3 x = range.place(double(i), double(j), double(k));
                if (wanted(x)) points.push_back(x);
            }
    return points;
}

std::vector<Vec3> make_lattice(const Lumen& lumen, double spacing) {
    return lattice_points(fitted_lattice(lumen, spacing), region_of(lumen, {}, spacing, spacing),
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

    const bool fits = lattice_fits(lumen);
    // Points a little farther out may be needed to make up a volume. A step that is smooth over two spacings to both sides
    // counts what lies within to 2e-4; over one and a half it is 5e-4.
    const double band = fits ? 0 : 2 * spacing;
    const auto [candidates, within] =
        find_candidates(lumen, lattice, extent, result, spacing, extent.wall_thickness + band, band);

    std::vector<std::vector<std::size_t>> of_part(parts);   // in lattice order
    for (std::size_t k = 0; k < candidates.size(); ++k) of_part[candidates[k].part].push_back(k);
    const auto shell = fits ? std::vector<double>(parts, Bounds::infinity)
                            : wall_volumes(lumen, extent.wall_thickness, within * result.volume, result);
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t k = part == 0 ? 0 : (part - 1) / 2;
        const bool filler = part > 0 && part % 2 == 0;
        const double volume = part == 0 ? lumen.volume
                                        : lumen.openings[k].area *
                                              (filler ? result.wall_end[k] - result.fluid_end[k] : result.fluid_end[k]);
        const auto inside = std::size_t(std::llround(volume / result.volume));
        const std::size_t all = std::isinf(shell[part])
                                    ? of_part[part].size()
                                    : std::size_t(std::llround((volume + shell[part]) / result.volume));
        std::vector<std::size_t>& by_depth = of_part[part];
        if (by_depth.size() < inside)
            throw GeometryError(
                fmt::format("A spacing of {:.3g} m gives {} points where {} are needed: the lumen is "
                            "too narrow for it; take a smaller spacing.",
                            spacing, by_depth.size(), inside));
        // The deepest ones, in lattice order, for neighbours in space to be neighbours in memory.
        const std::size_t end = std::min(all, by_depth.size());
        const auto deepest_first = [&candidates = candidates](std::size_t a, std::size_t b) {
            return std::pair(candidates[a].depth, a) < std::pair(candidates[b].depth, b);
        };
        const auto at = [&](std::size_t n) { return by_depth.begin() + std::ptrdiff_t(n); };
        if (end < by_depth.size()) std::nth_element(at(0), at(end), by_depth.end(), deepest_first);
        if (inside < end) std::nth_element(at(0), at(inside), at(end), deepest_first);
        std::sort(at(0), at(inside));
        std::sort(at(inside), at(end));
        for (std::size_t n = 0; n < end; ++n)
            (n >= inside ? result.wall : filler ? result.filler : result.fluid).push_back(candidates[by_depth[n]].x);
        if (!filler) result.fluid_count.push_back(inside);
    }
    return result;
}

}   // namespace patency
