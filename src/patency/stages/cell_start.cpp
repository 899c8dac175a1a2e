// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/cell_start.h"

#include <cmath>
#include <numbers>

#include "patency/stages/cell_scene.h"

namespace patency {

namespace {

// Cells across every vessel: the flow split is within 1 %, and the solution costs less than the particles' first two windows.
constexpr double cells_across = 8;

}   // namespace

deck::Case case_on_cells(deck::Case config) {
    config.numerics.scheme = deck::SchemeName::cells;
    config.numerics.spacing = 0;
    config.numerics.across = cells_across;
    return config;
}

CellStart::CellStart(const Scene& scene)
    : scene_(scene),
      solved_(make_solved_scene(case_on_cells(scene.config /* pressures less the datum: so are the fields */), {}, {},
                                std::shared_ptr<const Vessel>(std::shared_ptr<void>(), &*scene.vessel))),
      ends_(solved_->balance->end_states()) {}

CellStart::~CellStart() = default;

Vec3 CellStart::within(const Vec3& place) const {
    for (const OpenEnd& end : scene_.ends) {
        const double cell = 2 * std::sqrt(end.area / std::numbers::pi) / cells_across, beyond = end.axial(place) + cell;
        if (beyond > 0 && end.in_reach(place)) return place - beyond * end.normal;
    }
    return place;
}

std::vector<Vec3> CellStart::velocities(std::span<const Vec3> places) const {
    std::vector<Vec3> mean(places.size()), around(places.size());
    for (const Vec3& d : ways_around(scene_.numerics.spacing)) {
        for (std::size_t i = 0; i < places.size(); ++i) around[i] = within(places[i] + d);
        const CellFields fields = solved_->balance->fields_at(around);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (scene_.lumen.distance.value(around[i]) < 0) mean[i] += fields.velocity[i] / 6;   // the wall rests
    }
    return mean;
}

std::vector<double> CellStart::pressures(std::span<const Vec3> places) const {
    return solved_->balance->fields_at(places).pressure;
}

std::size_t CellStart::cells() const { return solved_->mesh.size(); }

}   // namespace patency
