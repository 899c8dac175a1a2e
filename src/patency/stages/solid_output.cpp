// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/solid_output.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/symmetric_eigen.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// Largest first.
Vec3 principal_stretches(const Mat3& F) {
    const Vec3 squares = symmetric_eigen(transpose(F) * F).values;
    std::array<double, 3> s = {std::sqrt(squares.x), std::sqrt(squares.y), std::sqrt(squares.z)};
    std::sort(s.begin(), s.end(), std::greater<>());
    return {s[0], s[1], s[2]};
}

void append(std::vector<double>& to, const Vec3& v) { to.insert(to.end(), {v.x, v.y, v.z}); }

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json energy_json(const SolidEnergy& e) {
    return {{"kinetic_j", e.kinetic},
            {"elastic_j", e.elastic},
            {"hourglass_j", e.hourglass},
            {"plastic_j", e.plastic},
            {"hourglass_loss_j", e.yielded},
            {"viscous_loss_j", e.viscous},
            {"drag_loss_j", e.drag},
            {"load_work_j", e.load_work},
            {"constraint_work_j", e.constraint_work},
            {"kinetic_to_internal", e.internal() > 0 ? Json(e.kinetic / e.internal()) : Json()}};
}

Json part_json(SolidPart& part) {
    SolidBody& body = *part.body;
    const SolidEnergy energy = body.energy();   // leaves the deformation of where the particles are
    const SolidParticles& p = body.particles();
    const ElasticModuli m = part.solid.materials[0].moduli();
    double stress = 0, strain = 0, farthest = 0, mass = 0, least_volume = INFINITY;
    Vec3 centre{}, momentum{};
    for (std::size_t i = 0; i < p.size(); ++i) {
        stress = std::max(stress, von_mises(body.cauchy(i)));
        strain = std::max(strain, p.plastic_strain[i]);
        farthest = std::max(farthest, norm(p.position[i] - p.reference[i]));
        least_volume = std::min(least_volume, determinant(body.deformation(i)));
        mass += p.mass[i], centre += p.mass[i] * p.position[i], momentum += p.mass[i] * p.velocity[i];
    }
    Json reactions = Json::array();
    for (std::size_t k = 0; k < part.solid.constraints.size(); ++k)
        reactions.push_back(vector_json(body.reaction_impulse(k)));
    return {{"particles", p.size()},
            {"mass_scaling", part.mass_scaling},
            {"neighbours", body.mean_neighbours()},
            {"mass_kg", mass},
            {"young_pa", m.young()},
            {"poisson", m.poisson()},
            {"shear_pa", m.shear},
            {"bulk_pa", m.bulk},
            {"centre_m", vector_json(centre / mass)},
            {"momentum_kg_m_per_s", vector_json(momentum)},
            {"largest_displacement_m", farthest},
            {"largest_von_mises_pa", stress},
            {"largest_plastic_strain", strain},
            {"smallest_volume_ratio", least_volume},
            {"energy", energy_json(energy)},
            {"reaction_impulse_n_s", reactions}};
}

std::string other_of(const deck::ContactDeck& said) {
    if (said.with) return *said.with;
    return std::string(said.tool ? deck::words(said.tool->type)[std::size_t(said.tool->type)] : "plane");
}

}   // namespace

PolyData solid_picture(SolidPart& part) {
    SolidBody& body = *part.body;
    body.compute_deformation();
    const SolidParticles& p = body.particles();
    PolyData data;
    data.points.assign(p.position.begin(), p.position.end());
    PointArray displacement{"displacement", "m", 3}, velocity{"velocity", "m/s", 3}, mises{"von_mises_stress", "Pa", 1},
        stress{"stress", "Pa", 9}, stretches{"principal_stretches", "1", 3}, volume{"volume_ratio", "1", 1},
        plastic{"plastic_strain", "1", 1};
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Mat3 F = body.deformation(i), s = body.cauchy(i);
        append(displacement.values, p.position[i] - p.reference[i]);
        append(velocity.values, p.velocity[i]);
        mises.values.push_back(von_mises(s));
        for (const Vec3& row : {s.x, s.y, s.z}) append(stress.values, row);
        append(stretches.values, principal_stretches(F));
        volume.values.push_back(determinant(F));
        plastic.values.push_back(p.plastic_strain[i]);
    }
    for (PointArray* array : {&displacement, &velocity, &mises, &stress, &stretches, &volume, &plastic})
        data.arrays.push_back(std::move(*array));
    return data;
}

nlohmann::ordered_json solid_summary(SolidScene& scene) {
    Json summary;
    summary["time_s"] = scene.time;
    summary["steps"] = scene.steps;
    Json solids = Json::object(), contacts = Json::array();
    for (auto& part : scene.system.parts) solids[part->name] = part_json(*part);
    for (std::size_t k = 0; k < scene.system.contacts.size(); ++k) {
        const ContactReport r = scene.system.contacts[k]->report();
        const deck::ContactDeck& said = scene.config.contacts[k];
        contacts.push_back({{"solid", said.solid},
                            {"with", other_of(said)},
                            {"force_n", vector_json(r.force)},
                            {"touching_vertices", r.touching},
                            {"largest_penetration_m", r.deepest},
                            {"energy_j", r.energy},
                            {"friction_loss_j", r.friction_loss},
                            {"damping_loss_j", r.damping_loss},
                            {"work_j", r.work},
                            {"normal_force_n", r.normal_force},
                            {"pressure_pa", r.pressure}});
    }
    summary["solids"] = std::move(solids);
    summary["contacts"] = std::move(contacts);
    return summary;
}

}   // namespace patency
