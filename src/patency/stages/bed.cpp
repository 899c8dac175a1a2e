// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/bed.h"

#include <algorithm>
#include <optional>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/physics/open_ends/heartbeat.h"

namespace patency {

namespace {

deck::Waveform table(const std::vector<double>& times, const std::vector<double>& values) {
    deck::Waveform waveform;
    waveform.times = times, waveform.values = values, waveform.period = times.back();
    return waveform;
}

/// What the aorta gives to a periodic flow; to a steady one its mean, and any time for compliances that it does not feel.
BeatPressures beat_of(const deck::Case& config) {
    const double mean = config.aorta.pressure.value();
    if (config.about.mode == deck::Mode::periodic)
        return make_beat({config.about.period.value(), mean, config.aorta.pulse});
    return {{0, 1}, {mean, mean}, {0, 0}, 1};
}

void tune(deck::Opening& said, double resistance, double resting_resistance, double decay) {
    if (said.type == deck::OpeningType::resistance) said.resistance = resistance;
    if (said.type == deck::OpeningType::rcr) {
        said.proximal_resistance = proximal_share * resistance;
        said.distal_resistance = (1 - proximal_share) * resistance;
        said.compliance = decay / said.distal_resistance;
    }
    if (said.type == deck::OpeningType::coronary) {
        const CoronaryBed bed;
        said.proximal_resistance = bed.arteries * resistance;
        said.microvascular_resistance = bed.small_vessels * resistance;
        said.distal_resistance = bed.veins * resistance;
        const double compliance = bed.time_at_rest / resting_resistance;
        said.compliance = bed.arterial * compliance;
        said.myocardial_compliance = bed.myocardial * compliance;
    }
}

}   // namespace

double flow_of_bed(deck::BedState state, double inlet_area) {
    return inlet_area * (state == deck::BedState::hyperaemic ? hyperaemic_velocity : resting_velocity);
}

double inlet_area(const deck::Case& config, const std::vector<Opening>& openings) {
    double largest = 0;
    for (const Opening& opening : openings)
        if (!config.openings.at(opening.name).is_tuned()) largest = std::max(largest, opening.area);
    return largest;
}

void complete_openings(deck::Case& config, const std::vector<Opening>& openings) {
    std::optional<BeatPressures> beat;
    const auto known_beat = [&]() -> const BeatPressures& { return beat ? *beat : beat.emplace(beat_of(config)); };
    std::vector<deck::Opening*> tuned;
    std::vector<double> diameters;
    for (const Opening& opening : openings) {
        deck::Opening& said = config.openings.at(opening.name);
        if (said.has_aortic_pressure()) {
            if (config.about.mode == deck::Mode::periodic)
                said.waveform = table(known_beat().times, known_beat().aorta);
            else
                said.pressure = config.aorta.pressure;
        }
        if (said.has_muscle_of_aorta()) said.myocardial_pressure = table(known_beat().times, known_beat().ventricle);
        if (said.is_tuned()) tuned.push_back(&said), diameters.push_back(2 * opening.radius);
    }
    if (tuned.empty()) return;
    const deck::Bed& bed = config.bed;
    const double flow = bed.flow.value_or(flow_of_bed(bed.state, inlet_area(config, openings)));
    if (!(flow > 0)) throw DeckError("bed.flow: is needed where no opening but tuned outlets lets blood in");
    const auto resistances =
        bed_resistances(diameters, {config.aorta.pressure.value(), bed.venous_pressure, flow, bed.murray_exponent});
    // Vessels that widen let more through and are about as compliant as before.
    const double widened = bed.state == deck::BedState::hyperaemic ? hyperaemic_velocity / resting_velocity : 1;
    for (std::size_t k = 0; k < tuned.size(); ++k) {
        const bool has_beat = tuned[k]->type == deck::OpeningType::rcr;
        tune(*tuned[k], resistances[k], widened * resistances[k], has_beat ? known_beat().decay : 0);
        tuned[k]->distal_pressure = bed.venous_pressure;
    }
}

double total_resistance(const deck::Opening& outlet) {
    if (outlet.type == deck::OpeningType::resistance) return outlet.resistance.value_or(0);
    return outlet.proximal_resistance + outlet.microvascular_resistance + outlet.distal_resistance;
}

}   // namespace patency
