// SPDX-License-Identifier: Apache-2.0
// Where a stent goes, and every way in which it cannot, each with a sentence before anything runs.
#include "patency/stages/stent_placement.h"

#include <gtest/gtest.h>

#include <functional>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/surface_file.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/stent_chart.h"
#include "patency/stages/stent_of_case.h"
#include "tests/io/scratch_folder.h"
#include "tests/stages/vessels.h"

namespace patency {
namespace {

/// The trunk and its branches; the lesion of 50 % in the wider one, 6 mm long, its middle 11 mm from where it leaves.
const Vessel& y() {
    static const Vessel vessel = [] {
        Vessel v = check_vessel(make_y(0.5));
        follow_vessel(v);
        name_branches(v.along->lines, std::vector<NamedCurve>{{"trunk", {{0, 0, 0}, {12e-3, 0, 0}}},
                                                              {"left", {{12e-3, 0, 0}, {28e-3, 12e-3, 0}}},
                                                              {"right", {{12e-3, 0, 0}, {22e-3, -12e-3, 0}}}});
        return v;
    }();
    return vessel;
}

deck::Case config(const std::function<void(deck::Case&)>& change = {}) {
    deck::Case c;
    deck::StentPattern p{.rings = 3,
                         .crowns = 6,
                         .length = 4e-3,
                         .diameter = 1.8e-3,
                         .crimped_diameter = 1.2e-3,
                         .nominal_diameter = 2.6e-3,
                         .strut_width = 0.09e-3,
                         .strut_thickness = 0.08e-3,
                         .crown_radius = 0.12e-3,
                         .gap = 0.2e-3,
                         .connectors = 3,
                         .connector_width = {}};
    c.stent.emplace();
    c.stent->pattern = p;
    if (change) change(c);
    return c;
}
deck::StentPlacement at(const char* branch, double arc) {
    deck::StentPlacement p;
    p.branch = branch, p.arc_length = arc;
    return p;
}
std::string refusal(const std::function<void(deck::Case&)>& change, const Vessel& vessel = y()) {
    try {
        place_stent(config(change), vessel);
    } catch (const Error& e) {
        return (e.code() == ExitCode::deck       ? "deck: "
                : e.code() == ExitCode::geometry ? "geometry: "
                                                 : "") +
               std::string(e.what());
    }
    return "accepted";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(StentPlacement, IsAroundTheWorstLesionIfNobodySays) {
    const StentPlace place = place_stent(config(), y());
    const Lesion& worst = y().along->assessment.lesions.front();
    EXPECT_EQ(place.line, worst.line);
    EXPECT_NEAR(place.arc, 0.5 * (worst.start_arc + worst.end_arc), 1e-12);
    EXPECT_NEAR(place.narrowest, 1.3e-3, 0.02e-3);
    EXPECT_NEAR(place.reference_diameter, 2.6e-3, 0.05e-3);
    EXPECT_LT(place.opened_length, place.pattern.length);
    EXPECT_LT(norm(place.axis.place({0, 0, 0}) - point_at(y().along->lines.lines[place.line], place.arc).place),
              0.1e-3);
}

TEST(StentPlacement, IsWhereTheDeckSays) {
    const StentPlace place = place_stent(config([](deck::Case& c) { c.stent->placement = at("left", 8e-3); }), y());
    for (const Branch& b : y().along->lines.branches)
        if (b.name == "left") {
            EXPECT_NEAR(place.arc, y().along->lines.start_arc(b) + 8e-3, 1e-12);
        }
    const SignedDistance lumen = make_exact_distance(closed_at(y().checked.surface, y().checked.ends));
    for (const double s : {-2e-3, 0.0, 2e-3}) EXPECT_LT(lumen.value(place.axis.place({0, 0, s})), -0.5e-3);
}

TEST(StentPlacement, SaysWhatIsWrong) {
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.stent.reset(); }), std::string("deck: stent: is missing"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.stent->placement = at("lef", 8e-3); }),
                 std::string("deck: stent.placement.branch: the vessel has no branch \"lef\", did you mean left?"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) {
                     c.stent->placement = at("left", 8e-3);
                     c.stent->placement->branch.reset();
                 }),
                 std::string("deck: stent.placement.branch: is missing"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.stent->placement = at("left", 50e-3); }),
                 std::string("geometry: stent.placement.arc_length: 50 mm is past the end of branch left"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.stent->placement = at("trunk", 1e-3); }),
                 std::string("geometry: The stent of 4 mm with its middle at 1 mm reaches past opening inlet"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.stent->placement = at("trunk", 4e-3); }),
                 std::string("ends 2 mm from opening inlet: leave 2.6 mm"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.stent->pattern->length = 40e-3, c.stent->pattern->rings = 30; }),
                 std::string("reaches past opening"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) {
                     c.stent->placement.emplace();
                     c.stent->placement->translation = Vec3{6e-3, 9e-3, 0};
                 }),
                 std::string("geometry: The stent lies outside of the vessel"));
}

