// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/materials_summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>

#include "patency/stages/solid_material.h"
#include "patency/stages/stent_of_case.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

Json blood_summary(const deck::Blood& blood) {
    Json entry{{"part", "blood"},
               {"what", deck::word_of(blood.law)},
               {"source", "the deck"},
               {"density_kg_per_m3", blood.density}};
    const auto add = [&](std::initializer_list<std::pair<const char*, double>> numbers) {
        for (const auto& [key, value] : numbers) entry[key] = value;
    };
    switch (blood.law) {
        case deck::BloodLaw::newtonian: add({{"viscosity_pa_s", blood.viscosity}}); break;
        case deck::BloodLaw::carreau_yasuda:
            add({{"viscosity_at_rest_pa_s", blood.mu_0},
                 {"viscosity_at_high_rates_pa_s", blood.mu_inf},
                 {"relaxation_time_s", blood.lambda},
                 {"exponent", blood.n},
                 {"yasuda_exponent", blood.a}});
            break;
        case deck::BloodLaw::casson:
            add({{"yield_stress_mpa", 1e-6 * blood.yield_stress}, {"plastic_viscosity_pa_s", blood.plastic_viscosity}});
            break;
        case deck::BloodLaw::power_law: add({{"consistency", blood.consistency}, {"exponent", blood.n}}); break;
    }
    return entry;
}

/// Of the table, or the deck's own; `path` as in the deck.
Json solid_summary(const std::string& part, const deck::SolidMaterialChoice& choice, const std::string& path) {
    const SolidMaterial material = make_solid_material(choice, path);
    const ElasticModuli moduli = material.moduli();
    Json entry{
        {"part", part}, {"what", choice.law ? std::string(deck::word_of(*choice.law)) : ""}, {"source", "the deck"}};
    for (const TableMaterial& known : material_table())
        if (choice.name && known.name == *choice.name) {
            deck::SolidMaterialChoice bare;
            bare.name = choice.name;
            entry["what"] = std::string(known.name) + ": " + std::string(known.what);
            entry["source"] = std::string(known.source) + (choice == bare ? "" : "; with numbers of the deck");
        }
    entry["density_kg_per_m3"] = material.density;
    entry["young_mpa"] = 1e-6 * moduli.young();
    entry["poisson"] = moduli.poisson();
    if (const auto* plastic = std::get_if<J2Plastic>(&material.law)) {
        entry["yield_stress_mpa"] = 1e-6 * plastic->hardening.yield;
        entry["hardening_mpa"] = 1e-6 * plastic->hardening.slope;
    }
    return entry;
}

}   // namespace

Json materials_summary(const deck::Case& config) {
    Json materials = Json::array({blood_summary(config.blood)});
    if (!config.stent || config.deployment.mode == deck::DeploymentMode::geometric) return materials;
    const deck::Wall& wall = config.wall;
    deck::SolidMaterialChoice usual;
    usual.name = wall.law;
    if (wall.plaque == deck::Plaque::fills)
        materials.push_back(solid_summary("plaque", wall.layers.plaque.value_or(usual), "wall.layers.plaque"));
    materials.push_back(solid_summary(wall.layers.adventitia_share > 0 ? "media" : "wall",
                                      wall.layers.media.value_or(usual), "wall.layers.media"));
    if (wall.layers.adventitia_share > 0)
        materials.push_back(
            solid_summary("adventitia", wall.layers.adventitia.value_or(usual), "wall.layers.adventitia"));
    deck::SolidMaterialChoice alloy;
    if (!config.stent->material) alloy.name = alloy_of(*config.stent);
    materials.push_back(solid_summary("stent", config.stent->material.value_or(alloy), "stent.material"));
    return materials;
}

}   // namespace patency
