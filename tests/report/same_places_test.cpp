// SPDX-License-Identifier: Apache-2.0
#include "patency/report/same_places.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

/// Two lines that part at 20 mm: the flow there is 3, then 1 to the first outlet and 2 to the second. Pressure falls by `slope` Pa per mm
/// on the second line and not at all on the first.
CsvTable pullback(double slope) {
    CsvTable table{{"arc_m", "outlet", "flow_m3_per_s", "pressure_pa", "mean_velocity_m_per_s", "ffr"},
                   std::vector<std::vector<double>>(6)};
    for (const double outlet : {1.0, 2.0})
        for (int mm = 0; mm <= 60; mm += 2) {
            const double p = outlet == 2 ? 1000 - slope * mm : 1000;
            const double row[] = {1e-3 * mm, outlet, mm < 20 ? 3e-6 : outlet * 1e-6, p, 0.01 * mm, p / 1000};
            for (std::size_t c = 0; c < 6; ++c) table.columns[c].push_back(row[c]);
        }
    return table;
}

Json before() {
    return {{"lesions",
             {{{"branch", "b"},
               {"throat_arc_mm", 31.0},
               {"length_mm", 8.0},
               {"read_arc_mm", 50.0},
               {"flow_m3_per_s", 2e-6}}}}};
}
const Json after = {{"openings",
                     {{"inlet", {{"mean_pressure_pa", 1000.0}}},
                      {"outlet_1", {{"mean_pressure_pa", 900.0}}},
                      {"outlet_2", {{"mean_pressure_pa", 400.0}}}}}};

TEST(SamePlaces, TheLineIsTheOneWithTheLesionsFlow) {
    EXPECT_EQ(outlet_through(pullback(10), before()["lesions"][0]), 2);
    Json other = before()["lesions"][0];
    other["flow_m3_per_s"] = 1e-6;
    EXPECT_EQ(outlet_through(pullback(10), other), 1);
}

/// Everything is linear in the arc, so that interpolation is exact.
TEST(SamePlaces, ReadsTheTreatedFlowWhereTheLesionWas) {
    const Json place = at_lesions_of(before(), pullback(10), after, pullback(4))[0];
    EXPECT_DOUBLE_EQ(place["flow_m3_per_s"], 2e-6);
    EXPECT_NEAR(place["drop_pa"], 4 * (50 - 27), 1e-9);
    EXPECT_NEAR(place["ffr"], 0.8, 1e-12);
    EXPECT_NEAR(place["velocity_before_m_per_s"], 0.23, 1e-12);
    EXPECT_NEAR(place["velocity_behind_m_per_s"], 0.39, 1e-12);
    EXPECT_NEAR(place["gauge_pressure_ratio"], (1000 - 4 * 39 - 400.0) / (1000 - 4 * 23 - 400.0), 1e-12);
    EXPECT_EQ(place["branch"], "b");
}

TEST(SamePlaces, ALesionBeginsWhereItSaysOrHalfItsLengthBeforeItsThroat) {
    Json lesion = before()["lesions"][0];
    EXPECT_DOUBLE_EQ(start_arc_mm(lesion), 27);
    lesion["start_arc_mm"] = 25;
    EXPECT_DOUBLE_EQ(start_arc_mm(lesion), 25);
}

/// A cut may make the larger of two outlets the smaller: their names stay.
TEST(SamePlaces, AnOutletIsFoundByItsName) {
    const auto flow = [](const char* first, const char* second) {
        return Json{{"openings",
                     {{"inlet", {{"mean_pressure_pa", 1000.0}}}, {first, Json::object()}, {second, Json::object()}}}};
    };
    EXPECT_EQ(outlet_of_other(flow("a", "b"), flow("b", "a"), 1), 2);
    EXPECT_EQ(outlet_of_other(flow("a", "b"), flow("b", "a"), 2), 1);
    EXPECT_EQ(outlet_of_other(flow("a", "b"), flow("c", "d"), 2), 2);
    EXPECT_EQ(outlet_of_other(Json::object(), flow("a", "b"), 2), 2);
}

TEST(SamePlaces, WithoutAColumnThereIsNoNumber) {
    CsvTable table = pullback(4);
    table.names.back() = "other";
    const Json place = at_lesions_of(before(), pullback(10), after, table)[0];
    EXPECT_TRUE(place["ffr"].is_null());
    EXPECT_FALSE(place["drop_pa"].is_null());
}

TEST(SamePlaces, AFlowWithoutALesionOfItsOwnHasItsFiguresThere) {
    const Json places = {{{"gauge_pressure_ratio", 0.75}, {"ffr", 0.97}},
                         {{"gauge_pressure_ratio", 0.9}, {"ffr", nullptr}},
                         {{"gauge_pressure_ratio", 0.8}, {"ffr", 0.92}}};
    Json open = {{"lesions", Json::array()},
                 {"gauge_pressure_ratio", nullptr},
                 {"ffr", {{"lesion", nullptr}, {"reason", "no lesion was found"}}}};
    add_at_lesions(open, places);
    EXPECT_EQ(open["gauge_pressure_ratio"], 0.75);
    EXPECT_EQ(open["ffr"], (Json{{"lesion", 0.92}, {"read_at", "where the lesion was"}}));
    EXPECT_EQ(open["at_lesions"], places);
    Json narrow = {{"lesions", {{{"ffr", 0.8}}}}, {"gauge_pressure_ratio", 0.5}, {"ffr", {{"lesion", 0.8}}}};
    add_at_lesions(narrow, places);
    EXPECT_EQ(narrow["gauge_pressure_ratio"], 0.5) << "what is left is a lesion of its own";
    EXPECT_EQ(narrow["ffr"]["lesion"], 0.8);
    Json without_aorta = {{"lesions", Json::array()},
                          {"ffr", {{"lesion", nullptr}, {"reason", "the deck gives no aortic pressure"}}}};
    add_at_lesions(without_aorta, {{{"gauge_pressure_ratio", 0.75}, {"ffr", nullptr}}});
    EXPECT_EQ(without_aorta["ffr"]["reason"], "the deck gives no aortic pressure");
}

}   // namespace
}   // namespace patency
