// SPDX-License-Identifier: Apache-2.0
// From a deck to a steady flow on cells and its summary.
#include "patency/stages/cell_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/stages/cell_flow.h"
#include "patency/stages/cell_plan.h"

namespace patency {
namespace {

constexpr double radius = 1e-3, length = 6e-3, speed = 0.05, mu = 3.5e-3;
constexpr double flow = std::numbers::pi * radius * radius * speed;

deck::Case tube(const std::string& openings, const std::string& more = "", const std::string& scheme = "cells") {
    return deck::parse_case(R"(version: 1
case: {name: tube}
geometry: {shape: {type: tube, diameter: "2 mm", length: "6 mm", axis: [1, 2, -0.5]}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings: {)" + openings + R"(}
numerics: {scheme: )" + scheme +
                            R"(, spacing: "0.2 mm", duration: "1 s"}
)" + more);
}
const std::string inflow = R"(inlet: {type: velocity, profile: parabola, velocity: "0.05 m/s"})";

TEST(CellScene, flowsAsTheDeckSays) {
    const auto scene = make_solved_scene(
        tube(inflow + R"(, outlet: {type: resistance, resistance: "2e8 Pa s/m^3", distal_pressure: "10 Pa"})"));
    ASSERT_TRUE(scene->solution.is_converged);
    const nlohmann::ordered_json summary = make_cell_summary(*scene);
    EXPECT_EQ(summary["scheme"], "cells");
    const auto& inlet = summary["openings"]["inlet"];
    const auto& outlet = summary["openings"]["outlet"];
    EXPECT_NEAR(inlet["flow_m3_per_s"], -flow, 1e-12 * flow);
    EXPECT_NEAR(outlet["flow_m3_per_s"], flow, 1e-6 * flow);
    EXPECT_NEAR(outlet["mean_pressure_pa"], 10 + 2e8 * flow, 1e-5);
    EXPECT_NEAR(outlet["mean_pressure_pa"], 10 + 2e8 * double(outlet["flow_m3_per_s"]),
                1e-8);   // its model's, of what leaves there
    EXPECT_NEAR(outlet["resistance_pa_s_per_m3"], 2e8, 1);
    const double drop = 8 * mu * speed * length / (radius * radius);
    EXPECT_NEAR((double(inlet["mean_pressure_pa"]) - double(outlet["mean_pressure_pa"])) / drop, 1, 0.02);
    EXPECT_LT(summary["mass_imbalance_percent"], 1e-4);
    EXPECT_NEAR(double(summary["largest_speed_m_per_s"]) / (2 * speed), 1, 0.03);
}

// What is read between ten cells across carries what flows: tangents of a profile alone would carry 2.5 % more.
TEST(CellScene, FieldsBetweenCellsCarryTheFlow) {
    const auto scene = make_solved_scene(tube(inflow + R"(, outlet: {type: pressure, pressure: "0 Pa"})"));
    const Opening &first = scene->lumen.openings[0], &last = scene->lumen.openings[1];
    const Vec3 middle = 0.5 * (first.centre + last.centre), along = last.normal;
    const Vec3 up = cross(along, Vec3{0, 0, 1}) / norm(cross(along, Vec3{0, 0, 1})), aside = cross(along, up);
    constexpr int rings = 40, spokes = 24;
    std::vector<Vec3> places;
    std::vector<double> areas;
    for (int k = 0; k < rings; ++k)
        for (int a = 0; a < spokes; ++a) {
            const double r = (k + 0.5) / rings * radius, angle = 2 * std::numbers::pi * a / spokes;
            places.push_back(middle + r * std::cos(angle) * up + r * std::sin(angle) * aside);
            areas.push_back(2 * std::numbers::pi * r * radius / rings / spokes);
        }
    const CellFields fields = scene->balance->fields_at(places);
    double carried = 0, pressure = 0;
    for (std::size_t n = 0; n < places.size(); ++n)
        carried += areas[n] * dot(fields.velocity[n], along), pressure += areas[n] * fields.pressure[n];
    EXPECT_NEAR(carried / flow, 1, 0.01);
    EXPECT_NEAR(pressure / (std::numbers::pi * radius * radius) / (4 * mu * speed * length / (radius * radius)), 1,
                0.02);   // half of the drop
}

TEST(CellScene, SaysWhatItLooksLikeWhereItDiverged) {
    const auto spoil = [](const CellScene& now) {
        CellFields fields = now.balance->fields();
        fields.pressure[0] = NAN;
        now.balance->set_fields(fields);
        return false;
    };
    std::size_t cells = 0;
    const auto remains = [&](const CellScene& lost) {
        cells = lost.mesh.size();
        return std::string("; cell 0 is no number");
    };
    try {
        make_solved_scene(tube(inflow + R"(, outlet: {type: pressure, pressure: "0 Pa"})"), spoil, remains);
        ADD_FAILURE();
    } catch (const DivergedError& error) {
        EXPECT_NE(std::string(error.what()).find("lost its numbers after"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("; cell 0 is no number"), std::string::npos) << error.what();
    }
    EXPECT_GT(cells, 100u);
}

// A bed a hundred thousand times as stiff as the tube: the level of the pressure is all its flow's.
TEST(CellScene, flowsIntoABedThatIsStiff) {
    const auto scene = make_solved_scene(
        tube(inflow + R"(, outlet: {type: resistance, resistance: "2e10 Pa s/m^3", distal_pressure: "5 mmHg"})"));
    ASSERT_TRUE(scene->solution.is_converged);
    EXPECT_LT(scene->solution.history.size(), 100u);
    const auto ends = scene->balance->end_states();
    EXPECT_NEAR(ends[1].pressure, 5 * 133.322 + 2e10 * flow, 1e-3 * 2e10 * flow);
    EXPECT_NEAR((ends[0].pressure - ends[1].pressure) / (8 * mu * speed * length / (radius * radius)), 1, 0.02);
}

// What leaves by a prescribed flow finds its own profile; what enters by a pressure is a developed one.
TEST(CellScene, isDrawnThroughAsItIsDrivenThrough) {
    const auto scene = make_solved_scene(
        tube(R"(inlet: {type: pressure, pressure: "50 Pa"}, outlet: {type: flow, flow: "-9.42477796 mL/min"})"));
    const auto ends = scene->balance->end_states();
    EXPECT_NEAR(ends[1].flow, flow, 1e-6 * flow);
    EXPECT_NEAR(ends[0].flow, -flow, 1e-6 * flow);
    EXPECT_NEAR((50 - ends[1].pressure) / (8 * mu * speed * length / (radius * radius)), 1, 0.02);
}

TEST(CellScene, takesAWindkesselForItsResistances) {
    const auto scene = make_solved_scene(tube(inflow + R"(, outlet: {type: rcr, proximal_resistance: "1e8 Pa s/m^3",
  distal_resistance: "3e8 Pa s/m^3", compliance: "1e-10 m^3/Pa", distal_pressure: "7 Pa"})"));
    EXPECT_NEAR(scene->balance->end_states()[1].pressure, 7 + 4e8 * flow, 1e-4);
}

// As a coronary artery is: the pressure stands in the inlet, and the bed behind decides what flows. 93 mmHg are two hundred times
// what the stream's own weight would give.
TEST(CellScene, standsAnAorticPressureInFrontOfABed) {
    const auto scene = make_solved_scene(tube(R"(inlet: {type: pressure, pressure: "93 mmHg"},
  outlet: {type: resistance, resistance: "5e10 Pa s/m^3", distal_pressure: "5 mmHg"})"));
    const double aorta = 93 * 133.322368, veins = 5 * 133.322368;
    const double resistance = 8 * mu * length / (std::numbers::pi * std::pow(radius, 4));
    const double expected = (aorta - veins) / (5e10 + resistance);
    const auto ends = scene->balance->end_states();
    EXPECT_NEAR(ends[1].flow / expected, 1, 1e-3);
    EXPECT_NEAR(ends[0].flow / expected, -1, 1e-3);
    EXPECT_NEAR(ends[0].pressure, aorta, 0.02 * resistance * expected);
    EXPECT_NEAR((ends[0].pressure - ends[1].pressure) / (resistance * expected), 1, 0.03);
}

// The flow in a narrowing cone is nearly Poiseuille's of each place.
TEST(CellScene, canFollowTheVessel) {
    const deck::Case config = deck::parse_case(R"(version: 1
case: {name: cone}
geometry: {shape: {type: cone, diameters: ["4 mm", "1.6 mm"], length: "30 mm", axis: [1, 2, -0.5]}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
openings: {inlet: {type: flow, flow: "0.6 mL/min", profile: parabola}, outlet: {type: pressure, pressure: "0 Pa"}}
numerics: {scheme: cells, across: 12, duration: "1 s"}
)");
    const auto scene = make_solved_scene(config);
    const nlohmann::ordered_json summary = make_cell_summary(*scene);
    EXPECT_NEAR(double(summary["spacing_m"]) / (1.6e-3 / 12), 1, 0.1);
    EXPECT_NEAR(double(summary["largest_spacing_m"]) / (4e-3 / 12), 1, 0.1);
    EXPECT_NEAR(double(summary["particles"]["across_narrowest"]), 12, 1.2);
    const double a = 2e-3, b = 0.8e-3, q = 1e-8, along = 30e-3;
    const double drop = 8 * mu * q / std::numbers::pi * along / (3 * (a - b)) * (1 / (b * b * b) - 1 / (a * a * a));
    EXPECT_NEAR(scene->balance->end_states()[0].pressure / drop, 1, 0.03) << "1.5 % of it is the cone's slope";
    const CellPlan plan = plan_cells(config, 1);
    EXPECT_NEAR(plan.cells / double(scene->mesh.size()), 1, 0.05);
    EXPECT_NEAR(plan.across_narrowest, 12, 0.01);
}

TEST(CellScene, refusesWhatIsNotSteady) {
    const std::string out = R"(, outlet: {type: pressure, pressure: "0 Pa"})";
    EXPECT_NO_THROW(make_cell_lumen(tube(inflow + out)));
    EXPECT_THROW(make_cell_lumen(tube(inflow + out, "body_force: [\"1 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]\n")),
                 DeckError);
    const std::string wave =
        R"(inlet: {type: velocity, waveform: {times: ["0 s", "1 s"], values: ["0.1 m/s", "0.1 m/s"], period: "1 s"}})";
    EXPECT_THROW(make_cell_lumen(tube(wave + out)), DeckError);
}

TEST(CellScene, stopsWhenItIsAskedTo) {
    int asked = 0;
    const auto scene = make_solved_scene(tube(inflow + R"(, outlet: {type: pressure, pressure: "0 Pa"})"),
                                         [&](const CellScene&) { return ++asked == 3; });
    EXPECT_FALSE(scene->solution.is_converged);
    EXPECT_EQ(asked, 3);
}

}   // namespace
}   // namespace patency
