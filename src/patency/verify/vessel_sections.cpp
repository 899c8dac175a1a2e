// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/vessel_sections.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/stages/scene_sampling.h"

namespace patency {

namespace {

constexpr double mm = 1e-3;
constexpr int around = 24;   // places on the wall of a section

nlohmann::json read_json(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw FileError(fmt::format("cannot read {}, the finite-volume solution", path.string()));
    return nlohmann::json::parse(file);
}

VesselSection section_of(const nlohmann::json& s, const std::string& branch) {
    const auto vec = [](const nlohmann::json& v) { return Vec3{v[0], v[1], v[2]}; };
    const double area = mm * mm * s.at("area_mm2").get<double>();
    return {branch,
            mm * s.at("arc_mm").get<double>(),
            {mm * vec(s.at("centre_mm")), vec(s.at("normal")), std::sqrt(area / std::numbers::pi)},
            area,
            s.at("flow_m3_per_s"),
            s.at("mean_pressure_pa"),
            s.at("peak_velocity_m_per_s"),
            s.value("mean_wss_pa", 0.0)};
}

WallRing ring_around(const SectionPlane& plane, const WallHint& wall) {
    const Vec3 a = unit_across(plane.normal), b = cross(plane.normal, a);
    WallRing ring;
    for (int k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * k / around;
        const Vec3 ray = std::cos(angle) * a + std::sin(angle) * b;
        double r = 0;
        for (int step = 0; step < 60; ++step)
            r -= wall.distance(plane.centre + r * ray);   // never farther than the wall is
        ring.places.position.push_back(plane.centre + r * ray);
        ring.places.normal.push_back(wall.normal(ring.places.position.back()));
    }
    for (int k = 0; k < around; ++k) {
        const auto& x = ring.places.position;
        ring.weight.push_back(0.5 * (norm(x[std::size_t((k + 1) % around)] - x[std::size_t(k)]) +
                                     norm(x[std::size_t(k)] - x[std::size_t((k + around - 1) % around)])));
    }
    return ring;
}

}   // namespace

std::vector<VesselSection> read_bifurcation_sections(const std::filesystem::path& reference) {
    const auto json = read_json(reference / "../../reference/coronary_bifurcation/finite_volume_before.json");
    std::vector<VesselSection> sections;
    for (const auto& [branch, list] : json.at("sections").items())
        for (const auto& s : list) sections.push_back(section_of(s, branch));
    return sections;
}

std::vector<VesselSection> read_tree_sections(const std::filesystem::path& reference) {
    const auto json = read_json(reference / "../../reference/left_coronary_tree/finite_volume.json");
    std::vector<VesselSection> sections;
    for (const auto& s : json.at("lesion_sections")) sections.push_back(section_of(s, "lesion"));
    return sections;
}

SectionsMeasure::SectionsMeasure(const Scene& scene, std::vector<VesselSection> sections)
    : sections_(std::move(sections)), hint_(wall_hint(scene)) {
    for (const VesselSection& s : sections_) {
        grids_.push_back(make_section_grid(s.plane, hint_));
        rings_.push_back(ring_around(s.plane, hint_));
    }
    for (const WallRing& ring : rings_) {
        all_.position.insert(all_.position.end(), ring.places.position.begin(), ring.places.position.end());
        all_.normal.insert(all_.normal.end(), ring.places.normal.begin(), ring.places.normal.end());
    }
}

void SectionsMeasure::sample(const Scene& scene) {
    const LocalLength reach = sampling_reach(scene);
    flows_.add(flow_through_sections(scene.fluid, *scene.frame, grids_, reach, hint_), scene.level());
    shear_.add(wall_flow(scene, all_, hint_).shear_stress, 1);
}

void SectionsMeasure::write(RunData& data) const {
    const auto means = flows_.mean();
    const auto shear = shear_.tawss();
    std::size_t first = 0;
    for (std::size_t k = 0; k < sections_.size(); ++k) {
        data.lists["area"].push_back(means[k].area);
        data.lists["flow"].push_back(means[k].flow);
        data.lists["pressure"].push_back(means[k].pressure);
        data.lists["peak"].push_back(means[k].peak_velocity);
        double sum = 0, weight = 0;
        for (int n = 0; n < around; ++n, ++first)
            sum += rings_[k].weight[std::size_t(n)] * shear[first], weight += rings_[k].weight[std::size_t(n)];
        data.lists["wss"].push_back(sum / weight);
    }
}

}   // namespace patency
