// SPDX-License-Identifier: Apache-2.0
// Pages of small results that the test writes itself. How a browser takes them is web/test/page.test.mjs's.
#include "patency/report/page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "patency/base/errors.h"
#include "patency/io/summary.h"
#include "patency/report/curve.h"
#include "patency/report/page_data.h"
#include "patency/report/page_parts.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

Json flow_summary() {
    return Json::parse(
        R"({"name": "tube", "scheme": "sph", "openings": {"inlet": {"flow_m3_per_s": -1e-6, "mean_pressure_pa": 100}, "outlet": {"flow_m3_per_s": 1e-6, "mean_pressure_pa": 0}},
                           "mass_imbalance_percent": 0.01, "particles": {"fluid": 1000, "across_narrowest": 12.5}, "ffr": {"lesion": null, "reason": "the deck gives no aortic pressure"}})");
}

void write_wall(const std::filesystem::path& path, std::uint32_t around) {
    const Surface torus = make_torus_mesh(1e-2, 2e-3, around, around / 2);
    PolyData data{.points = torus.points, .lines = {}, .triangles = torus.triangles};
    data.arrays = {{"pressure", "Pa", 1, std::vector<double>(torus.points.size(), 3.0)}};
    write_polydata(path, data);
}

void write_body(const std::filesystem::path& path, std::uint32_t around) {
    const Surface torus = make_torus_mesh(5e-3, 1e-3, around, around / 2);
    PolyData data{.points = torus.points, .lines = {}, .triangles = torus.triangles};
    std::mt19937 random(7);
    for (const char* field : {"VonMises_stress", "PlasticStrain", "Gap"}) {
        std::vector<double> values(torus.points.size());
        for (double& v : values) v = 1e-6 * double(random() % 1000000);
        data.arrays.push_back({field, "1", 1, std::move(values)});
    }
    write_polydata(path, data);
}

TEST(Page, FetchesNothing) {
    const ScratchFolder folder;
    write_summary(folder / "summary.json", flow_summary());
    const std::string page = contents_of(write_report(folder.path(), "1.2.3"));
    EXPECT_TRUE(has(page, "default-src 'none'; script-src 'sha256-"));
    EXPECT_TRUE(has(page, "'; style-src 'sha256-"));
    const std::string own = page.substr(0, page.find("<style>")) +
                            page.substr(page.find("</style>"), page.rfind("<script>") - page.find("</style>"));
    EXPECT_EQ(own.find("http"), own.find("http-equiv"));   // no address anywhere but for the policy's own name
    EXPECT_EQ(own.find("http", own.find("http-equiv") + 1), own.npos);
    EXPECT_TRUE(has(page, "patency 1.2.3"));
    EXPECT_FALSE(page_script().empty());
    EXPECT_EQ(page_script().find("</script"), std::string_view::npos);
}

/// Whatever is in it, a run of three parts stays below 5 MB: before, after, and ten frames of two bodies, whose fields have a
/// value of their own at every point.
TEST(Page, StaysSmallForLargeResults) {
    const ScratchFolder folder;
    for (const char* part : {"before", "after", "deploy", "deploy/frames"})
        std::filesystem::create_directory(folder / part);
    for (const char* part : {"before", "after"}) write_wall(folder / part / "wall.vtp", 500);
    for (const char* body : {"stent", "wall"}) {
        write_body(folder / "deploy/frames" / body, 200);
        std::string list;
        for (int k = 0; k < 60; ++k)
            list += "<DataSet timestep=\"" + std::to_string(k) + "\" part=\"0\" file=\"frames/" + body + "\"/>\n";
        put(folder / ("deploy/" + std::string(body) + ".pvd"),
            "<VTKFile><Collection>\n" + list + "</Collection></VTKFile>\n");
    }
    write_summary(folder / "summary.json", {{"name", "large"},
                                            {"before", flow_summary()},
                                            {"deploy", {{"recoil_percent", 3.5}}},
                                            {"after", flow_summary()}});
    const RunResults results = read_results(folder.path());
    ASSERT_EQ(results.bodies.size(), 2u);
    EXPECT_EQ(results.bodies[0].frames.size(), 10u);
    EXPECT_EQ(results.bodies[0].times.back(), 59);   // the last is among them
    EXPECT_LT(make_page(results, "1").size(), 5e6);
}

