// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/bed.h"

#include <gtest/gtest.h>

#include <numbers>

#include "patency/base/errors.h"
#include "patency/config/deck.h"

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

TEST(TuneOutlets, GivesThoseWithoutAValueTheirsAndLeavesTheOthers) {
    deck::Case config = deck_with("flow");
    tune_outlets(config, y);
    const auto through = [&](const char* name) { return (12000 - 600) / config.openings.at(name).resistance.value(); };
    EXPECT_NEAR(through("outlet_1") + through("outlet_2"), 4e-6, 1e-16);
    EXPECT_NEAR(through("outlet_1") / through("outlet_2"), 3.375, 1e-9);
    EXPECT_EQ(config.openings.at("outlet_1").distal_pressure, 600);
    EXPECT_EQ(config.openings.at("outlet_3").resistance, 7e9);
    EXPECT_EQ(config.openings.at("outlet_3").distal_pressure, 0);
}

TEST(TuneOutlets, TheStateTellsTheFlowThroughTheInlet) {
    deck::Case widened = deck_with(""), resting = deck_with("");
    resting.bed.state = deck::BedState::resting;
    tune_outlets(widened, y), tune_outlets(resting, y);
    const double total = (12000 - 600) / widened.openings.at("outlet_1").resistance.value() * (1 + 1 / 3.375);
    EXPECT_NEAR(total / y[0].area, 0.279, 1e-9);
    EXPECT_NEAR(resting.openings.at("outlet_1").resistance.value() / widened.openings.at("outlet_1").resistance.value(),
                0.279 / 0.123, 1e-9);
}

TEST(TuneOutlets, WithoutAnInletTheFlowMustBeGiven) {
    deck::Case config = deck_with("");
    EXPECT_THROW(tune_outlets(config, {y[1], y[2]}), DeckError);
}

}   // namespace
}   // namespace patency
