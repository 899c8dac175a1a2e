// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/estimated_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "patency/base/errors.h"

namespace patency {

EstimatedField::EstimatedField(const Vessel& vessel, const Estimate& estimate) {
    const VesselAlong& along = *vessel.along;
    lowest_ = highest_ = estimate.flow.inlet_pressure;
    const double rho = estimate.tree.blood.density,
                 at_inlet = 2 * estimate.flow.flow[0] / estimate.tree.branches[0].area[0];
    for (std::size_t b = 0; b < along.lines.branches.size(); ++b) {
        const Branch& branch = along.lines.branches[b];
        const TreeBranch& tree = estimate.tree.branches[b];
        const auto& pressure = estimate.flow.pressure[b];
        const auto& points = along.lines.lines[branch.line].points;
        const std::size_t first = branch.last + 1 - tree.arc.size();   // a branch begins where its parent ends
        for (std::size_t k = 0; k < tree.arc.size(); ++k) {
            const CentrelinePoint& p = points[first + k];
            const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, tree.arc.size() - 1);
            const double mean = estimate.flow.flow[b] / tree.area[k];
            const double slope = (pressure[after] - pressure[before]) / (tree.arc[after] - tree.arc[before]);
            const bool is_within = first + k > branch.first && first + k < branch.last;
            const double reach = is_within ? 0.5 * (tree.arc[after] - tree.arc[before]) : 0;
            stations_.push_back(
                {b, p.place, p.tangent, p.radius, mean, estimate.flow.profile[b][k], pressure[k], slope, reach});
            // No streamline gains more than its pressure loses (Bernoulli): a jet's profile is flatter than a parabola.
            const double bernoulli =
                std::sqrt(at_inlet * at_inlet + 2 * std::max(0.0, estimate.flow.inlet_pressure - pressure[k]) / rho);
            largest_speed_ = std::max(largest_speed_, std::min(2 * std::abs(mean), bernoulli));
            lowest_ = std::min(lowest_, pressure[k]), highest_ = std::max(highest_, pressure[k]);
        }
    }

    Vec3 high{-1e9, -1e9, -1e9};
    low_ = {1e9, 1e9, 1e9};
    for (const Station& s : stations_) {
        low_ = {std::min(low_.x, s.place.x), std::min(low_.y, s.place.y), std::min(low_.z, s.place.z)};
        high = {std::max(high.x, s.place.x), std::max(high.y, s.place.y), std::max(high.z, s.place.z)};
        box_ = std::max(box_, 2 * s.radius);
    }
    boxes_ = box_of(high);
    for (long& n : boxes_) ++n;
    inside_.resize(std::size_t(boxes_[0] * boxes_[1] * boxes_[2]));
    for (std::size_t n = 0; n < stations_.size(); ++n) {
        const auto [i, j, k] = box_of(stations_[n].place);
        inside_[std::size_t(i + boxes_[0] * (j + boxes_[1] * k))].push_back(std::uint32_t(n));
    }
}

std::array<long, 3> EstimatedField::box_of(const Vec3& x) const {
    const Vec3 e = (1 / box_) * (x - low_);
    return {long(std::floor(e.x)), long(std::floor(e.y)), long(std::floor(e.z))};
}

/// visit(station) for all that lie within a box of x; for all there are where there are none.
template <class Visit>
void EstimatedField::for_each_near(const Vec3& x, Visit visit) const {
    const auto [i, j, k] = box_of(x);
    bool is_any = false;
    for (long c = std::max(0L, k - 1); c <= std::min(boxes_[2] - 1, k + 1); ++c)
        for (long b = std::max(0L, j - 1); b <= std::min(boxes_[1] - 1, j + 1); ++b)
            for (long a = std::max(0L, i - 1); a <= std::min(boxes_[0] - 1, i + 1); ++a)
                for (std::uint32_t n : inside_[std::size_t(a + boxes_[0] * (b + boxes_[1] * c))])
                    visit(n), is_any = true;
    if (is_any) return;
    for (std::size_t n = 0; n < stations_.size(); ++n) visit(n);
}

// Which branch is told by the power of the place to the spheres: where two tubes meet, the plane through the circle in which they
// cut each other is the border between them, whatever their widths. Within the branch the nearest station counts: by power, a
// tapering vessel would answer with its wider side.
std::size_t EstimatedField::nearest(const Vec3& x) const {
    const auto least_of = [&](auto distance) {
        std::size_t found = 0;
        double least = std::numeric_limits<double>::infinity();
        for_each_near(x, [&](std::size_t n) {
            const double d = distance(stations_[n]);
            if (d < least) least = d, found = n;
        });
        return found;
    };
    const auto square = [&](const Station& s) { return dot(x - s.place, x - s.place); };
    const std::size_t branch =
        stations_[least_of([&](const Station& s) { return square(s) - s.radius * s.radius; })].branch;
    return least_of(
        [&](const Station& s) { return s.branch == branch ? square(s) : std::numeric_limits<double>::infinity(); });
}

std::vector<double> EstimatedField::carried(std::span<const Vec3> places, std::span<const Vec3> velocities,
                                            double volume) const {
    std::vector<double> flow, length;
    for (const Station& s : stations_) {
        flow.resize(std::max(flow.size(), s.branch + 1)), length.resize(flow.size());
        length[s.branch] += s.reach;
    }
    for (std::size_t i = 0; i < places.size(); ++i)
        if (const Station& s = stations_[nearest(places[i])]; s.reach > 0)
            flow[s.branch] += volume * dot(velocities[i], s.tangent);
    for (std::size_t b = 0; b < flow.size(); ++b) flow[b] = length[b] > 0 ? flow[b] / length[b] : 0;
    return flow;
}

EstimatedField::Value EstimatedField::at(const Vec3& x, double depth) const {
    const Station& s = stations_[nearest(x)];
    const double share = 1 - std::clamp(depth / s.radius, 0.0, 1.0);   // 1 at the wall
    // The place may lie between two stations: their pressures join.
    const double ahead = dot(x - s.place, s.tangent);
    const double reach = 0.5 * s.radius;   // stations are no farther apart
    return {s.mean_velocity * s.profile.at(share) * s.tangent, s.pressure + std::clamp(ahead, -reach, reach) * s.slope,
            std::abs(ahead) < reach ? s.slope * s.tangent : Vec3{}};
}

}   // namespace patency
