// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_state.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/bodies/stent_skin.h"
#include "patency/bodies/vessel_wall.h"
#include "patency/physics/solid/strain.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

std::vector<double> von_mises_of(SolidPart& part) {
    part.body->compute_deformation();
    std::vector<double> stress(part.body->particles().size());
    for (std::size_t i = 0; i < stress.size(); ++i) stress[i] = von_mises(part.body->cauchy(i));
    return stress;
}

bool yields(const SolidMaterial& material) { return std::holds_alternative<J2Plastic>(material.law); }

bool yields(const SolidPart& part) {
    const auto& materials = part.body->solid().materials;
    return std::any_of(materials.begin(), materials.end(), [](const SolidMaterial& m) { return yields(m); });
}

/// What both bodies' surfaces show.
PolyData skin_of(SolidPart& part) {
    SolidSurface& surface = *part.surface;
    surface.follow(part.body->particles());
    PolyData data;
    data.points = surface.position;
    data.triangles = surface.mesh().elements;
    PointArray displacement{"displacement", "m", 3},
        stress{"von_mises_stress", "Pa", 1, surface.carried(von_mises_of(part))};
    for (std::size_t v = 0; v < surface.size(); ++v) {
        const Vec3 u = surface.position[v] - surface.mesh().vertices[v];
        displacement.values.insert(displacement.values.end(), {u.x, u.y, u.z});
    }
    for (double& s : stress.values) s = std::max(0.0, s);   // a linear fit may go below
    data.arrays = {std::move(displacement), std::move(stress)};
    if (yields(part)) {
        const SolidParticles& p = part.body->particles();
        PointArray strain{"plastic_strain", "1", 1,
                          surface.carried({p.plastic_strain.begin(), p.plastic_strain.end()})};
        for (double& s : strain.values) s = std::max(0.0, s);
        data.arrays.push_back(std::move(strain));
    }
    return data;
}

Json percentiles(const std::vector<double>& values, const std::vector<double>& weights) {
    return {{"p50", weighted_percentile(values, weights, 0.50)},
            {"p95", weighted_percentile(values, weights, 0.95)},
            {"p99", weighted_percentile(values, weights, 0.99)},
            {"largest", values.empty() ? 0.0 : *std::max_element(values.begin(), values.end())}};
}

}   // namespace

OuterFaces outer_faces_of(const SolidPart& stent) {
    const SolidSurface& surface = *stent.surface;
    const SurfaceElements& mesh = surface.mesh();
    OuterFaces faces;
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        if (mesh.face[e] != stent_outer) continue;
        const auto& [a, b, c] = mesh.elements[e];
        const Vec3 &x = surface.position[a], &y = surface.position[b], &z = surface.position[c];
        faces.places.push_back((x + y + z) / 3);
        faces.areas.push_back(0.5 * norm(cross(y - x, z - x)));
    }
    return faces;
}

BodyEnergy energy_of(SolidPart& part) {
    const SolidEnergy e = part.body->energy();
    return {e.kinetic, e.internal(), e.plastic};
}

PolyData stent_picture(SolidPart& stent, const SignedDistance* lumen) {
    PolyData data = skin_of(stent);
    if (lumen) {
        PointArray gap{"gap", "m", 1, std::vector<double>(data.points.size())};
        for (std::size_t v = 0; v < data.points.size(); ++v) gap.values[v] = -lumen->value(data.points[v]);
        data.arrays.push_back(std::move(gap));
    }
    return data;
}

PolyData wall_picture(SolidPart& wall) { return skin_of(wall); }

nlohmann::ordered_json energies_json(SolidSystem& system, const ContactAccount& contacts, bool is_all_by_tools) {
    double kept = contacts.stored + contacts.friction + contacts.damping;
    nlohmann::ordered_json energies = {{"tool_work_j", contacts.work},
                                       {"friction_loss_j", contacts.friction},
                                       {"contact_damping_loss_j", contacts.damping}};
    for (const auto& part : system.parts) {
        const SolidEnergy e = part->body->energy();
        energies[part->name] = {{"kinetic_j", e.kinetic},        {"elastic_j", e.elastic},
                                {"plastic_j", e.plastic},        {"hourglass_j", e.hourglass},
                                {"hourglass_loss_j", e.yielded}, {"viscous_loss_j", e.viscous},
                                {"drag_loss_j", e.drag}};
        kept += e.kinetic + e.internal() + e.lost();
    }
    if (is_all_by_tools && contacts.work > 0)
        energies["imbalance_percent"] = 100 * std::abs(contacts.work - kept) / contacts.work;
    return energies;
}

Json stresses_json(SolidPart& stent, SolidPart& wall, const StentAxis& axis, double length,
                   const std::vector<Contact::Push>& pushes, double patch) {
    const std::vector<double> wall_stress = von_mises_of(wall);
    const SolidParticles& w = wall.body->particles();
    Json layers = Json::object(), strains = Json::object();
    for (const WallLayer layer : {WallLayer::plaque, WallLayer::media, WallLayer::adventitia}) {
        std::vector<double> stress, strain, volume;
        for (std::size_t i = 0; i < w.size(); ++i)
            if (w.material[i] == std::int32_t(layer) && std::abs(axis.coordinates(w.position[i]).along) < length / 2)
                stress.push_back(wall_stress[i]), strain.push_back(w.plastic_strain[i]), volume.push_back(w.volume[i]);
        if (stress.empty()) continue;
        layers[std::string(name_of(layer))] = percentiles(stress, volume);
        if (yields(wall.body->solid().materials[std::size_t(layer)]))
            strains[std::string(name_of(layer))] = percentiles(strain, volume);
    }
    const SolidParticles& s = stent.body->particles();
    const std::vector<double> volume(s.volume.begin(), s.volume.end());
    std::vector<PressedPlace> presses;
    std::size_t piece = StentAxis::unseen;
    for (const auto& [vertex, force] : pushes) {
        const Vec3& x = stent.surface->position[vertex];
        presses.push_back({x, -dot(force, axis.sight(x, piece = StentAxis::unseen).outward)});
    }
    const OuterFaces outer = outer_faces_of(stent);
    std::vector<double> pressure, area;
    const std::vector<double> pressures = pressures_on(outer.places, outer.areas, presses, patch);
    for (std::size_t k = 0; k < pressures.size(); ++k)
        if (pressures[k] > 0) pressure.push_back(pressures[k]), area.push_back(outer.areas[k]);
    return {{"wall_von_mises_pa", layers},
            {"wall_plastic_strain", strains},
            {"stent_von_mises_pa", percentiles(von_mises_of(stent), volume)},
            {"plastic_strain", percentiles({s.plastic_strain.begin(), s.plastic_strain.end()}, volume)},
            {"contact_pressure_pa", percentiles(pressure, area)}};
}

}   // namespace patency
