// SPDX-License-Identifier: Apache-2.0
// Sections against closed forms; lesions against the stenosis that was put there, and none where there is none.
#include "patency/shape/lesions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shape/surfaces.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi, mm = 1e-3;

TEST(CrossSection, OfATubeIsAnEllipseWherePlanesAreOblique) {
    const std::uint32_t around = 96;
    const Surface tube = make_tube_mesh({.radius = mm, .length = 10 * mm, .around = around, .along = 30});
    const SectionCutter cutter(tube);
    const double polygon = 0.5 * around * std::sin(2 * pi / around) * mm * mm;   // area of the facets' outline
    for (double degrees : {0.0, 20.0, 45.0}) {
        const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
        const CrossSection section = cutter.cut({5 * mm, 0.2 * mm, 0}, {c, s, 0});
        EXPECT_TRUE(section.is_closed);
        EXPECT_TRUE(section.holds_place);
        EXPECT_NEAR(section.area, polygon / c, 1e-9 * polygon);
        EXPECT_NEAR(section.most_width, 2 * mm / c, 2e-3 * mm);
        EXPECT_NEAR(section.least_width, 2 * mm, 4e-3 * mm);
    }
    EXPECT_NEAR(cutter.cut({5 * mm, 0, 0}, {1, 0, 0}).perimeter, 2 * around * std::sin(pi / around) * mm, 1e-9 * mm);
}

TEST(CrossSection, IsTheOneAroundThePlaceAndSaysIfItIsOpen) {
    const Surface torus = make_torus_mesh(4 * mm, mm, 120, 80);
    const SectionCutter cutter(torus);
    const CrossSection section = cutter.cut({4 * mm, 0, 0}, {0, 1, 0});   // the plane cuts the other side too
    EXPECT_NEAR(section.area, pi * mm * mm, 2e-3 * pi * mm * mm);
    EXPECT_TRUE(section.holds_place);
    EXPECT_FALSE(cutter.cut({0, 0, 0}, {0, 1, 0}).holds_place);
    EXPECT_EQ(cutter.cut({20 * mm, 0, 0}, {1, 0, 0}).area, 0);
    const Surface open = make_tube_mesh({.radius = mm, .length = 10 * mm});
    const CrossSection at_end =
        SectionCutter(open).cut({0.2 * mm, 0, 0}, normalized(Vec3{1, 1, 0}));   // runs out of the end
    EXPECT_FALSE(at_end.is_closed);
    EXPECT_GT(at_end.area, 0.5 * pi * mm * mm);
}

/// A round vessel along x with a radius as a function of x, its centreline and sections as they are.
struct Straight {
    BranchedLines vessel;
    std::vector<std::vector<CrossSection>> sections;
};
template <class Radius>
Straight straight(double length, Radius radius, double bifurcation_from = -1, double bifurcation_to = -1) {
    Straight s;
    Centreline line{"outlet"};
    s.sections.emplace_back();
    for (double x = 0; x < length + 1e-9; x += 0.1 * mm) {
        line.points.push_back({{x, 0, 0}, {1, 0, 0}, radius(x), x});
        CrossSection section{.place = {x, 0, 0}, .normal = {1, 0, 0}, .is_closed = true, .holds_place = true};
        section.area = pi * radius(x) * radius(x);
        section.is_shared = x > bifurcation_from && x < bifurcation_to;
        s.sections.back().push_back(section);
    }
    std::vector<int> ids(line.points.size()), bifurcations(ids.size(), -1);
    s.vessel.lines = {line};
    s.vessel.branches = {{"branch_1", 0, 0, ids.size() - 1, -1, {0}}};
    if (bifurcation_to > 0) {
        for (std::size_t k = 0; k < ids.size(); ++k)
            ids[k] = line.points[k].arc <= bifurcation_from ? 0 : line.points[k].arc < bifurcation_to ? -1 : 1;
        const auto count = [&](int id) { return std::size_t(std::count(ids.begin(), ids.end(), id)); };
        s.vessel.branches = {{"branch_1", 0, 0, count(0) - 1, -1, {0}},
                             {"branch_2", 0, count(0) + count(-1), ids.size() - 1, 0, {0}}};
    }
    s.vessel.branch_ids.push_back(
        std::move(ids));   // g++ 12 warns of its own allocator where a copy of it is made here
    s.vessel.bifurcation_ids.push_back(std::move(bifurcations));
    return s;
}
Assessment assess(const Straight& s) { return assess_lesions(s.vessel, s.sections); }

