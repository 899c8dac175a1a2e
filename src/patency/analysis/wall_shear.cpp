// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/wall_shear.h"

#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/cells/point_tree.h"
#include "patency/physics/fluid/shear_rate.h"

namespace patency {

WallFlow flow_at_wall(const FluidParticles& fluid, const Frame& frame, const WallPlaces& places,
                      const LocalLength& reach, const WallHint& wall, const std::function<double(double)>& viscosity_at,
                      const Vec3& force) {
    const auto samples = sample_at_wall(fluid, frame, places.position, places.normal, reach, wall, viscosity_at, force);
    WallFlow flow{std::vector<Vec3>(samples.size()), std::vector<double>(samples.size())};
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const Mat3& g = samples[k].velocity_gradient;
        const Vec3& n = places.normal[k];
        if (samples[k].neighbours == 0) {
            flow.shear_stress[k] = {NAN, NAN, NAN}, flow.pressure[k] = NAN;
            continue;
        }
        const double mu = viscosity_at(shear_rate(g));
        const Vec3 traction = -mu * (g * n + transpose(g) * n);   // on the wall, whose outward is the blood's inward
        flow.shear_stress[k] = traction - dot(traction, n) * n;
        flow.pressure[k] = samples[k].pressure;
    }
    return flow;
}

WallFlow flow_of_parts(const WallParts& parts, const WallPlaces& places, const LocalLength& reach) {
    const PointTree tree(parts.places.position);
    WallFlow flow{std::vector<Vec3>(places.position.size(), {NAN, NAN, NAN}),
                  std::vector<double>(places.position.size(), NAN)};
    for_each_index(places.position.size(), [&](std::size_t k) {
        const Vec3 &x = places.position[k], &n = places.normal[k];
        const double radius = reach(x);
        std::vector<std::uint32_t> found;
        tree.find(x, radius, found);
        // Along the wall, in radii, from the weighted middle of the parts: so the mean and the slope come apart.
        const auto weight = [&](std::uint32_t i) {
            const double r = std::min(1.0, norm(parts.places.position[i] - x) / radius), t = 1 - r;
            return dot(parts.places.normal[i], n) > 0 ? parts.area[i] * t * t * t * t * (1 + 4 * r) : 0.0;
        };
        const auto along = [&](const Vec3& d) { return (d - dot(d, n) * n) / radius; };
        double sum = 0, pressure = 0;
        Vec3 middle{}, stress{};
        for (const std::uint32_t i : found) {
            const double w = weight(i);
            sum += w, middle += w * along(parts.places.position[i] - x);
            stress += w * parts.flow.shear_stress[i], pressure += w * parts.flow.pressure[i];
        }
        if (!(sum > 0)) return;
        middle *= 1 / sum, stress *= 1 / sum, pressure /= sum;
        Mat3 moments = sum * outer(n, n), stress_moments{};
        Vec3 pressure_moments{};
        for (const std::uint32_t i : found) {
            const double w = weight(i);
            const Vec3 e = along(parts.places.position[i] - x) - middle;
            moments += w * outer(e, e);
            stress_moments += w * outer(parts.flow.shear_stress[i] - stress, e);
            pressure_moments += w * (parts.flow.pressure[i] - pressure) * e;
        }
        moments += 1e-6 * sum * identity<double>();   // few parts on one line tell no slope across it
        const Vec3 to_place = inverse(moments) * (-1.0 * middle);
        stress += stress_moments * to_place;
        flow.shear_stress[k] = stress - dot(stress, n) * n;
        flow.pressure[k] = pressure + dot(pressure_moments, to_place);
    });
    return flow;
}

void WallShearMeans::add(std::span<const Vec3> stress, double dt) {
    vector_.resize(stress.size()), magnitude_.resize(stress.size());
    for (std::size_t k = 0; k < stress.size(); ++k) {
        vector_[k] += dt * stress[k];
        magnitude_[k] += dt * norm(stress[k]);
    }
    time_ += dt;
}

std::vector<Vec3> WallShearMeans::mean() const {
    std::vector<Vec3> result;
    for (const Vec3& sum : vector_) result.push_back(sum / time_);
    return result;
}

std::vector<double> WallShearMeans::tawss() const {
    std::vector<double> result;
    for (double sum : magnitude_) result.push_back(sum / time_);
    return result;
}

std::vector<double> WallShearMeans::osi() const {
    std::vector<double> result;
    for (std::size_t k = 0; k < vector_.size(); ++k)
        result.push_back(
            magnitude_[k] == 0 ? 0 : 0.5 * (1 - norm(vector_[k]) / magnitude_[k]));   // no stress, no oscillation
    return result;
}

std::vector<double> WallShearMeans::rrt() const {   // (1 - 2 OSI) TAWSS is the magnitude of the mean
    std::vector<double> result;
    constexpr double least = 1e-6;   // Pa: of a wall that slips, or where the mean cancels, a number still
    for (const Vec3& sum : vector_) result.push_back(time_ / std::max(norm(sum), least * time_));
    return result;
}

std::vector<double> WallShearMeans::state() const {
    std::vector<double> state{time_};
    for (std::size_t k = 0; k < vector_.size(); ++k)
        state.insert(state.end(), {vector_[k].x, vector_[k].y, vector_[k].z, magnitude_[k]});
    return state;
}

void WallShearMeans::restore(std::span<const double> state) {
    time_ = state[0];
    vector_.clear(), magnitude_.clear();
    for (std::size_t n = 1; n + 3 < state.size(); n += 4) {
        vector_.push_back({state[n], state[n + 1], state[n + 2]});
        magnitude_.push_back(state[n + 3]);
    }
}

}   // namespace patency
