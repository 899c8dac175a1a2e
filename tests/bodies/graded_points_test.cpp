// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/graded_points.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "patency/base/errors.h"
#include "patency/bodies/graded_rows.h"
#include "patency/shape/distance_shapes.h"

namespace patency {

namespace {

constexpr SpacingSettings graded{.smallest = 0.08e-3, .largest = 0.5e-3, .across = 10};

Lumen taper() { return make_cone({.length = 8e-3, .inlet_radius = 1.6e-3, .outlet_radius = 0.5e-3}); }

}   // namespace

TEST(GradedRows, HoldAllNeighboursAndNobodyElse) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> place(0, 1);
    std::vector<Vec3> points;
    std::vector<double> spacing;
    for (int n = 0; n < 1003; ++n) {
        const double a = place(engine), b = place(engine), c = place(engine);
        points.push_back({a, b, c});
        spacing.push_back(0.03 + 0.1 * a);
    }
    std::sort(points.begin(), points.end(), [](const Vec3& p, const Vec3& q) { return p.z < q.z; });
    const double reach = 2.9;
    GradedRows rows;
    rows.find(points, spacing, reach);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const auto row = rows.row(i);
        ASSERT_EQ(row.size() % GradedRows::lanes, 0u);
        std::vector<std::uint32_t> is(row.begin(), row.end()), must;
        std::erase(is, std::uint32_t(points.size()));
        for (std::uint32_t j = 0; j < points.size(); ++j)
            if (norm(points[i] - points[j]) < 0.5 * reach * (spacing[i] + spacing[j]) * (1 - 1e-6)) must.push_back(j);
        ASSERT_TRUE(std::is_sorted(is.begin(), is.end()));
        ASSERT_TRUE(std::includes(is.begin(), is.end(), must.begin(), must.end())) << i;
        ASSERT_LE(is.size(), must.size() + 1);   // one may lie on the edge, in float
    }
}

TEST(GradedPoints, AreEvenInsideAndAsFarApartAsTheFieldAsks) {
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);   // the sets are small, and the machine may be shared
    const double c = std::cos(0.6), s = std::sin(0.6);
    const Lumen fork = make_branches(
        {.branches =
             {{.points = {{-4e-3, 0, 0}, {0, 0, 0}}, .radii = {1.5e-3, 1.4e-3}, .start = "inlet", .end = ""},
              {.points = {{0, 0, 0}, {6e-3 * c, 6e-3 * s, 0}}, .radii = {1.2e-3, 0.9e-3}, .start = "", .end = "left"},
              {.points = {{0, 0, 0}, {6e-3 * c, -6e-3 * s, 0}}, .radii = {1e-3, 0.5e-3}, .start = "", .end = "right"}},
         .extension = 4e-3});
    for (const Lumen& lumen : {taper(), fork}) {
        const SpacingField field = make_spacing_field(lumen, graded);
        RelaxQuality q;
        const GradedPoints p = make_graded_points(lumen, field, {}, &q);
        const std::size_t n = p.points.size();
        double volume = 0, nearest_mean = 0, nearest_square = 0, jump = 0, ratio = 1;
        GradedRows rows;
        rows.find(p.points, p.spacing, 2);
        for (std::size_t i = 0; i < n; ++i) {
            ASSERT_TRUE(contains(lumen, p.points[i]));
            ASSERT_LE(lumen.distance.value(p.points[i]), -0.25 * p.spacing[i]);
            ASSERT_NEAR(p.spacing[i] / field(p.points[i]), p.spacing[0] / field(p.points[0]), 1e-9);   // one factor
            EXPECT_NEAR(p.spacing[i] / field(p.points[i]), 1, 0.03);
            volume += std::pow(p.spacing[i], 3);
            double nearest = 1e9;
            for (const std::uint32_t j : rows.row(i)) {
                if (j == n || j == i) continue;
                nearest = std::min(nearest, 2 * norm(p.points[i] - p.points[j]) / (p.spacing[i] + p.spacing[j]));
                ratio = std::max(ratio, p.spacing[j] / p.spacing[i]);
            }
            nearest_mean += nearest / double(n), nearest_square += nearest * nearest / double(n);
            if (i > 0) jump += norm(p.points[i] - p.points[i - 1]) / p.spacing[i] / double(n);
            EXPECT_GT(nearest, 0.6);
        }
        std::printf(
            "    %6zu points: density %.4f +- %.2f %% (largest %.2f %%), nearest neighbour at %.3f +- %.3f spacings\n",
            n, q.mean_density, 100 * q.density_spread, 100 * q.largest_density_error, nearest_mean,
            std::sqrt(nearest_square - nearest_mean * nearest_mean));
        EXPECT_NEAR(volume, lumen.volume, 1e-9 * lumen.volume);
        EXPECT_NEAR(q.mean_density, 1, 0.02);
        EXPECT_LT(q.density_spread, 0.01);
        EXPECT_LT(q.largest_density_error, 0.08);   // in the crotch of the branches
        // Between the cubic lattice's and the densest packing's.
        EXPECT_GT(nearest_mean, 0.9);
        EXPECT_LT(nearest_mean, 1.13);
        const double growth = 1.3 * graded.growth;       // of the field: see its test
        EXPECT_LT(ratio, (1 + growth) / (1 - growth));   // within two mean spacings
        EXPECT_LT(jump, 4);                              // neighbours in space are neighbours in memory
        // Along the vessel: the first points lie at the first opening, the last farthest from it.
        EXPECT_GT(opening_coordinates(lumen.openings[0], p.points[0]).s, -p.spacing[0]);
        EXPECT_LT(opening_coordinates(lumen.openings[0], p.points[n - 1]).s, -4e-3);
    }
    omp_set_num_threads(threads);
}