double narrowing(double x, double centre, double half) {   // 0 to 1
    const double z = (x - centre) / half;
    return std::abs(z) < 1 ? 0.5 * (1 + std::cos(pi * z)) : 0;
}

TEST(Lesion, HasTheStenosisThatWasPutThere) {
    const auto s = straight(30 * mm, [](double x) { return 1.65 * mm - 0.65 * mm * narrowing(x, 15 * mm, 5 * mm); });
    const Assessment found = assess(s);
    ASSERT_EQ(found.lesions.size(), 1u);
    const Lesion& l = found.lesions[0];
    EXPECT_NEAR(l.throat_arc, 15 * mm, 0.1 * mm);
    EXPECT_NEAR(l.minimum_diameter, 2 * mm, 1e-6);
    EXPECT_NEAR(l.minimum_area, pi * mm * mm, 1e-3 * pi * mm * mm);
    ASSERT_TRUE(l.proximal && l.distal);
    EXPECT_NEAR(l.diameter_stenosis, 1 - 2 / 3.3, 0.002);
    EXPECT_NEAR(l.area_stenosis, 1 - 4 / (3.3 * 3.3), 0.004);
    // (14.6): where 5 % are missing, cos(pi z) = 1 - 2 (1 - 0.05 / 1.05 * 1.65 / 0.65)...: 7.7 of the 10 mm
    EXPECT_NEAR(l.length(), 7.7 * mm, 0.3 * mm);
    for (double arc : {2 * mm, 12 * mm, 15 * mm, 28 * mm})
        EXPECT_NEAR(value_at(s.vessel.lines[0], found.healthy_diameter[0], arc), 3.3 * mm, 0.01 * 3.3 * mm);
}

TEST(Lesion, InATaperingVesselIsMeasuredAgainstTheTaper) {
    const auto taper = [](double x) { return 2 * mm - 0.02 * x; };   // 2 to 1.2 mm over 40 mm
    const auto s = straight(40 * mm, [&](double x) { return taper(x) * (1 - 0.5 * narrowing(x, 20 * mm, 4 * mm)); });
    const Assessment found = assess(s);
    ASSERT_EQ(found.lesions.size(), 1u);
    EXPECT_NEAR(found.lesions[0].diameter_stenosis, 0.5, 0.01);
    EXPECT_NEAR(value_at(s.vessel.lines[0], found.healthy_diameter[0], 20 * mm), 2 * taper(20 * mm), 0.02 * 3.2 * mm);
}

TEST(Lesion, IsNotATaperNorAStepAtABifurcationNorItsBulge) {
    EXPECT_TRUE(assess(straight(40 * mm, [](double x) { return 2.5 * mm - 0.045 * x; })).lesions.empty());
    const auto step = [](double x) { return x < 15 * mm ? 2.2 * mm : x < 18 * mm ? 2.6 * mm : 1.2 * mm; };
    const Assessment found = assess(straight(40 * mm, step, 15 * mm, 18 * mm));
    EXPECT_TRUE(found.lesions.empty());
    for (std::size_t k = 0; k < found.healthy_diameter[0].size(); ++k)
        EXPECT_LE(found.healthy_diameter[0][k], 4.4 * mm * (1 + 1e-12)) << "no bulge";
}

