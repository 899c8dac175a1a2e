// SPDX-License-Identifier: Apache-2.0
// What can be read off a balance: openings, walls, the fields between its cells.
#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/cells/point_tree.h"
#include "patency/schemes/cell_balance.h"

namespace patency {

using namespace cell_terms;

std::vector<CellEndState> CellBalance::end_states() const {
    const double scale = fluid_.density * speed_ * speed_;
    std::vector<CellEndState> states;
    for (const End& end : ends_) {
        double pressure = 0, area = 0;
        for (const std::uint32_t k : end.patches) {
            const CellPatch& patch = mesh_.patches[k];
            pressure += norm(patch.area) * state_[patch.cell].p_at(way_to(patch));
            area += norm(patch.area);
        }
        const double mean = end.is_imposed() ? pressure / area : end.pressure;
        states.push_back({end.flow * speed_ / mesh_.depth, level_ + scale * mean});
    }
    return states;
}

std::vector<Vec3> CellBalance::wall_shear_stress() const {
    std::vector<Vec3> stress(mesh_.patches.size());
    if (fluid_.free_slip) return stress;
    for (std::size_t k = 0; k < stress.size(); ++k) {
        const CellPatch& patch = mesh_.patches[k];
        if (patch.opening != CellPatch::wall) continue;
        const CellState& cell = state_[patch.cell];
        const Vec3 slope = wall_slope(cell, way_to(patch), patch.distance);
        const Vec3 along = slope - dot(slope, patch.normal) * patch.normal;
        stress[k] = fluid_.density * speed_ * speed_ * wall_viscosity(cell, patch) * along;
    }
    return stress;
}

std::vector<double> CellBalance::patch_pressure() const {
    std::vector<double> pressure;
    for (const CellPatch& patch : mesh_.patches)
        pressure.push_back(level_ + fluid_.density * speed_ * speed_ * state_[patch.cell].p_at(way_to(patch)));
    return pressure;
}

CellFields CellBalance::fields_at(std::span<const Vec3> places) const {
    // A mean of what the cells around extrapolate: where one cell's word stopped and the next one's began, a finer mesh would
    // see a jump of the pressure, and blow. Of a cell's own slope and the mean of all each counts half, which is exact for a quadratic
    // field: tangents alone lie above a profile everywhere, and eight cells across a pipe would carry 5 % too much.
    constexpr double widths = 1.5;
    const PointTree tree(mesh_.point);
    CellFields fields{std::vector<double>(places.size()), std::vector<Vec3>(places.size())};
    const double largest = *std::max_element(width_.begin(), width_.end());
    for_each_index(places.size(), [&](std::size_t n) {
        const auto distance = [&](std::uint32_t i) { return norm(places[n] - mesh_.point[i]); };
        std::vector<std::uint32_t> found;
        for (double reach = 1e-2 * largest; found.empty(); reach *= 2) tree.find(places[n], reach, found);
        const auto nearest = *std::min_element(found.begin(), found.end(), [&](std::uint32_t a, std::uint32_t b) {
            return distance(a) != distance(b) ? distance(a) < distance(b) : a < b;
        });
        const double reach = std::max(widths * width_[nearest], 1.5 * distance(nearest));
        found.clear();
        tree.find(places[n], reach, found);
        std::sort(found.begin(), found.end());
        double sum = 0, pressure = 0;
        Vec3 velocity{}, lever{}, slope{};
        Mat3 gradient{};
        for (const std::uint32_t i : found) {
            const double q = distance(i) / reach;
            if (q >= 1) continue;
            const double weight = (1 - q) * (1 - q) * (1 - q) * (1 - q) * (1 + 4 * q);
            const Vec3 d = places[n] - mesh_.point[i];
            sum += weight, lever += weight * d;
            pressure += weight * state_[i].p_at(0.5 * d), slope += weight * state_[i].grad_p;
            velocity += weight * state_[i].u_at(0.5 * d), gradient += weight * state_[i].grad_u;
        }
        fields.pressure[n] =
            level_ + fluid_.density * speed_ * speed_ / sum * (pressure + 0.5 / sum * dot(slope, lever));
        fields.velocity[n] = speed_ / sum * (velocity + 0.5 / sum * (gradient * lever));
    });
    return fields;
}

}   // namespace patency