/// Stent beside wall, a distribution in a row, what belongs to neither body below: none of it may be lost.
TEST(Page, ADeploymentsEnergiesAndStressesAreTables) {
    const ScratchFolder folder;
    const Json distribution{{"p50", 1e5}, {"p95", 2e5}, {"p99", 3e5}, {"largest", 496e6}};
    write_summary(folder / "summary.json", {{"name", "stent"},
                                            {"deploy",
                                             {{"recoil_percent", 3.5},
                                              {"largest_tool_pressure_pa", 1013250.0},
                                              {"stresses",
                                               {{"wall_von_mises_pa", {{"media", distribution}}},
                                                {"plastic_strain", distribution},
                                                {"wall_plastic_strain", Json::object()}}},
                                              {"energies",
                                               {{"tool_work_j", 0.0375},
                                                {"stent", {{"plastic_j", 0.03125}}},
                                                {"wall", {{"plastic_j", 0.0}}},
                                                {"imbalance_percent", 0.25}}},
                                              {"particles", {{"stent", 70170}, {"wall", 9790}}},
                                              {"steps", 29710}}}});
    const std::string page = make_page(read_results(folder.path()), "1");
    for (const char* said :
         {"Energies of the deployment, mJ", "Stresses and strains", "Wall von Mises stress, media, MPa",
          "Plastic strain, %", "What the deployment took", "Imbalance of energy", "Particles, stent", ">31.250<",
          ">37.500<", ">496<", ">10.0<", ">29710<"})
        EXPECT_TRUE(has(page, said)) << said;
    for (const char* path :
         {"/deploy/energies/stent/plastic_j", "/deploy/energies/wall/plastic_j", "/deploy/energies/tool_work_j",
          "/deploy/stresses/wall_von_mises_pa/media/p95", "/deploy/steps"})
        EXPECT_TRUE(has(page, "data-path=\"" + std::string(path) + "\"")) << path;
}

TEST(Page, TextOfTheCaseStaysText) {
    const ScratchFolder folder;
    Json summary = flow_summary();
    summary["name"] = "</script><script>alert(1)</script>";
    summary["openings"]["<img src=x>"] = summary["openings"]["outlet"];
    write_summary(folder / "summary.json", summary);
    put(folder / "case.resolved.yaml", "# </pre></details><script>alert(2)</script>\nwall: {motion: \"<i>\"}\n");
    const std::string page = contents_of(write_report(folder.path(), "1"));
    EXPECT_EQ(page.find("<script>alert"), page.npos);
    EXPECT_EQ(page.find("<img src=x>"), page.npos);
    EXPECT_EQ(page.find("<i>"), page.npos);
    EXPECT_TRUE(has(page, "&lt;/script&gt;&lt;script&gt;alert(1)"));
}

TEST(Page, IsTheSameForTheSameResults) {
    const ScratchFolder folder;
    write_summary(folder / "summary.json", flow_summary());
    write_wall(folder / "wall.vtp", 40);
    const RunResults results = read_results(folder.path());
    EXPECT_EQ(make_page(results, "1"), make_page(read_results(folder.path()), "1"));
}

TEST(Page, APulseIsDrawnOverItsLastBeat) {
    const ScratchFolder folder;
    Json summary = flow_summary();
    summary["time_s"] = 1.6, summary["period_s"] = 0.8;
    std::string waves =
        "time_s,inlet_flow_m3_per_s,inlet_mean_pressure_pa,outlet_flow_m3_per_s,outlet_mean_pressure_pa\n";
    for (int k = 0; k <= 16; ++k)   // 9e-6 m^3/s only before the last beat, 2e-6 in it
        waves += std::to_string(0.1 * k) + (k < 8 ? ",-9e-6,900,9e-6,900\n" : ",-2e-6,12000,2e-6,11000\n");
    put(folder / "waveforms.csv", waves);
    write_summary(folder / "summary.json", summary);
    const std::string page = contents_of(write_report(folder.path(), "1"));
    for (const char* words :
         {"<h2>Over a beat</h2>", "aria-label=\"Flow at the openings over a beat\"",
          "aria-label=\"Pressure at the openings over a beat\"", "<span class=\"key series-1\">outlet</span>"})
        EXPECT_TRUE(has(page, words)) << words;
    const std::string flows = page.substr(page.find("Flow at the openings"), 4000);
    EXPECT_TRUE(has(flows, ">120</text>"));                                    // 2e-6 m^3/s, on both curves upward
    EXPECT_FALSE(has(flows.substr(0, flows.find("</svg>")), ">500</text>"));   // what was before is not drawn
    EXPECT_FALSE(has(flows.substr(0, flows.find("</svg>")), ">-"));
    summary.erase("period_s");   // a steady flow has no beat
    write_summary(folder / "summary.json", summary);
    EXPECT_FALSE(has(contents_of(write_report(folder.path(), "1")), "Over a beat"));
}

