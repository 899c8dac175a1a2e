// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/outlet_summary.h"

#include <nlohmann/json.hpp>

#include "patency/stages/bed.h"

namespace patency {

void add_outlet(nlohmann::ordered_json& opening, const deck::Opening& said, double datum) {
    using deck::OpeningType;
    const bool is_windkessel = said.type == OpeningType::rcr || said.type == OpeningType::coronary;
    if (said.type != OpeningType::resistance && !is_windkessel) return;
    opening["resistance_pa_s_per_m3"] = total_resistance(said);
    opening["distal_pressure_pa"] = said.distal_pressure + datum;
    if (!is_windkessel) return;
    opening["proximal_resistance_pa_s_per_m3"] = said.proximal_resistance;
    opening["compliance_m3_per_pa"] = said.compliance;
    if (said.type == OpeningType::coronary) {
        opening["microvascular_resistance_pa_s_per_m3"] = said.microvascular_resistance;
        opening["myocardial_compliance_m3_per_pa"] = said.myocardial_compliance;
    }
    opening["distal_resistance_pa_s_per_m3"] = said.distal_resistance;
}

}   // namespace patency
