// SPDX-License-Identifier: Apache-2.0
// Ends of tubes cut at known angles: the angle that is found, and what is left once they are cut square.
#include "patency/shape/square_ends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/exact_distance.h"
#include "tests/io/sentences.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

constexpr double mm = 1e-3, pi = std::numbers::pi;
constexpr double radius = 1.5 * mm, length = 15 * mm;
constexpr std::uint32_t around = 64;

/// A tube along x from 0, its far end cut so obliquely.
Surface oblique_tube(double degrees, bool capped) {
    Surface tube = make_tube_mesh(
        {.radius = radius, .length = length, .around = around, .along = 60, .start_cap = capped, .end_cap = capped});
    for (Vec3& x : tube.points) x.x *= 1 + x.y * std::tan(degrees * pi / 180) / length;
    return tube;
}

/// Its axis on a circle.
Surface bent(Surface tube, double bend) {
    for (Vec3& x : tube.points) {
        const double angle = x.x / bend;
        x = {(bend - x.y) * std::sin(angle), bend - (bend - x.y) * std::cos(angle), x.z};
    }
    return tube;
}

/// A surface followed, with all that its cuts need.
struct Followed {
    CheckedSurface checked;
    std::vector<SurfaceOpening> openings;
    BranchedLines lines;
    Surface closed;
    SectionCutter cutter;
    std::vector<AxisEnd> ends;

    explicit Followed(Surface surface)
        : checked(check_surface(std::move(surface))),
          openings(find_openings(checked)),
          lines(find_branches(lines_of())),
          closed(closed_at(checked.surface, checked.ends)),
          cutter(closed),
          ends(find_ends(checked, openings, lines)) {}
    std::vector<Centreline> lines_of() const {
        std::vector<Opening> plain;
        for (const SurfaceOpening& o : openings) plain.push_back(o.opening);
        return find_centrelines(make_exact_distance(closed_at(checked.surface, checked.ends)), plain);
    }
    /// The end that is nearest to a place.
    std::size_t end_at(const Vec3& place) const {
        std::size_t best = 0;
        for (std::size_t k = 0; k < ends.size(); ++k)
            if (norm(openings[k].opening.centre - place) < norm(openings[best].opening.centre - place)) best = k;
        return best;
    }
};

double degrees_off(const Followed& f, std::size_t k) {
    const auto least = least_square_cut(f.cutter, f.ends[k]);
    return least ? off_square(f.ends[k], *least) * 180 / pi : -1;
}

TEST(SquareEnds, TheAngleOfAnObliqueEndIsFound) {
    for (const bool capped : {false, true})
        for (const double degrees : {0.0, 20.0, 45.0, 55.0}) {
            const Followed tube(oblique_tube(degrees, capped));
            // The tube is straight and its sections have their centres on its axis: what is left is rounding.
            EXPECT_NEAR(degrees_off(tube, tube.end_at({length, 0, 0})), degrees, 0.05) << degrees << capped;
            EXPECT_NEAR(degrees_off(tube, tube.end_at({0, 0, 0})), 0, 0.05) << degrees << capped;
        }
}

TEST(SquareEnds, TheLeastCutTouchesTheRimWhereItReachesBackFarthest) {
    const Followed tube(oblique_tube(30, false));
    const std::size_t k = tube.end_at({length, 0, 0});
    const auto least = least_square_cut(tube.cutter, tube.ends[k]);
    ASSERT_TRUE(least);
    EXPECT_NEAR(least->point.x, length - radius * std::tan(pi / 6), 1e-3 * radius);
}

TEST(SquareEnds, OfABentTubeTheAxisIsThatAtTheCut) {
    constexpr double bend = 15 * mm;   // ten radii
    for (const double degrees : {0.0, 30.0}) {
        const Followed tube(bent(oblique_tube(degrees, false), bend));
        const double angle = length / bend;
        const std::size_t k = tube.end_at({bend * std::sin(angle), bend * (1 - std::cos(angle)), 0});
        const auto cut = square_cut_at(tube.cutter, tube.ends[k], 2 * mm);
        ASSERT_TRUE(cut);
        const double at = std::atan2(cut->point.x, bend - cut->point.y);
        // A parabola through two radii of a circle of ten is off by a degree at its end.
        EXPECT_GT(dot(cut->normal, Vec3{std::cos(at), std::sin(at), 0}), std::cos(1.2 * pi / 180)) << degrees;
    }
}

TEST(SquareEnds, WhatIsLeftIsTheTubeCutAcross) {
    const double section = 0.5 * around * radius * radius * std::sin(2 * pi / around);
    for (const bool capped : {false, true}) {
        Followed tube(oblique_tube(45, capped));
        const std::size_t k = tube.end_at({length, 0, 0});
        const auto cut = square_cut_at(tube.cutter, tube.ends[k], 3 * mm);
        ASSERT_TRUE(cut);
        Surface surface = tube.checked.surface;
        const Finding finding = cut_end(surface, tube.ends, k, *cut);
        EXPECT_EQ(finding.kind, "cut_back");
        EXPECT_TRUE(has(finding.sentence, "45 degrees")) << finding.sentence;
        EXPECT_GT(finding.shown.triangles.size(), 0u);

        const CheckedSurface checked = check_surface(surface);
        EXPECT_EQ(refusals(checked.findings), "");
        EXPECT_EQ(checked.ends.size(), capped ? 1u : 2u);
        const std::vector<SurfaceOpening> openings = find_openings(checked);
        ASSERT_EQ(openings.size(), 2u);
        const bool is_first = openings[0].opening.centre.x > openings[1].opening.centre.x;
        const SurfaceOpening& made = openings[is_first ? 0 : 1];
        EXPECT_NEAR(made.opening.area, section, 1e-6 * section) << capped;
        EXPECT_NEAR(made.opening.normal.x, 1, 1e-6);
        EXPECT_NEAR(made.opening.centre.x, cut->point.x, 1e-5 * radius);
        EXPECT_NEAR(checked.volume, section * cut->point.x, 1e-5 * section * length) << capped;
    }
}

TEST(SquareEnds, ACutThatCannotBeIsRefused) {
    const Followed tube(oblique_tube(45, false));
    const std::size_t k = tube.end_at({length, 0, 0});
    Surface surface = tube.checked.surface;
    const auto sentence = [&](const SquareCut& cut) {
        return sentence_of<GeometryError>([&] { cut_end(surface, tube.ends, k, cut); });
    };
    EXPECT_TRUE(has(sentence({1 * mm, {length - 1 * mm, 0, 0}, {1, 0, 0}}), "does not take its whole rim"));
    // A plane along the tube has both ends past it.
    EXPECT_TRUE(has(sentence({1 * mm, {0, 0, -2 * mm}, {0, 0, 1}}), "would take"));
    EXPECT_EQ(surface.triangles.size(), tube.checked.surface.triangles.size());
    EXPECT_FALSE(square_cut_at(tube.cutter, tube.ends[k], length - 0.5 * radius));   // nothing left to tell the way
}

}   // namespace
}   // namespace patency