/// The tapering vessel with boxes that stand out of its wall, as deep as that along z.
Lumen with_pockets(Lumen lumen, const std::vector<SignedDistance>& pockets, double depth) {
    const SignedDistance vessel = lumen.distance;
    lumen.bounds.high.z = depth;
    lumen.distance = {[=](const Vec3& x) {
                          DistanceSample deepest = vessel.sample(x);
                          for (const SignedDistance& pocket : pockets)
                              if (const DistanceSample there = pocket.sample(x); there.value < deepest.value)
                                  deepest = there;
                          return deepest;
                      },
                      lumen.bounds};
    return lumen;
}

/// In mean spacings of the pair.
double nearest_pair(const GradedPoints& p) {
    GradedRows rows;
    rows.find(p.points, p.spacing, 1);
    double nearest = 1;
    for (std::size_t i = 0; i < p.points.size(); ++i)
        for (const std::uint32_t j : rows.row(i))
            if (j != i && j < p.points.size())
                nearest = std::min(nearest, 2 * norm(p.points[i] - p.points[j]) / (p.spacing[i] + p.spacing[j]));
    return nearest;
}

std::size_t count_above(const GradedPoints& p, double z) {
    return std::size_t(std::count_if(p.points.begin(), p.points.end(), [&](const Vec3& x) { return x.z > z; }));
}

// Narrow pockets in the wall, one and a half spacings wide.
TEST(GradedPoints, StandApartInPocketsOfTheWall) {
    const double width = 0.45e-3, depth = 3.5e-3;
    std::vector<SignedDistance> pockets;
    for (double x = 1e-3; x < 3e-3; x += 1e-3)
        pockets.push_back(box_between({x, -width / 2, 0}, {x + width, width / 2, depth}));
    const Lumen lumen = with_pockets(taper(), pockets, depth);
    const GradedPoints p = make_graded_points(lumen, make_spacing_field(lumen, graded));
    EXPECT_GT(count_above(p, 1.7e-3), 10u);
    EXPECT_GT(nearest_pair(p), 0.5);
}

// Into a slit of two layers, each of which sees its own wall alone, points would press for ever, were all taken out that are pressed together.
TEST(GradedPoints, DoNotFollowEachOtherIntoASlit) {
    const double width = 0.7e-3, spacing = 0.3e-3, depth = 6e-3;
    const SignedDistance slit = box_between({1e-3, -width / 2, 0}, {7e-3, width / 2, depth});
    Lumen lumen = with_pockets(taper(), {slit}, depth);
    lumen.volume += 6e-3 * width * (depth - 1.1e-3);   // above the taper, whose mean radius that is
    const SpacingField field =
        make_spacing_field(lumen, {.smallest = 0.999 * spacing, .largest = spacing, .across = 10});
    const GradedPoints p = make_graded_points(lumen, field);
    EXPECT_GT(count_above(p, 1.7e-3), 300u);
    EXPECT_GT(nearest_pair(p), 0.5);
    EXPECT_LT(p.spacing[0] / spacing, 1.02);   // all grow for those that are missing
}

// A distance may answer for places far from the wall with the least that it may say.
TEST(GradedPoints, NeedNoDistanceFarFromTheWall) {
    Lumen whole = taper(), frugal = whole;
    const SignedDistance distance = whole.distance;
    int far = 0;
    frugal.distance = {[&](const Vec3& x) { return distance.sample(x); }, distance.bounds(),
                       [&](const Vec3& x, double reach) {
                           const DistanceSample s = distance.sample(x);
                           if (std::abs(s.value) < reach) return s;
                           EXPECT_LT(s.value, 0);   // nobody asks about places far outside
#pragma omp atomic
                           ++far;
                           return DistanceSample{-reach, {}, 0};
                       }};
    const SpacingField field = make_spacing_field(whole, graded);
    const GradedPoints must = make_graded_points(whole, field), is = make_graded_points(frugal, field);
    EXPECT_GT(far, 500);
    ASSERT_EQ(is.points.size(), must.points.size());
    double largest = 0;
    for (std::size_t i = 0; i < is.points.size(); ++i)
        largest = std::max(largest, norm(is.points[i] - must.points[i]) / must.spacing[i]);
    EXPECT_LT(largest, 0.02);
}

TEST(GradedPoints, AreTheSameBitsForAnotherNumberOfThreads) {
    const Lumen lumen = taper();
    const SpacingField field = make_spacing_field(lumen, graded);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const GradedPoints one = make_graded_points(lumen, field, {.steps = 20});
    omp_set_num_threads(3);
    const GradedPoints three = make_graded_points(lumen, field, {.steps = 20});
    omp_set_num_threads(threads);
    EXPECT_EQ(one.points, three.points);
    EXPECT_EQ(one.spacing, three.spacing);
}

TEST(GradedPoints, AreRefusedWhereTheyMakeNoSense) {
    const Lumen lumen = taper();
    const SpacingField field = make_spacing_field(lumen, graded);
    EXPECT_THROW(make_graded_points(lumen, field, {.clearance = 2}), GeometryError);
    EXPECT_THROW(make_graded_points(make_channel({.length = 1, .gap = 0.1}), field), GeometryError);
    const Lumen tiny = make_tube({.length = 0.1e-3, .radius = 0.1e-3});
    EXPECT_THROW(make_graded_points(tiny, field), GeometryError);
}

}   // namespace patency