TEST(Page, SaysByWhatMethodTheFlowWasFound) {
    const ScratchFolder folder;
    const auto page_of = [&](const Json& summary) {
        write_summary(folder / "summary.json", summary);
        return make_page(read_results(folder.path()), "1");
    };
    Json summary = flow_summary();
    EXPECT_TRUE(has(page_of(summary), "moving particles"));
    summary["scheme"] = "cells";
    EXPECT_TRUE(has(page_of(summary), "steady flow on the cells"));
    summary["time_steps"] = 400;
    EXPECT_TRUE(has(page_of(summary), "periodic flow on the cells"));
    summary["convergence"] = {{"is_converged", true}, {"change_percent", 0.2}, {"is_mean_over_time", true}};
    EXPECT_TRUE(has(page_of(summary), "followed in time on the cells"));
}

TEST(Page, SaysWhatResultsHaveNone) {
    const ScratchFolder folder;
    EXPECT_THROW(read_results(folder.path()), FileError);
    write_summary(folder / "summary.json", {{"name", "x"}, {"solids", Json::object()}});
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_results(folder.path()); }), "no page to make"));
    write_summary(folder / "summary.json", Json::array());
    EXPECT_THROW(read_results(folder.path()), FileError);
}

TEST(Page, FindsTheLesionAgain) {
    const Json lesion = {{"branch", "a"}, {"throat_arc_mm", 30.0}, {"length_mm", 8.0}};
    Json flow = {{"lesions",
                  {{{"branch", "b"}, {"throat_arc_mm", 30.0}},
                   {{"branch", "a"}, {"throat_arc_mm", 50.0}},
                   {{"branch", "a"}, {"throat_arc_mm", 33.0}}}}};
    EXPECT_EQ(find_lesion(flow, lesion), 2u);
    flow["lesions"].erase(2);
    EXPECT_EQ(find_lesion(flow, lesion), std::nullopt);
    EXPECT_EQ(find_lesion(Json::object(), lesion), std::nullopt);
}

TEST(Page, TheWorstLesionIsThatOfTheLowestFfrElseTheTightest) {
    Json flow = {
        {"lesions",
         {{{"ffr", 0.9}, {"diameter_stenosis_percent", 70.0}}, {{"ffr", 0.7}, {"diameter_stenosis_percent", 50.0}}}}};
    EXPECT_EQ(worst_lesion(flow), 1u);
    for (Json& lesion : flow["lesions"]) lesion["ffr"] = nullptr;
    EXPECT_EQ(worst_lesion(flow), 0u);
    EXPECT_EQ(worst_lesion(Json::object()), std::nullopt);
}

TEST(Page, ACurveHasItsLesionAndItsLevel) {
    const PlotCurve curve{"before", "before", {0, 10, 20}, {1, 0.9, 0.75}};
    const std::string svg = draw_curves({.x_label = "mm",
                                         .y_label = "a < b",
                                         .curves = {curve},
                                         .spans = {{5, 8, "lesion"}, {90, 95, "stent"}},
                                         .least = {},
                                         .levels = {0.8, 0.2}});
    EXPECT_TRUE(has(svg, "class=\"span lesion\""));
    EXPECT_EQ(svg.find("span stent"), svg.npos);                            // beyond the curve
    EXPECT_EQ(svg.find("class=\"level\""), svg.rfind("class=\"level\""));   // one level is within the axis
    EXPECT_TRUE(has(svg, "a &lt; b"));
    EXPECT_EQ(draw_curves({.x_label = "", .y_label = "", .curves = {}, .spans = {}, .least = {}, .levels = {}}), "");
}

/// Marks were counted up by a step that rounding swallowed, without end.
TEST(Curves, WhatDiffersByRoundingAloneIsOneValue) {
    const auto drawn = [](double first, double second) {
        return draw_curves({.x_label = "mm",
                            .y_label = "mmHg",
                            .curves = {{.label = "", .style = "before", .x = {0, 10}, .y = {first, second}}},
                            .spans = {},
                            .levels = {}});
    };
    for (const double size : {1e-12, 0.5, 93.0, 1e9}) {
        const std::string svg = drawn(size, std::nextafter(size, 2 * size));
        EXPECT_LT(svg.size(), 6000u) << size;
        EXPECT_TRUE(has(svg, "<path class=\"curve")) << size;
    }
    EXPECT_LT(drawn(0, 0).size(), 6000u);
    EXPECT_TRUE(has(drawn(-1, 1), ">0.0<")) << drawn(-1, 1);
    EXPECT_FALSE(has(drawn(-1, 1), "-0.0<"));
}

}   // namespace
}   // namespace patency
