// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/vessel_recorder.h"

#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/stages/scene_sampling.h"

namespace patency {

namespace {

constexpr double station_distance = 0.5e-3;   // m; half of the shortest lesion's millimetre
constexpr double area_tolerance = 0.1;        // of a section's squares against the surface's own outline

std::vector<Vec3> point_normals(const Surface& surface) {
    std::vector<Vec3> normals(surface.points.size());
    for (const Triangle& t : surface.triangles)
        for (std::uint32_t p : t) normals[p] += area_vector(surface, t);
    for (Vec3& n : normals) n = norm(n) > 0 ? normalized(n) : Vec3{};
    return normals;
}

}   // namespace

std::vector<VesselStation> make_stations(const Vessel& vessel, const LocalLength& spacing) {
    const VesselAlong& along = vessel.along.value();
    std::vector<VesselStation> stations;
    for (std::size_t b = 0; b < along.lines.branches.size(); ++b) {
        const Branch& branch = along.lines.branches[b];
        double next = -1;
        for (std::size_t k = branch.first; k <= branch.last; ++k) {
            const CentrelinePoint& point = along.lines.point(branch, k);
            const CrossSection& section = along.sections[branch.line][k];
            if (!section.is_closed || !section.holds_place || section.is_shared || point.arc < next) continue;
            stations.push_back(
                {b, branch.line, point.arc, {section.place, section.normal, point.radius}, section.area});
            next = point.arc + std::max(station_distance, 2 * spacing(point.place)) * (1 - 1e-9);
        }
    }
    return stations;
}

LumenWall make_lumen_wall(const Vessel& vessel) {
    const Surface& surface = vessel.checked.surface;
    std::vector<char> is_cap(surface.triangles.size(), 0);
    for (const SurfaceOpening& opening : vessel.openings)
        for (std::uint32_t t : opening.triangles) is_cap[t] = 1;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        if (!is_cap[t]) kept.push_back(t);
    LumenWall wall{part_of(surface, kept), {}};
    wall.places = {wall.surface.points, point_normals(wall.surface)};
    return wall;
}

VesselRecorder::VesselRecorder(const Scene& scene)
    : stations_(make_stations(*scene.vessel, [&](const Vec3& x) { return spacing_at(scene, x); })),
      wall_(make_lumen_wall(*scene.vessel)),
      cut_(scene) {
    const WallHint hint = wall_hint(scene);
    grids_.resize(stations_.size());
    for_each_task(stations_.size(), [&](std::size_t k) { grids_[k] = make_section_grid(stations_[k].plane, hint); });
    // A plane that runs into another vessel measures both; so do squares that leak over the edge between two.
    const auto is_own = [&](std::size_t k) {
        return grids_[k].closed && std::abs(grids_[k].total_area() / stations_[k].area - 1) < area_tolerance;
    };
    for (std::size_t k = stations_.size(); k-- > 0;)
        if (!is_own(k)) {
            grids_.erase(grids_.begin() + std::ptrdiff_t(k));
            stations_.erase(stations_.begin() + std::ptrdiff_t(k));
        }
}

void VesselRecorder::sample(const Scene& scene) {
    const WallHint hint = wall_hint(scene);
    const LocalLength reach = sampling_reach(scene);
    flows_.add(flow_through_sections(scene.fluid, *scene.frame, grids_, reach, hint), scene.level());
    const WallFlow at_wall = wall_flow(scene, wall_.places, hint);
    shear_.add(at_wall.shear_stress, 1);
    cut_.sample(scene);
    wall_pressure_.resize(at_wall.pressure.size(), 0);
    for (std::size_t k = 0; k < wall_pressure_.size(); ++k) wall_pressure_[k] += at_wall.pressure[k] + scene.level();
}

std::vector<double> VesselRecorder::wall_pressure() const {
    std::vector<double> mean = wall_pressure_;
    for (double& p : mean) p /= double(instants());
    return mean;
}

void VesselRecorder::restore(const State& state, std::vector<State> finished) {
    flows_.restore(state.flows);
    shear_.restore(state.shear);
    wall_pressure_ = state.pressure;
    cut_.restore(state.cut);
    finished_ = std::move(finished);
}

void VesselRecorder::end_block(std::size_t kept) {
    finished_.push_back(state());
    if (finished_.size() > kept) finished_.erase(finished_.begin(), finished_.end() - std::ptrdiff_t(kept));
    flows_ = {}, shear_ = {};
    wall_pressure_.clear();
    cut_.restore(std::vector<double>(cut_.state().size(), 0.0));
}

void VesselRecorder::join_blocks() {
    State sum = state();   // all of it is sums; what saw no instant has none
    const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
        if (to.size() < from.size()) to.resize(from.size(), 0.0);
        for (std::size_t n = 0; n < from.size(); ++n) to[n] += from[n];
    };
    for (const State& block : finished_)
        add(sum.flows, block.flows), add(sum.shear, block.shear), add(sum.pressure, block.pressure),
            add(sum.cut, block.cut);
    restore(sum);
}

}   // namespace patency
