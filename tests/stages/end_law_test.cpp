// SPDX-License-Identifier: Apache-2.0
// What decks impose at openings: waveforms from files, profiles whose integral is the flow, the moving level.
#include "patency/stages/end_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/stages/waveform_of_deck.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

const Opening tube_inlet{"inlet", {0, 0, 0}, {-1, 0, 0}, std::numbers::pi * 4e-6, 2e-3, 2e-3, false, 2e-6};
const Opening gap_inlet{"inlet", {0, 5e-4, 0}, {-1, 0, 0}, 1e-3, 5e-4, 5e-4, true, 1e-6 / 12};

deck::Opening flow_opening(deck::VelocityProfile profile) {
    deck::Opening said;
    said.type = deck::OpeningType::flow;
    said.profile = profile;
    said.flow = 2e-6;
    if (profile == deck::VelocityProfile::table) said.profile_table = {{0, 0.4, 1}, {3, 2, 0}};
    return said;
}

/// The flow into the domain, by the midpoint rule: error O(1/rings^2).
double flow_through(const Opening& opening, const SectionVelocity& velocity) {
    constexpr int rings = 2000;
    double flow = 0;
    for (int k = 0; k < rings; ++k) {
        const double s = (k + 0.5) / rings, r = s * opening.radius;
        const double area =
            opening.planar ? 2 * opening.radius / rings : 2 * std::numbers::pi * r * opening.radius / rings;
        flow -= area * dot(velocity(opening.centre + Vec3{0, r, 0}), opening.normal);
    }
    return flow;
}

TEST(EndLaw, a_coronary_bed_is_that_of_the_0d_program) {
    // svZeroDSolver's analytic case: resistances of 100, venous pressure 0, a flow of 5: 1500 at the bed (in cgs as here in SI).
    deck::Case config;
    deck::Opening said;
    said.type = deck::OpeningType::coronary;
    said.proximal_resistance = said.microvascular_resistance = said.distal_resistance = 100;
    said.compliance = said.myocardial_compliance = 1e-4;
    said.myocardial_pressure.emplace();
    said.myocardial_pressure->times = {0, 1}, said.myocardial_pressure->values = {0, 0};
    const EndLaw law = make_end_law(tube_inlet, said, config);
    ASSERT_TRUE(law.outlet);
    EXPECT_NEAR(outlet_pressure(*law.outlet, make_steady_state(*law.outlet, 5), 5), 1500, 1e-9);
    EXPECT_EQ(law.state, make_steady_state(*law.outlet, 0));   // at rest
    said.initial_pressure = 80;
    EXPECT_EQ(make_end_law(tube_inlet, said, config).state[0], 80);
}

TEST(EndVelocity, integrates_to_the_flow_whatever_the_profile) {
    deck::Case config;
    config.blood.density = 1060, config.blood.viscosity = 3.5e-3;
    for (const auto profile :
         {deck::VelocityProfile::plug, deck::VelocityProfile::parabola, deck::VelocityProfile::table})
        for (const Opening& opening : {tube_inlet, gap_inlet}) {
            const deck::Opening said = flow_opening(profile);
            const EndLaw law = make_end_law(opening, said, config);
            // Midpoint rule, 2000 intervals: 1e-6 of smooth profiles and of kinks alike.
            EXPECT_NEAR(flow_through(opening, make_end_velocity(opening, said, law, config.blood)(0)), 2e-6,
                        1e-5 * 2e-6)
                << deck::word_of(profile) << (opening.planar ? " gap" : " tube");
        }
}

TEST(EndVelocity, a_womersley_profile_integrates_to_its_waveform_at_all_times) {
    deck::Case config;
    config.blood.density = 1060, config.blood.viscosity = 3.5e-3;
    deck::Opening said = flow_opening(deck::VelocityProfile::womersley);
    said.flow.reset();
    said.waveform.emplace();
    said.waveform->fourier = deck::Fourier{2e-6, 0.8, {1e-6, 0}, {0, 3e-7}};
    const EndLaw law = make_end_law(tube_inlet, said, config);
    const auto velocity = make_end_velocity(tube_inlet, said, law, config.blood);
    for (const double time : {0.0, 0.13, 0.5}) {
        const double w = 2 * std::numbers::pi / 0.8 * time, wanted = 2e-6 + 1e-6 * std::cos(w) + 3e-7 * std::sin(2 * w);
        EXPECT_NEAR(flow_through(tube_inlet, velocity(time)), wanted, 1e-5 * 2e-6) << time;
        EXPECT_NEAR(make_end_flow(tube_inlet, said, law, config.blood)(time), wanted, 1e-9 * 2e-6) << time;
    }
}

