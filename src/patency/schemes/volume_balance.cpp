// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/volume_balance.h"

#include "patency/base/parallel.h"

namespace patency {

namespace {

/// Without blood around its section nothing tells the flow there: the domain ends before.
bool is_balanced(const OpenEnd& end) { return !end.entrance.empty() && !end.further.empty(); }

}   // namespace

void VolumeBalance::divide_into_parts() {
    place_.assign(domain_.fluid.size(), rest);
    places_.clear();
    for (std::uint32_t e = 0; e < domain_.ends.size(); ++e) {
        const OpenEnd& end = domain_.ends[e];
        if (!is_balanced(end)) continue;
        for (const auto& m : end.entrance) place_[m.index] = std::uint32_t(places_.size()), places_.push_back({e});
    }
}

/// What the sums miss in an entrance they miss where they see shear that they do not resolve: by its square.
void VolumeBalance::share_excess() {
    const auto& gradient = domain_.fluid.velocity_gradient;
    for (const OpenEnd& end : domain_.ends) {
        const auto square = [&](std::size_t k) {
            const Mat3& g = gradient[end.entrance[k].index];
            return double_dot(g, g);
        };
        const double count = double(end.entrance.size()), sum = sum_of(end.entrance.size(), square);
        if (!is_balanced(end) || !(sum > 0)) continue;
        for (std::size_t k = 0; k < end.entrance.size(); ++k)
            places_[place_[end.entrance[k].index]].share = count * square(k) / sum;
    }
}

void VolumeBalance::find_excess(std::span<const double> divergence) {
    FluidParticles& fluid = domain_.fluid;
    const auto is_rest = [&](std::size_t i) { return fluid.opening[i] == 0 && place_[i] == rest; };
    double count = sum_of(fluid.size(), [&](std::size_t i) { return is_rest(i) ? 1.0 : 0.0; });
    double sum = sum_of(fluid.size(), [&](std::size_t i) { return is_rest(i) ? divergence[i] : 0.0; });
    double outflow = 0;   // of the rest
    for (OpenEnd& end : domain_.ends) {
        double flow = end.flow;
        if (is_balanced(end)) {
            flow = flow_of_section(*end.entrance_section, fluid, end.further);
            const double gathered =
                sum_of(end.entrance.size(), [&](std::size_t k) { return divergence[end.entrance[k].index]; });
            end.entrance_excess = (gathered - (end.flow - flow) / cell_) / double(end.entrance.size());
        }
        outflow += flow;
        if (end.imposed_flow) continue;
        for (const auto& m : end.inside)   // beyond where the mean flow is taken from
            if (m.s > -end.section_depth && place_[m.index] == rest) count -= 1, sum -= divergence[m.index];
    }
    if (count > 0)
        fluid.excess_divergence = (sum - outflow / cell_) / count;   // else ends and entrances are all there is
}

}   // namespace patency
