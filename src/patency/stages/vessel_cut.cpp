// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/vessel_cut.h"

#include <algorithm>
#include <cmath>

#include "patency/io/vtp.h"
#include "patency/stages/scene_sampling.h"

namespace patency {

namespace {

constexpr int across = 17;   // places of a row

/// From a place within the lumen to its wall along a direction.
double way_to_wall(const SignedDistance& distance, const Vec3& from, const Vec3& direction, double longest) {
    double way = 0;
    for (int step = 0; step < 60 && way < longest; ++step) {
        const double left = -distance.value(from + way * direction);   // no wall is nearer
        way += left;
        if (left < 1e-4 * longest) break;
    }
    return std::min(way, longest);
}

}   // namespace

VesselCut::VesselCut(const Scene& scene) : space_(scene.vessel->checked.surface.space) {
    const BranchedLines& lines = scene.vessel->along->lines;
    const Vec3 plane = normal_of(lines);
    constexpr double widest = 3;   // radii: beyond, a row runs into another vessel
    for (const Branch& branch : lines.branches) {
        const auto& points = lines.lines[branch.line].points;
        // From where it parts from its parent, so that no gap is left.
        const std::size_t first = branch.parent < 0 ? branch.first : lines.branches[std::size_t(branch.parent)].last;
        double next = -1;
        Vec3 side{};
        bool is_first_row = true;
        for (std::size_t k = first; k <= branch.last; ++k) {
            const CentrelinePoint& p = points[k];
            if (p.arc < next && k != branch.last) continue;
            next = p.arc + spacing_at(scene, p.place) * (1 - 1e-9);
            const Vec3 sideways = cross(plane, p.tangent);
            if (norm(sideways) > 0.1)
                side = normalized(sideways);   // else the branch leaves the plane: keep the last
            else if (norm(side) == 0)
                side = normalized(cross(Vec3{p.tangent.y, p.tangent.z, p.tangent.x}, p.tangent));
            const double left = way_to_wall(scene.lumen.distance, p.place, -side, widest * p.radius),
                         right = way_to_wall(scene.lumen.distance, p.place, side, widest * p.radius);
            const auto base = std::uint32_t(places_.size());
            for (int n = 0; n < across; ++n)
                places_.push_back(p.place + (n * (left + right) / (across - 1) - left) * side);
            for (std::uint32_t n = 0; !is_first_row && n + 1 < across; ++n) {
                const std::uint32_t a = base - across + n, b = base + n;
                triangles_.push_back({a, a + 1, b}), triangles_.push_back({a + 1, b + 1, b});
            }
            is_first_row = false;
        }
    }
    velocity_.resize(places_.size()), pressure_.resize(places_.size()), squares_.resize(places_.size());
}

void VesselCut::sample(const Scene& scene) {
    const WallHint hint = wall_hint(scene);
    const auto samples = sample_flow(scene.fluid, *scene.frame, places_, sampling_reach(scene), false, &hint);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        velocity_[k] += samples[k].velocity;
        pressure_[k] += samples[k].pressure + scene.level();
        squares_[k] += dot(samples[k].velocity, samples[k].velocity);
    }
    instants_ += 1;
}

void VesselCut::write(const std::filesystem::path& path) const {
    PolyData data{.points = places_, .triangles = triangles_, .space = space_};
    PointArray velocity{"velocity", "m/s", 3}, pressure{"pressure", "Pa"}, swing{"speed_deviation", "m/s"},
        seen{"is_resolved", "1"};
    for (std::size_t k = 0; k < places_.size(); ++k) {
        const Vec3 v = velocity_[k] / instants_;
        const double p = pressure_[k] / instants_;
        const bool is_seen = std::isfinite(p + norm(v));   // else no blood was near
        const Vec3 shown = is_seen ? v : Vec3{};
        velocity.values.insert(velocity.values.end(), {shown.x, shown.y, shown.z});
        pressure.values.push_back(is_seen ? p : 0);
        swing.values.push_back(is_seen ? std::sqrt(std::max(0.0, squares_[k] / instants_ - dot(v, v))) : 0);
        seen.values.push_back(is_seen);
    }
    data.arrays = {velocity, pressure, swing, seen};
    write_polydata(path, data);
}

std::vector<double> VesselCut::state() const {
    std::vector<double> state{instants_};
    for (std::size_t k = 0; k < places_.size(); ++k)
        state.insert(state.end(), {velocity_[k].x, velocity_[k].y, velocity_[k].z, pressure_[k], squares_[k]});
    return state;
}

void VesselCut::restore(const std::vector<double>& state) {
    instants_ = state.at(0);
    for (std::size_t k = 0; k < places_.size(); ++k) {
        const double* s = &state.at(1 + 5 * k);
        velocity_[k] = {s[0], s[1], s[2]}, pressure_[k] = s[3], squares_[k] = s[4];
    }
}

}   // namespace patency