TEST(EndVelocity, a_start_in_a_gap_begins_at_rest_and_ends_in_the_parabola) {
    deck::Case config;
    config.blood.density = 1000, config.blood.viscosity = 1e-3;
    deck::Opening said = flow_opening(deck::VelocityProfile::developed_startup);
    const EndLaw law = make_end_law(gap_inlet, said, config);
    const auto velocity = make_end_velocity(gap_inlet, said, law, config.blood);
    const double peak = 1.5 * 2e-6 / 1e-3;
    // The series at time zero is cut after 2000 odd terms that fall as 1/k^3.
    EXPECT_NEAR(velocity(0)(gap_inlet.centre).x, 0, 1e-6 * peak);
    EXPECT_NEAR(velocity(100)(gap_inlet.centre).x, peak, 1e-12 * peak);
    EXPECT_THROW(make_end_velocity(tube_inlet, said, law, config.blood), DeckError);
    const auto flow = make_end_flow(gap_inlet, said, law, config.blood);   // gap^2 / nu is a second
    for (const double time : {0.001, 0.02, 0.1, 0.5})
        EXPECT_NEAR(flow_through(gap_inlet, velocity(time)), flow(time), 1e-5 * 2e-6) << time;
    EXPECT_LT(flow(0.02), 0.3 * 2e-6);
}

TEST(Waveforms, come_from_tables_in_any_unit_or_are_refused) {
    const fs::path file = fs::temp_directory_path() / "patency_end_law_test.csv";
    const auto write = [&](const char* text) { std::ofstream(file) << text; };
    deck::Waveform said;
    said.file = file;
    write("time_ms,flow_mL_per_min\n0,60\n500,120\n1000,60\n");
    deck::Case config;
    config.about.period = 1;
    const Waveform flow = make_signal_waveform(said, config, Dimension::flow, 1);
    EXPECT_NEAR(flow(0.25), 1.5e-6, 1e-20);   // 90 mL/min, half-way
    EXPECT_NEAR(flow(1.25), flow(0.25), 1e-20);
    EXPECT_THROW(make_signal_waveform(said, config, Dimension::pressure, 1), DeckError);
    write("time,flow\n0,60\n1,60\n");
    EXPECT_THROW(make_signal_waveform(said, config, Dimension::flow, 1), DeckError);
    fs::remove(file);
}

EndLaw resistance_law(double resistance, double distal) {
    EndLaw law;
    law.type = deck::OpeningType::resistance;
    law.outlet = Resistance{resistance, distal};
    law.state = law.level_state = {distal, 0};
    return law;
}
EndLaw prescribed_law(deck::OpeningType type, double value) {
    EndLaw law;
    law.type = type;
    law.signal.waveform = make_constant(value);
    return law;
}
constexpr auto moving = deck::PressureReference::moving;

TEST(MovingLevel, is_the_mean_of_prescribed_pressures) {
    std::vector<EndLaw> laws{prescribed_law(deck::OpeningType::pressure, 700),
                             prescribed_law(deck::OpeningType::pressure, 500), resistance_law(1e9, 50)};
    std::vector<OpenEnd> ends(3);
    EXPECT_EQ(impose_laws(laws, ends, 0, 1e-4, moving), 600);
    EXPECT_EQ(ends[0].pressure, 100);
    EXPECT_EQ(ends[1].pressure, -100);
    EXPECT_EQ(impose_laws(laws, ends, 0, 1e-4, deck::PressureReference::fixed), 0);
    EXPECT_EQ(ends[0].pressure, 700);
}

TEST(MovingLevel, is_where_the_outlets_take_up_the_inflow) {
    // p = 100 + 2e9 q_1 = 50 + 1e9 q_2 with q_1 + q_2 = 4e-6: 2766.67 Pa.
    std::vector<EndLaw> laws{prescribed_law(deck::OpeningType::flow, 4e-6), resistance_law(2e9, 100),
                             resistance_law(1e9, 50)};
    std::vector<OpenEnd> ends(3);
    const double level = impose_laws(laws, ends, 0, 1e-4, moving);
    EXPECT_NEAR(level, (4e-6 + 100 / 2e9 + 50 / 1e9) / (1 / 2e9 + 1 / 1e9), 1e-9);
    EXPECT_NEAR(laws[1].level_flow + laws[2].level_flow, 4e-6, 1e-20);
    // It does not follow what the particles do; what the ends impose adds up to what their models want.
    ends[1].flow = 1e-6, ends[2].flow = -3e-6;
    EXPECT_EQ(impose_laws(laws, ends, 1e-4, 1e-4, moving), level);
    EXPECT_NEAR(level + ends[1].pressure + ends[1].resistance * ends[1].flow, 100 + 2e9 * 1e-6, 1e-9);
    EXPECT_NEAR(level + ends[2].pressure + ends[2].resistance * ends[2].flow, 50 - 1e9 * 3e-6, 1e-9);
}

TEST(MovingLevel, charges_a_windkessel_as_its_closed_form) {
    EndLaw outlet;
    outlet.type = deck::OpeningType::rcr;
    outlet.outlet = Rcr{1e8, 1e-10, 1e9, 0};
    std::vector<EndLaw> laws{prescribed_law(deck::OpeningType::flow, 1e-6), outlet};
    std::vector<OpenEnd> ends(2);
    double level = 0, time = 0;
    for (int step = 0; step <= 1000; ++step, time += 1e-4) level = impose_laws(laws, ends, time, 1e-4, moving);
    const double middle = time - 1e-4 + 0.5e-4;   // where the last step's pressure stands
    // p = R_p q + R_d q (1 - e^(-t / (R_d C))), and the update is exact for a constant flow: THEORY (9.3).
    EXPECT_NEAR(level, 100 + 1000 * (1 - std::exp(-middle / 0.1)), 1e-6);
}

}   // namespace
}   // namespace patency
