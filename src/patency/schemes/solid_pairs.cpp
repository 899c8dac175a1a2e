// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_pairs.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

constexpr double nearest_neighbours = 1.6;   // spacings: along axes and diagonals of a lattice

Frame frame_around(const SolidParticles& p, double support) {
    if (p.size() == 0) throw GeometryError("a solid has no particles: its spacing is too large");
    Vec3 low = p.reference[0], high = low;
    for (const Vec3& x : p.reference) {
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    const Vec3 margin = support * Vec3{1, 1, 1};
    return Frame(low - margin, high + margin, support);
}

/// Of a spacing: one over a power of two, so that a lattice stays one, of which 16 bits hold the longest distance of a pair.
double quantum(double support_in_spacings) {
    return 1 / std::exp2(std::floor(std::log2(PairUnits::most / support_in_spacings)));
}

void snap(SolidParticles& p, double q) {
    for_each_index(p.size(), [&](std::size_t i) {
        const Vec3 x = p.reference[i],
                   snapped{q * std::round(x.x / q), q * std::round(x.y / q), q * std::round(x.z / q)};
        p.reference[i] = snapped, p.position[i] += snapped - x;
    });
}

}   // namespace

template <class T>
FixedPairs<T> pair_up(SolidParticles& p, const SolidNumerics& numerics) {
    const double spacing = numerics.spacing, support = numerics.kernel().support(), q = quantum(support / spacing);
    snap(p, q * spacing);
    const Frame frame = frame_around(p, support);
    Cells cells;
    Neighbours found;
    p.take(cells.find_order(frame, spacing, {p.reference.data(), p.size()}));
    cells.index(frame, spacing, {p.reference.data(), p.size()});
    found.find_own(frame, cells, support, native_lanes<T>);
    FixedRows rows = rows_by_particle(found, p.size());
    if (!numerics.across_gaps) rows = joined(rows, p.reference, nearest_neighbours * spacing);
    const std::vector<std::uint32_t> order = find_order(rows, [&](std::uint32_t i) { return p.material[i]; });
    p.take(order);
    // The same for both of a pair, also as they are kept: their forces are opposite to the last bit.
    const auto find = [&](std::uint32_t i, std::uint32_t j) {
        const Vec3 d = p.reference[i] - p.reference[j];
        const double v = std::sqrt(p.volume[i] * p.volume[j]) / numerics.cell(),
                     t = std::max(0.0, 1 - norm(d) / support);
        return FoundPair{(1 / spacing) * d, v * t * t * t};
    };
    const FixedRows packed = reordered(rows, order);
    const double largest = largest_of(p.size(), [&](std::size_t i) {
        double w = 0;
        for (const std::uint32_t j : packed[i]) w = std::max(w, find(std::uint32_t(i), j).w);
        return w;
    });
    FixedPairs<T> pairs;
    pairs.make(packed, {q, largest}, find);
    return pairs;
}

template FixedPairs<double> pair_up<double>(SolidParticles&, const SolidNumerics&);
template FixedPairs<float> pair_up<float>(SolidParticles&, const SolidNumerics&);

}   // namespace patency
