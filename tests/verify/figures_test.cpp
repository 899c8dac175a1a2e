// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "patency/base/errors.h"
#include "patency/verify/run_data.h"
#include "patency/verify/verify_case.h"

namespace patency {
namespace {

TEST(Figures, a_bar_is_met_on_its_own_side) {
    Figure f{.key = "x", .value = 1.0, .unit = "1", .bar = Bar{1.0}, .reason = ""};
    EXPECT_TRUE(f.passes());
    f.value = std::nextafter(1.0, 2.0);
    EXPECT_FALSE(f.passes());
    f.bar = Bar{1.0, Sense::at_least};
    EXPECT_TRUE(f.passes());
    f.value = 0.9;
    EXPECT_FALSE(f.passes());
    f.bar.reset();
    EXPECT_TRUE(f.passes());
    f.value.reset();
    EXPECT_FALSE(f.passes()) << "a failed run never passes";
}

TEST(Figures, a_report_reads_back_as_written) {
    CaseReport report{.name = "pipe", .level = Level::full, .particles = 34000, .figures = {}};
    report.figures.push_back(
        {.key = "a", .value = 0.1 + 0.2, .unit = "percent", .bar = Bar{1.5, Sense::at_least}, .reason = ""});
    report.figures.push_back({.key = "b", .value = {}, .unit = "deg", .bar = Bar{3}, .reason = "the run failed"});
    report.figures.push_back({.key = "paper_c", .value = 6.31, .unit = "percent", .bar = {}, .reason = ""});
    const CaseReport back = parse_report(format_report(report), "text");
    EXPECT_EQ(format_report(back), format_report(report));
    ASSERT_EQ(back.figures.size(), 3u);
    EXPECT_EQ(*back.figures[0].value, 0.1 + 0.2);
    EXPECT_EQ(back.figures[0].bar->sense, Sense::at_least);
    EXPECT_FALSE(back.figures[1].value);
    EXPECT_FALSE(back.figures[2].bar);
    EXPECT_EQ(back.level, Level::full);
    EXPECT_FALSE(back.passes());
}

TEST(Figures, no_nan_reaches_a_report) {
    CaseReport report{.name = "pipe", .level = Level::quick, .particles = 1, .figures = {}};
    report.figures.push_back(
        {.key = "a", .value = std::numeric_limits<double>::quiet_NaN(), .unit = "1", .bar = Bar{1}, .reason = ""});
    EXPECT_FALSE(report.passes());
    EXPECT_THROW(format_report(report), Error);
    EXPECT_THROW(parse_report("{\"name\": 3}", "text"), FileError);
    EXPECT_THROW(parse_report("{\"na", "text"), FileError);
}

TEST(RunData, reads_back_bit_for_bit_and_refuses_what_was_cut_off) {
    RunData run{.key = "k",
                .failure = "",
                .particles = 5,
                .acoustic_steps = 7,
                .particle_steps = 35,
                .cpu_s = 0.1,
                .wall_s = 0.2,
                .lists = {}};
    run.lists["u"] = {1.0 / 3, -0.0, 5e-324};
    const std::string text = format_run(run);
    const auto back = parse_run(text);
    ASSERT_TRUE(back);
    EXPECT_EQ(format_run(*back), text);
    EXPECT_EQ(back->list("u"), run.list("u"));
    EXPECT_THROW(back->list("v"), Error);
    EXPECT_FALSE(parse_run(text.substr(0, text.size() / 2)));
}

TEST(FigureList, leaves_out_other_levels_and_keeps_failures) {
    std::map<std::string, RunData> runs;
    runs["good"].lists["x"] = {2};
    runs["bad"].failure = "it diverged";
    const Results results(runs, {});
    FigureList list(results);
    list.add({"good", "1", Bar{3}}, {"good"}, [&] { return results["good"].number("x"); });
    list.add({"bad", "1", Bar{3}}, {"good", "bad"}, [&] { return results["bad"].number("x"); });
    list.add({"absent", "1", Bar{3}}, {"full"}, [&] { return results["full"].number("x"); });
    const auto figures = list.take();
    ASSERT_EQ(figures.size(), 2u);
    EXPECT_TRUE(figures[0].passes());
    EXPECT_FALSE(figures[1].passes());
    EXPECT_NE(figures[1].reason.find("it diverged"), std::string::npos);
}

}   // namespace
}   // namespace patency
