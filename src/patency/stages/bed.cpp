// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/bed.h"

#include <algorithm>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/bed.h"

namespace patency {

double flow_of_bed(deck::BedState state, double inlet_area) {
    return inlet_area * (state == deck::BedState::hyperaemic ? hyperaemic_velocity : resting_velocity);
}

void tune_outlets(deck::Case& config, const std::vector<Opening>& openings) {
    std::vector<deck::Opening*> outlets;
    std::vector<double> diameters;
    double inlet_area = 0;
    for (const Opening& opening : openings) {
        deck::Opening& said = config.openings.at(opening.name);
        if (said.type != deck::OpeningType::resistance || said.resistance) {
            inlet_area = std::max(inlet_area, opening.area);
            continue;
        }
        outlets.push_back(&said), diameters.push_back(2 * opening.radius);
    }
    if (outlets.empty()) return;
    const deck::Bed& bed = config.bed;
    const double flow = bed.flow.value_or(flow_of_bed(bed.state, inlet_area));
    if (!(flow > 0)) throw DeckError("bed.flow: is needed where no opening but tuned outlets lets blood in");
    const auto resistances =
        bed_resistances(diameters, {config.aorta.pressure.value(), bed.venous_pressure, flow, bed.murray_exponent});
    for (std::size_t k = 0; k < outlets.size(); ++k) {
        outlets[k]->resistance = resistances[k];
        outlets[k]->distal_pressure = bed.venous_pressure;
    }
}

}   // namespace patency