TEST(Lesion, IsNotAStepJustBeforeABifurcationUnlessItIsNarrowerThanWhatFollows) {
    for (double throat : {1.2 * mm, 0.8 * mm}) {   // 1.8 mm before it; 1.25 mm after it, and wider again later
        const auto radius = [&](double x) {
            return x < 12 * mm ? 1.8 * mm : x < 17 * mm ? throat : x < 28 * mm ? 1.25 * mm : 1.7 * mm;
        };
        const Assessment found = assess(straight(40 * mm, radius, 15 * mm, 17 * mm));
        ASSERT_EQ(found.lesions.size(), throat < 1 * mm ? 1u : 0u) << throat;
        for (const Lesion& lesion : found.lesions) EXPECT_NEAR(lesion.diameter_stenosis, 1 - 0.8 / 1.8, 0.01);
    }
}

TEST(Lesion, MayBeLongAndEvenlyNarrow) {
    const auto radius = [](double x) { return x > 15 * mm && x < 30 * mm ? 1 * mm : 1.5 * mm; };
    const Assessment found = assess(straight(45 * mm, radius));
    ASSERT_EQ(found.lesions.size(), 1u);
    EXPECT_NEAR(found.lesions[0].diameter_stenosis, 1. / 3, 1e-6);
    EXPECT_NEAR(found.lesions[0].length(), 15 * mm, 0.3 * mm);
}

TEST(Lesion, IsNotNoise) {
    unsigned state = 1;
    const auto noisy = [&](double) {
        state = state * 1664525u + 1013904223u;
        return 1.5 * mm * (1 + 0.08 * (double(state >> 8) / double(1 << 24) - 0.5) * 2);
    };
    Straight s = straight(40 * mm, [](double) { return 1.5 * mm; });
    for (auto& p : s.vessel.lines[0].points) p.radius = noisy(0);
    EXPECT_TRUE(assess(s).lesions.empty());
}

TEST(Lesion, AtTheMouthOfABranchHasOnlyADistalReference) {
    const auto radius = [](double x) {
        return x < 15 * mm ? 2.2 * mm : (1.2 * mm) * (1 - 0.6 * narrowing(x, 18 * mm, 3 * mm));
    };
    const Assessment found = assess(straight(40 * mm, radius, 15 * mm, 17 * mm));
    ASSERT_EQ(found.lesions.size(), 1u);
    EXPECT_EQ(found.lesions[0].branch, 1u);
    EXPECT_FALSE(found.lesions[0].proximal);
    EXPECT_NEAR(found.lesions[0].diameter_stenosis, 0.6, 0.01);
}

TEST(Lesion, OfASurfaceIsFoundWithItsPlace) {
    Surface tube = make_tube_mesh({.radius = 1.65 * mm, .length = 30 * mm, .around = 64, .along = 150});
    for (Vec3& x : tube.points) {
        const double share = 1 - 0.65 / 1.65 * narrowing(x.x, 15 * mm, 5 * mm);
        x.y *= share, x.z *= share;
    }
    BranchedLines vessel;
    Centreline line{"outlet"};
    for (double x = 0; x < 30.01 * mm; x += 0.25 * mm)
        line.points.push_back({{x, 0, 0}, {1, 0, 0}, 1.65 * mm - 0.65 * mm * narrowing(x, 15 * mm, 5 * mm), x});
    vessel = find_branches({line});
    const auto sections = cut_sections(tube, vessel);
    EXPECT_NEAR(sections[0][60].area, pi * mm * mm, 0.01 * pi * mm * mm);
    EXPECT_FALSE(sections[0][60].is_shared);
    const Assessment found = assess_lesions(vessel, sections);
    ASSERT_EQ(found.lesions.size(), 1u);
    EXPECT_LT(norm(found.lesions[0].place - Vec3{15 * mm, 0, 0}), 0.01 * mm);
    EXPECT_NEAR(found.lesions[0].area_stenosis, 1 - 4 / (3.3 * 3.3), 0.01);
}

}   // namespace
}   // namespace patency
