// SPDX-License-Identifier: Apache-2.0
#include "patency/report/sweep.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "patency/base/errors.h"
#include "patency/io/csv.h"
#include "patency/io/summary.h"
#include "patency/report/sweep_quantities.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

/// A flow through a lesion, of which the second is the worse.
Json flow(double ffr, double inflow) {
    return {{"name", "tube"},
            {"openings", {{"inlet", {{"flow_m3_per_s", -inflow}}}}},
            {"lesions", {{{"ffr", 0.95}, {"drop_pa", 10.0}}, {{"ffr", ffr}, {"drop_pa", 100.0}}}},
            {"ffr", {{"lesion", ffr}}}};
}

SweepRow row(const std::string& name, const std::vector<std::string>& values, const Json& summary) {
    return {.name = name,
            .values = values,
            .exit_code = 0,
            .reason = {},
            .made_from = std::make_shared<const Json>(Json{{"deck", name}}),
            .summary = std::make_shared<const Json>(summary)};
}

/// Two values each of two keys; one of the four failed, one has not run.
Sweep sweep() {
    Sweep s{.name = "<tube>", .command = "flow", .keys = {"blood.viscosity", "wall.law"}, .rows = {}};
    s.rows.push_back(row("a", {"3 mPa s", "x, \"y\""}, flow(0.8, 1e-6)));
    s.rows.push_back(row("b", {"4 cP", "x, \"y\""}, flow(0.7, 0.5e-6)));
    s.rows.push_back(
        {.name = "c", .values = {"0.003 Pa s", "z"}, .exit_code = 5, .reason = "diverged, \"here\"\nand there"});
    s.rows.push_back({.name = "d", .values = {"0.004 Pa s", "z"}});
    return s;
}

const SweepQuantity* find(const std::vector<SweepQuantity>& all, const std::string& label) {
    for (const SweepQuantity& q : all)
        if (q.label == label) return &q;
    return nullptr;
}

TEST(SweepQuantities, AreOfTheWorstLesionAndInReadersUnits) {
    const Sweep s = sweep();
    const auto all = sweep_quantities(s);
    ASSERT_TRUE(find(all, "FFR") && find(all, "Pressure drop") && find(all, "Inflow"));
    EXPECT_EQ(value_of(s.rows[0], *find(all, "FFR")), 0.8);
    EXPECT_NEAR(value_of(s.rows[1], *find(all, "Pressure drop")).value(), 0.75006, 1e-5);   // 100 Pa in mmHg
    EXPECT_NEAR(value_of(s.rows[1], *find(all, "Inflow")).value(), 30, 1e-12);
    EXPECT_FALSE(value_of(s.rows[2], *find(all, "FFR")));
    EXPECT_FALSE(find(all, "Recoil"));   // no run has it
}

TEST(SweepQuantities, AfterAStentAreThoseWhereTheLesionWas) {
    Sweep s = sweep();
    Json after = flow(0.9, 1e-6);
    after["at_lesions"] = {{{"ffr", 0.99}}, {{"ffr", 0.97}}};
    s.rows = {row("a", {"3 mPa s", "x"}, {{"before", flow(0.8, 1e-6)}, {"after", after}})};
    const auto all = sweep_quantities(s);
    ASSERT_TRUE(find(all, "FFR after"));
    EXPECT_EQ(value_of(s.rows[0], *find(all, "FFR")), 0.8);
    EXPECT_EQ(value_of(s.rows[0], *find(all, "FFR after")), 0.97);
}

TEST(SweepScale, IsInTheFirstValuesUnit) {
    const auto scale = scale_of(sweep(), 0);
    ASSERT_TRUE(scale);
    EXPECT_EQ(scale->unit, "mPa s");
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(scale->values[k], k % 2 ? 4 : 3, 1e-12) << k;
    EXPECT_FALSE(scale_of(sweep(), 1));   // words
}

TEST(SweepScale, TakesNoLengthForATime) {
    Sweep s = sweep();
    s.rows[1].values[0] = "4 mm";
    EXPECT_FALSE(scale_of(s, 0));
    s.rows[1].values[0] = "4";
    EXPECT_FALSE(scale_of(s, 0));
    s.rows[1].values[0] = "\"4 mPa s\"";   // as a deck may have it
    EXPECT_TRUE(scale_of(s, 0));
}