TEST(StentPlacement, RefusesDiametersThatContradict) {
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.deployment.diameter = 1.5e-3; }),
                 std::string("deck: deployment.diameter: 1.5 mm does not open a stent that was cut at 1.8 mm"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.deployment.crimped_diameter = 1.9e-3; }),
                 std::string("deck: deployment.crimped_diameter: 1.9 mm is more than"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.deployment.crimped_diameter = 0.2e-3; }),
                 std::string("leaves no room inside"));
    EXPECT_PRED2(says, refusal([](deck::Case& c) { c.deployment.predilation = 1.1e-3; }),
                 std::string("deck: deployment.predilation: a balloon of 1.1 mm does not make room"));
}

TEST(StentPlacement, RefusesWhatDoesNotGetThereUnlessABalloonGoesBefore) {
    const auto wide = [](deck::Case& c) { c.deployment.crimped_diameter = 1.5e-3; };   // the lesion has 1.3 mm
    EXPECT_PRED2(says, refusal(wide),
                 std::string("geometry: The lesion is 1.3 mm wide, too narrow for the stent crimped to 1.5 mm. Let a "
                             "balloon open it before: "
                             "deployment.predilation: \"1.8 mm\""));
    EXPECT_EQ(refusal([&](deck::Case& c) { wide(c), c.deployment.predilation = 1.8e-3; }), "accepted");
    EXPECT_EQ(refusal([&](deck::Case& c) { wide(c), c.deployment.mode = deck::DeploymentMode::geometric; }),
              "accepted");
    // Behind the lesion it would have to pass it.
    EXPECT_PRED2(says, refusal([&](deck::Case& c) {
                     wide(c), c.deployment.predilation = 1.8e-3, c.stent->placement = at("left", 11e-3);
                 }),
                 "is too wide to get there");
}

TEST(StentPlacement, OfAStentThatComesAsASurface) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / "stent.stl";
    write_surface(file, make_stent_surface(make_strut_curves(make_stent_pattern(*config().stent)),
                                           StentAxis(motion_along({0, 0, 1}, {0, 5e-3, 0})), 20e-6));
    const auto as_surface = [&](deck::Case& c) {
        c.stent = deck::Stent{}, c.stent->surface = file, c.stent->unit = "mm", c.deployment.crimped_diameter = 1.2e-3;
    };
    const StentPlace place = place_stent(config(as_surface), y()), own = place_stent(config(), y());
    EXPECT_NEAR(place.pattern.length, own.pattern.length, 0.01 * own.pattern.length);
    EXPECT_NEAR(place.pattern.diameter, own.pattern.diameter, 0.01 * own.pattern.diameter);
    EXPECT_EQ(place.diameter, place.pattern.diameter) << "opened to what the file shows, where nobody says";
    EXPECT_EQ(place.arc, own.arc);
    EXPECT_LT(norm(place.axis.place({0, 0, 1e-3}) - own.axis.place({0, 0, 1e-3})), 1e-6)
        << "the line is smoothed by the diameter";
    EXPECT_EQ(place.pattern.alloy, "316L");
    EXPECT_PRED2(says, refusal([&](deck::Case& c) { as_surface(c), c.deployment.crimped_diameter.reset(); }),
                 std::string("deck: deployment.crimped_diameter: is missing"));
    EXPECT_PRED2(says, refusal([&](deck::Case& c) { as_surface(c), c.deployment.diameter = 1.1e-3; }),
                 std::string("deck: deployment.diameter: 1.1 mm does not open a stent that is crimped"));
    EXPECT_PRED2(says,
                 refusal([&](deck::Case& c) { as_surface(c), c.deployment.mode = deck::DeploymentMode::geometric; }),
                 std::string("deck: deployment.mode: geometric opens"));
}

TEST(StentPlacement, NeedsALesionOrAPlace) {
    Vessel healthy = check_vessel(make_y());
    follow_vessel(healthy);
    EXPECT_PRED2(says, refusal([](deck::Case&) {}, healthy),
                 std::string("deck: stent.placement: is missing, and the vessel has no lesion"));
}

TEST(SmoothedLine, TakesAwayKinksAndKeepsTheEnds) {
    Centreline line{"outlet"};   // to and fro by 0.1 mm every 0.25 mm
    for (int k = 0; k <= 40; ++k)
        line.points.push_back({{0.25e-3 * k, k % 2 ? 0.1e-3 : -0.1e-3, 0}, {1, 0, 0}, 1e-3, 0.25e-3 * k});
    const std::vector<Vec3> smooth = smoothed_line(line, 1e-3);
    ASSERT_EQ(smooth.size(), line.points.size());
    EXPECT_EQ(smooth.front(), line.points.front().place);
    EXPECT_EQ(smooth.back(), line.points.back().place);
    for (std::size_t k = 5; k + 5 < smooth.size(); ++k) {
        EXPECT_NEAR(smooth[k].x, line.points[k].place.x, 1e-12);
        EXPECT_LT(std::abs(smooth[k].y), 0.02e-3);
    }
}

}   // namespace
}   // namespace patency
