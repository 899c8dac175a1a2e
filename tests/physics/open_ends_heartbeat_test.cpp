// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/heartbeat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/physics/open_ends/outlets.h"

namespace patency {
namespace {

constexpr double mmHg = 133.322387415;
const Heartbeat usual{0.8, 93 * mmHg, 40 * mmHg};

double mean_of(const std::vector<double>& closed) {   // of a table whose last value is its first
    double sum = 0;
    for (std::size_t k = 0; k + 1 < closed.size(); ++k) sum += closed[k];
    return sum / double(closed.size() - 1);
}
double swing_of(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

TEST(Heartbeat, TheAortaHasItsMeanAndItsPulseAtAnyRate) {
    for (const double period : {0.4, 0.6, 0.8, 1.0, 2.0})
        for (const double pulse : {5 * mmHg, 40 * mmHg, 80 * mmHg}) {
            const BeatPressures beat = make_beat({period, 93 * mmHg, pulse});
            EXPECT_NEAR(mean_of(beat.aorta) / (93 * mmHg), 1, 1e-3) << period;
            EXPECT_NEAR(swing_of(beat.aorta) / pulse, 1, 1e-6) << period;
            EXPECT_DOUBLE_EQ(beat.times.back(), period);
            EXPECT_EQ(beat.aorta.front(), beat.aorta.back());
            EXPECT_EQ(beat.ventricle.front(), beat.ventricle.back());
        }
}

TEST(Heartbeat, InDiastoleTheArteriesRunEmptyExponentially) {
    const BeatPressures beat = make_beat(usual);
    // After the ejection, over to the next beat: straight in the logarithm, with the decay's time constant.
    const std::size_t from = 220, to = 400;
    const double slope = std::log(beat.aorta[from] / beat.aorta[to]) / (beat.times[to] - beat.times[from]);
    EXPECT_NEAR(slope * beat.decay, 1, 1e-3);
    EXPECT_NEAR(std::log(beat.aorta[from] / beat.aorta[300]) / (beat.times[300] - beat.times[from]), slope,
                1e-9 * slope);
    // A man's arteries: 1.5 to 2 s at 116 over 76 (Stergiopulos et al. 1999; R C of the three-element Windkessel).
    EXPECT_GT(beat.decay, 1.4);
    EXPECT_LT(beat.decay, 2.2);
}

TEST(Heartbeat, TheMeanLiesAtTwoFifthsOfThePulse) {
    // Of the aorta; a cuff's third is of the arm, where the systolic pressure is higher.
    const BeatPressures beat = make_beat(usual);
    const double least = *std::min_element(beat.aorta.begin(), beat.aorta.end());
    EXPECT_NEAR((usual.mean - least) / usual.pulse, 0.42, 0.03);
}

TEST(Heartbeat, TheVentricleOpensTheValveAndRelaxes) {
    const BeatPressures beat = make_beat(usual);
    const std::size_t opens = 25, closes = 167;   // of 400 instants: 50 ms, and 285 ms of ejection after that
    for (std::size_t k = 0; k < beat.times.size(); ++k)
        EXPECT_LE(beat.ventricle[k], beat.aorta[k] * (1 + 1e-9)) << k;   // no blood comes back
    for (std::size_t k = opens; k <= closes; ++k) EXPECT_DOUBLE_EQ(beat.ventricle[k], beat.aorta[k]) << k;
    EXPECT_LT(beat.ventricle[300], 10 * mmHg);
    EXPECT_NEAR(beat.ventricle.front() / mmHg, 8, 0.01);
}

TEST(Heartbeat, WhatIsNoneIsRefused) {
    EXPECT_THROW(make_beat({0.2, usual.mean, usual.pulse}), DeckError);
    EXPECT_THROW(make_beat({5, usual.mean, usual.pulse}), DeckError);
    EXPECT_THROW(make_beat({0.8, usual.mean, usual.mean}), DeckError);
    EXPECT_THROW(make_beat({0.8, usual.mean, 0}), DeckError);
    EXPECT_THROW(make_beat({NAN, usual.mean, usual.pulse}), DeckError);
}

Waveform waveform(const BeatPressures& beat, const std::vector<double>& values) {
    return make_waveform(beat.times, values, Interpolation::linear, Repeat::periodic, beat.times.back());
}

/// A left coronary bed at rest: 120 mL/min between 93 and 5 mmHg.
Coronary left_bed(const BeatPressures& beat) {
    const CoronaryBed bed;
    const double resistance = 88 * mmHg / 2e-6, compliance = bed.time_at_rest / resistance;
    return {bed.arteries * resistance,     bed.arterial * compliance, bed.small_vessels * resistance,
            bed.myocardial * compliance,   bed.veins * resistance,    5 * mmHg,
            waveform(beat, beat.ventricle)};
}

std::vector<double> flows_of(const OutletModel& model, OutletState& state, const Waveform& pressure, double period) {
    constexpr int steps = 400;
    std::vector<double> flows;
    for (int k = 0; k < steps; ++k) {
        const TimeStep step{k * period / steps, period / steps};
        const OutletResponse answer = step_response(model, state, step);
        flows.push_back((pressure(step.begin + step.length) - answer.p0) / answer.dp_dq);
        state = advanced(model, state, step, flows.back());
    }
    return flows;
}

TEST(PeriodicState, RepeatsAfterOneBeatAndCarriesTheBedsFlow) {
    const BeatPressures beat = make_beat(usual);
    const Waveform aorta = waveform(beat, beat.aorta);
    const double resistance = 88 * mmHg / 2e-6;
    for (const OutletModel& model :
         {OutletModel{left_bed(beat)}, OutletModel{Rcr{0.09 * resistance, 1e-10, 0.91 * resistance, 5 * mmHg}},
          OutletModel{Rcr{0, 1e-10, resistance, 5 * mmHg}}}) {
        const OutletState start = make_periodic_state(model, aorta, usual.period);
        OutletState state = start;
        const std::vector<double> flows = flows_of(model, state, aorta, usual.period);
        EXPECT_NEAR(state[0] / start[0], 1, 1e-9);
        if (std::holds_alternative<Coronary>(model)) {
            EXPECT_NEAR(state[1] / start[1], 1, 1e-9);
        }
        double sum = 0;
        for (const double flow : flows) sum += flow;
        EXPECT_NEAR(sum / double(flows.size()) / 2e-6, 1,
                    2e-3);   // what pulses in a linear bed adds nothing to its mean
    }
    EXPECT_EQ(make_periodic_state(Resistance{1e9, 600}, aorta, usual.period)[0], 600);
}

TEST(PeriodicState, ALeftCoronaryArteryFlowsMostlyInDiastole) {
    const BeatPressures beat = make_beat(usual);
    const Waveform aorta = waveform(beat, beat.aorta);
    const OutletModel bed = left_bed(beat);
    OutletState state = make_periodic_state(bed, aorta, usual.period);
    const std::vector<double> flows = flows_of(bed, state, aorta, usual.period);
    const auto mean_between = [&](std::size_t from, std::size_t to) {
        double sum = 0;
        for (std::size_t k = from; k < to; ++k) sum += flows[k];
        return sum / double(to - from);
    };
    // The mean in diastole over that in systole is 1.8 +- 0.5 in the left anterior descending artery of people without disease
    // (Ofili et al., J Am Coll Cardiol 1993; 21: 308, by a Doppler wire).
    const double ratio = mean_between(168, 400) / mean_between(0, 168);
    EXPECT_GT(ratio, 1.3);
    EXPECT_LT(ratio, 2.3);
}

}   // namespace
}   // namespace patency
