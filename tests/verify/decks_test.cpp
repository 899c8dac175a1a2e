// SPDX-License-Identifier: Apache-2.0
// Every registered case has a deck that reads, with the runs that its figures ask for.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/verify/runner.h"
#include "patency/verify/svg.h"

namespace patency {
namespace {

const std::filesystem::path decks = std::filesystem::path(PATENCY_SOURCE_DIR) / "cases" / "verify";

TEST(VerificationCases, names_differ_and_decks_read) {
    std::set<std::string> names;
    for (const VerifyCase& c : verification_cases()) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        if (!c.measure && !c.measure_cells && !c.measure_solids) continue;
        const auto runs = deck::read_runs(decks / (c.name + ".yaml"));
        EXPECT_FALSE(runs.empty()) << c.name;
        // With all runs failed every figure must still be there, without a value, except what others found.
        std::map<std::string, RunData> failed;
        for (const auto& run : runs) failed[run.name].failure = "not run";
        const Results results(failed, {});
        FigureList figures(results);
        c.figures(results, figures);
        int bars = 0;
        for (const Figure& f : figures.take()) {
            const bool is_quoted = f.key.starts_with("paper_printed_") || f.key.starts_with("laboratories_");
            EXPECT_EQ(f.value.has_value(), is_quoted) << c.name << " " << f.key;
            bars += f.bar.has_value();
        }
        EXPECT_GT(bars, 0) << c.name;
        if (c.pictures) {
            EXPECT_NO_THROW(c.pictures(results)) << c.name;
        }
    }
    EXPECT_EQ(names.size(), 32u);
}

TEST(VerificationCases, an_unknown_name_is_refused_with_the_nearest) {
    try {
        run_verification({.names = {"poisseuille"},
                          .level = Level::quick,
                          .out = "out",
                          .decks = decks,
                          .reference = {},
                          .program = "",
                          .settings = {}});
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("poiseuille"), std::string::npos);
    }
}

TEST(Svg, a_plot_holds_every_point_and_nothing_else_is_drawn_of_nothing) {
    const std::string svg =
        format_plot({"x", "y", {{"line", {0, 1, 2}, {0, 1, 4}, false}, {"dots", {0.5, 1.5}, {1, 2}, true}}});
    std::size_t circles = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
    EXPECT_EQ(circles, 2u);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_THROW(format_plot({"x", "y", {}}), UsageError);
}

TEST(Svg, a_curve_without_a_name_goes_with_the_one_before_it) {
    const std::string svg =
        format_plot({"x", "y", {{"exact", {0, 1}, {0, 1}}, {"", {0, 1}, {1, 2}}, {"found", {0, 1}, {0, 2}, true}}});
    const auto count = [&](const std::string& what) {
        std::size_t n = 0;
        for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count("width=\"10\" height=\"10\""), 2u) << "lines of the legend";
    const std::size_t first = svg.find("<polyline"), second = svg.find("<polyline", first + 1);
    const auto colour = [&](std::size_t at) { return svg.substr(svg.find("stroke=\"#", at), 16); };
    EXPECT_EQ(colour(first), colour(second));
    EXPECT_NE(colour(first), colour(svg.find("<circle")));
}

}   // namespace
}   // namespace patency