TEST(SweepCsv, HasEveryNumberAndQuotesWhatNeedsIt) {
    const std::string csv = sweep_csv(sweep());
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "run,blood.viscosity,wall.law,exit_code,reason,ffr,drop_pa,inlet_flow_m3_per_s,openings.inlet.flow_m3_"
              "per_s,ffr.lesion");
    EXPECT_NE(csv.find("a,3 mPa s,\"x, \"\"y\"\"\",0,,0.8,100,-1e-06,-1e-06,0.8\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find("c,0.003 Pa s,z,5,\"diverged, \"\"here\"\"\nand there\",,,,,\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find("d,0.004 Pa s,z,,,,,,,\n"), std::string::npos) << csv;
}

TEST(SweepText, SaysWhyARunFailed) {
    const std::string text = sweep_text(sweep());
    EXPECT_NE(text.find("0.800"), std::string::npos) << text;
    EXPECT_NE(text.find("diverged"), std::string::npos);
    EXPECT_NE(text.find("has not run yet"), std::string::npos);
}

TEST(SweepPage, ShowsEveryRunAndCannotBeGivenMarkup) {
    const std::string page = sweep_page(sweep(), "1");
    EXPECT_EQ(page.find("<tube>"), std::string::npos);
    EXPECT_NE(page.find("&lt;tube&gt;"), std::string::npos);
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_NE(page.find("<a href=\"a/report.html\">a</a>"), std::string::npos);
    EXPECT_EQ(page.find("<a href=\"c/report.html\">"), std::string::npos);   // it has none
    for (const char* name : {"a", "b", "c", "d"})
        EXPECT_NE(page.find(fmt::format("<tr data-run=\"{}\">", name)), std::string::npos) << name;
}

TEST(SweepPage, PlotsOverTheFirstKeyWithNumbersOneCurveForEachOther) {
    Sweep s = sweep();
    s.rows[2] = row("c", {"0.003 Pa s", "z"}, flow(0.6, 1e-6)),
    s.rows[3] = row("d", {"0.004 Pa s", "z"}, flow(0.5, 1e-6));
    const std::string page = sweep_page(s, "1");
    EXPECT_NE(page.find("FFR over blood.viscosity, mPa s"), std::string::npos);
    const std::regex curve("<path class=\"curve series-[01]\"");
    const std::string plots = page.substr(page.find("id=\"plots\""));
    const auto drawn = std::distance(std::sregex_iterator(plots.begin(), plots.end(), curve), std::sregex_iterator());
    EXPECT_EQ(drawn, 3 * 2);   // quantities, laws
    EXPECT_NE(plots.find("wall.law z"), std::string::npos);
}

TEST(SweepRecord, IsReadAsItWasWritten) {
    const ScratchFolder folder;
    const Sweep s = sweep();
    for (const SweepRow& r : s.rows)
        if (r.summary)
            std::filesystem::create_directories(folder / r.name),
                write_summary(folder / r.name / "summary.json", *r.summary);
    EXPECT_FALSE(is_sweep(folder / "."));
    write_sweep(folder / ".", s, "1");
    ASSERT_TRUE(is_sweep(folder / "."));
    const Sweep read = read_sweep(folder / ".");
    ASSERT_EQ(read.rows.size(), 4u);
    EXPECT_EQ(read.keys, s.keys);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(read.rows[k].exit_code, s.rows[k].exit_code);
        EXPECT_EQ(read.rows[k].values, s.rows[k].values);
        EXPECT_EQ(bool(read.rows[k].summary), bool(s.rows[k].summary));
    }
    EXPECT_EQ(*read.rows[1].made_from, *s.rows[1].made_from);
    EXPECT_EQ(sweep_page(read, "1"), sweep_page(s, "1"));
}

TEST(SweepRecord, ThatIsDamagedIsAFileError) {
    const ScratchFolder folder;
    for (
        const char* text :
        {"{}", "[1]",
         R"({"name": "a", "command": "run", "keys": ["k"], "runs": [{"name": "a", "values": [], "reason": "", "exit_code": 0, "made_from": null}]})"}) {
        std::ofstream(folder / "sweep.json") << text;
        EXPECT_THROW(read_sweep(folder / "."), FileError) << text;
    }
}

}   // namespace
}   // namespace patency
