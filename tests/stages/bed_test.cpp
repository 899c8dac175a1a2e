// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/bed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/stages/end_law.h"

namespace patency {
namespace {

Opening disc(const std::string& name, double diameter) {
    Opening opening{};
    opening.name = name, opening.radius = diameter / 2, opening.area = std::numbers::pi * diameter * diameter / 4;
    return opening;
}
const std::vector<Opening> y{disc("inlet", 4e-3), disc("outlet_1", 3e-3), disc("outlet_2", 2e-3),
                             disc("outlet_3", 2e-3)};

deck::Case deck_with(const std::string& bed) {
    deck::Case config;
    config.aorta.pressure = 12000;
    config.bed.flow = bed.empty() ? std::nullopt : std::optional(4e-6);
    config.bed.venous_pressure = 600;
    config.openings["inlet"].type = deck::OpeningType::pressure;
    for (const char* name : {"outlet_1", "outlet_2"}) config.openings[name].type = deck::OpeningType::resistance;
    config.openings["outlet_3"].type = deck::OpeningType::resistance;
    config.openings["outlet_3"].resistance = 7e9;
    return config;
}

TEST(CompleteOpenings, GivesThoseWithoutAValueTheirsAndLeavesTheOthers) {
    deck::Case config = deck_with("flow");
    complete_openings(config, y);
    const auto through = [&](const char* name) { return (12000 - 600) / config.openings.at(name).resistance.value(); };
    EXPECT_NEAR(through("outlet_1") + through("outlet_2"), 4e-6, 1e-16);
    EXPECT_NEAR(through("outlet_1") / through("outlet_2"), 3.375, 1e-9);
    EXPECT_EQ(config.openings.at("outlet_1").distal_pressure, 600);
    EXPECT_EQ(config.openings.at("outlet_3").resistance, 7e9);
    EXPECT_EQ(config.openings.at("outlet_3").distal_pressure, 0);
}

TEST(CompleteOpenings, TheStateTellsTheFlowThroughTheInlet) {
    deck::Case widened = deck_with(""), resting = deck_with("");
    resting.bed.state = deck::BedState::resting;
    complete_openings(widened, y), complete_openings(resting, y);
    const double total = (12000 - 600) / widened.openings.at("outlet_1").resistance.value() * (1 + 1 / 3.375);
    EXPECT_NEAR(total / y[0].area, 0.279, 1e-9);
    EXPECT_NEAR(resting.openings.at("outlet_1").resistance.value() / widened.openings.at("outlet_1").resistance.value(),
                0.279 / 0.123, 1e-9);
}

TEST(CompleteOpenings, ATunedOutletIsNoInletHoweverLarge) {
    const deck::Case config = deck_with("");
    EXPECT_EQ(inlet_area(config, {disc("inlet", 3e-3), disc("outlet_1", 5e-3), disc("outlet_3", 2e-3)}),
              disc("inlet", 3e-3).area);
    EXPECT_EQ(inlet_area(config, {disc("outlet_1", 5e-3)}), 0);
}

TEST(CompleteOpenings, WithoutAnInletTheFlowMustBeGiven) {
    deck::Case config = deck_with("");
    EXPECT_THROW(complete_openings(config, {y[1], y[2]}), DeckError);
}

deck::Case pulsing(deck::OpeningType outlets) {
    deck::Case config = deck_with("flow");
    config.about.mode = deck::Mode::periodic, config.about.period = 0.8;
    for (const char* name : {"outlet_1", "outlet_2"}) config.openings[name].type = outlets;
    return config;
}

TEST(CompleteOpenings, AnInletWithoutAPressureHasTheAortas) {
    deck::Case steady = deck_with("flow"), periodic = pulsing(deck::OpeningType::resistance);
    complete_openings(steady, y), complete_openings(periodic, y);
    EXPECT_EQ(steady.openings.at("inlet").pressure, 12000);
    const deck::Waveform& pulse = periodic.openings.at("inlet").waveform.value();
    const auto [least, most] = std::minmax_element(pulse.values.begin(), pulse.values.end());
    EXPECT_NEAR(*most - *least, periodic.aorta.pulse, 1);
    EXPECT_EQ(pulse.times.back(), 0.8);
    deck::Case own = pulsing(deck::OpeningType::resistance);
    own.openings["inlet"].pressure = 11000;
    complete_openings(own, y);
    EXPECT_EQ(own.openings.at("inlet").pressure, 11000);
    EXPECT_FALSE(own.openings.at("inlet").waveform);
}

TEST(CompleteOpenings, WhatAnOutletHasInSeriesLetsItsShareThrough) {
    for (const auto type : {deck::OpeningType::rcr, deck::OpeningType::coronary})
        for (const auto mode : {deck::Mode::steady, deck::Mode::periodic}) {
            deck::Case config = pulsing(type);
            config.about.mode = mode;
            complete_openings(config, y);
            const auto through = [&](const char* name) {
                return (12000 - 600) / total_resistance(config.openings.at(name));
            };
            EXPECT_NEAR(through("outlet_1") + through("outlet_2"), 4e-6, 1e-16);
            EXPECT_NEAR(through("outlet_1") / through("outlet_2"), 3.375, 1e-9);
            EXPECT_EQ(config.openings.at("outlet_1").distal_pressure, 600);
            EXPECT_FALSE(config.openings.at("outlet_1").is_tuned());
            EXPECT_GT(config.openings.at("outlet_1").compliance, 0);
        }
}

TEST(CompleteOpenings, ACoronaryBedKeepsItsComplianceWhenItWidens) {
    deck::Case widened = pulsing(deck::OpeningType::coronary), resting = widened;
    resting.bed.state = deck::BedState::resting;
    widened.bed.flow.reset(), resting.bed.flow.reset();
    complete_openings(widened, y), complete_openings(resting, y);
    const deck::Opening &wide = widened.openings.at("outlet_1"), &rest = resting.openings.at("outlet_1");
    EXPECT_NEAR(wide.compliance / rest.compliance, 1, 1e-12);
    EXPECT_NEAR(wide.myocardial_compliance / rest.compliance, 0.89 / 0.11, 1e-9);
    EXPECT_NEAR(total_resistance(rest) / total_resistance(wide), 0.279 / 0.123, 1e-9);
    // 3.6e-10 m^3/Pa behind 1.92 mL/s at rest, of which 88 mmHg are driven here by 11,400 Pa (SimVascular's left coronary artery).
    const double both = rest.compliance + rest.myocardial_compliance + resting.openings.at("outlet_2").compliance +
                        resting.openings.at("outlet_2").myocardial_compliance;
    EXPECT_NEAR(both / (3.6e-10 * (0.123 * y[0].area / 1.92e-6)), 1, 0.1);
}

TEST(CompleteOpenings, TheMusclesPressureIsTheVentricles) {
    deck::Case config = pulsing(deck::OpeningType::coronary);
    complete_openings(config, y);
    const deck::Waveform& muscle = config.openings.at("outlet_1").myocardial_pressure.value();
    EXPECT_NEAR(*std::max_element(muscle.values.begin(), muscle.values.end()),
                *std::max_element(config.openings.at("inlet").waveform->values.begin(),
                                  config.openings.at("inlet").waveform->values.end()),
                1);
    EXPECT_LT(muscle.values.front(), 1200);
}

TEST(CompleteOpenings, BedsBeginInTheBeatOfThePressureThatDrivesThem) {
    deck::Case config = pulsing(deck::OpeningType::rcr);
    complete_openings(config, y);
    const double held = make_end_law(y[1], config.openings.at("outlet_1"), config).state[0];
    EXPECT_GT(held, 12000 - 0.5 * config.aorta.pulse);
    EXPECT_LT(held, 12000);
    deck::Opening& inlet = config.openings["inlet"] = {};
    inlet.type = deck::OpeningType::flow, inlet.flow = 4e-6;   // nobody knows what is in them
    EXPECT_EQ(make_end_law(y[1], config.openings.at("outlet_1"), config).state[0], 600);
}

}   // namespace
}   // namespace patency
