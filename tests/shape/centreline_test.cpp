// SPDX-License-Identifier: Apache-2.0
// Centrelines of lumens whose axes are known: bars of 1 % at a twelfth of a diameter.
#include "patency/shape/centreline.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/branches.h"
#include "patency/shape/exact_distance.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

constexpr double R = 1e-3;   // m, of the tubes

/// The distance as a grid of voxels sees it: linear in between, gradients by differences over two.
SignedDistance on_voxels(const SignedDistance& exact, double voxel) {
    const Bounds box = grown(exact.bounds(), 3 * voxel);
    const Vec3 size = (box.high - box.low) / voxel;
    const int nx = int(size.x) + 2, ny = int(size.y) + 2, nz = int(size.z) + 2;
    std::vector<double> values;
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
            for (int k = 0; k < nz; ++k)
                values.push_back(exact.value(box.low + voxel * Vec3{double(i), double(j), double(k)}));
    const auto value = [=](const Vec3& x) {
        const Vec3 q = (x - box.low) / voxel;
        const auto split = [](double at, int count) {
            const int cell = std::clamp(int(std::floor(at)), 0, count - 2);
            return std::pair(cell, std::clamp(at - cell, 0.0, 1.0));
        };
        const auto [i, a] = split(q.x, nx);
        const auto [j, b] = split(q.y, ny);
        const auto [k, c] = split(q.z, nz);
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const int di = corner >> 2, dj = corner >> 1 & 1, dk = corner & 1;
            sum += (di ? a : 1 - a) * (dj ? b : 1 - b) * (dk ? c : 1 - c) *
                   values[(std::size_t(i + di) * std::size_t(ny) + std::size_t(j + dj)) * std::size_t(nz) +
                          std::size_t(k + dk)];
        }
        return sum;
    };
    return {[=](const Vec3& x) {
                const Vec3 g{value(x + Vec3{voxel, 0, 0}) - value(x - Vec3{voxel, 0, 0}),
                             value(x + Vec3{0, voxel, 0}) - value(x - Vec3{0, voxel, 0}),
                             value(x + Vec3{0, 0, voxel}) - value(x - Vec3{0, 0, voxel})};
                return DistanceSample{value(x), norm(g) > 0 ? normalized(g) : Vec3{1, 0, 0}, 0};
            },
            exact.bounds()};
}

Opening round_opening(const char* name, const Vec3& centre, const Vec3& normal, double radius) {
    return {name, centre, normal, std::numbers::pi * radius * radius, radius, radius, false, radius * radius / 2};
}

/// Distances from the axis and errors of the radius, the largest over all points, as shares of R.
template <class AxisDistance>
std::pair<double, double> errors(const Centreline& line, AxisDistance from_axis) {
    double off = 0, radius = 0;
    for (const CentrelinePoint& p : line.points) {
        off = std::max(off, from_axis(p.place) / R);
        radius = std::max(radius, std::abs(p.radius / R - 1));
    }
    return {off, radius};
}

TEST(Centreline, OfATubeIsItsAxisInAnyDirection) {
    const Lumen tube = make_tube({.length = 12 * R, .radius = R});
    for (const RigidMotion& motion : {RigidMotion{}, motion_along({1, 2, 3}, {5e-3, -1e-3, 2e-3})}) {
        const Lumen lumen = moved(tube, motion);
        const auto lines = find_centrelines(lumen.distance, lumen.openings);
        ASSERT_EQ(lines.size(), 1u);
        const auto [off, radius] = errors(lines[0], [&](const Vec3& x) {
            const Vec3 y = motion.place_back(x);
            return std::hypot(y.y, y.z);
        });
        EXPECT_LT(off, 1e-3);
        EXPECT_LT(radius, 1e-3);
        EXPECT_NEAR(lines[0].length(), 12 * R, 1e-6 * R);
        EXPECT_LT(norm(lines[0].points.back().tangent - lumen.openings[1].normal), 1e-12);
        EXPECT_LT(norm(lines[0].points.front().tangent + lumen.openings[0].normal), 1e-12);
    }
}

TEST(Centreline, OfACappedTorusOnVoxelsOfATwelfthIsWithin1Percent) {
    const double large = 4 * R;
    const SignedDistance torus(
        [=](const Vec3& x) {
            const double q = std::hypot(x.x, x.y);
            const Vec3 axis = q > 0 ? Vec3{large * x.x / q, large * x.y / q, 0} : Vec3{large, 0, 0}, d = x - axis;
            const double r = norm(d);
            return DistanceSample{r - R, r > 0 ? d / r : Vec3{0, 0, 1}, 0};
        },
        {{-large - R, 0, -R}, {large + R, large + R, R}});
    const SignedDistance capped = intersection_of(torus, half_space({}, {0, -1, 0}));
    const std::vector<Opening> ends{round_opening("inlet", {large, 0, 0}, {0, -1, 0}, R),
                                    round_opening("outlet", {-large, 0, 0}, {0, -1, 0}, R)};
    for (const SignedDistance& distance : {capped, on_voxels(capped, 2 * R / 12)}) {
        const auto lines = find_centrelines(distance, ends);
        const auto [off, radius] =
            errors(lines[0], [&](const Vec3& x) { return std::hypot(std::hypot(x.x, x.y) - large, x.z); });
        EXPECT_LT(off, 0.01);
        EXPECT_LT(radius, 0.01);
        // Chords of half a radius fall short by (1/8)^2 / 24 = 0.07 %.
        EXPECT_NEAR(lines[0].length(), std::numbers::pi * large, 0.002 * std::numbers::pi * large);
    }
}

/// A trunk along x that parts in the plane z = 0 into branches of 0.75 and 0.5 R.
Lumen make_y() {
    return make_branches({{{{{}, {10 * R, 0, 0}}, {R, R}, "inlet", ""},
                           {{{10 * R, 0, 0}, {17 * R, 7 * R, 0}}, {0.75 * R, 0.75 * R}, "", "outlet_1"},
                           {{{10 * R, 0, 0}, {18 * R, -4 * R, 0}}, {0.5 * R, 0.5 * R}, "", "outlet_2"}},
                          4 * R});
}

TEST(Centreline, OfAYFollowsItsTubesAndSharesTheTrunk) {
    const Lumen y = make_y();
    for (const SignedDistance& distance : {y.distance, on_voxels(y.distance, R / 12)}) {
        const BranchedLines vessel = find_branches(find_centrelines(distance, y.openings));
        ASSERT_EQ(vessel.branches.size(), 3u);
        const Vec3 parting{10 * R, 0, 0};
        const Vec3 direction[] = {{1, 0, 0}, normalized(Vec3{1, 1, 0}), normalized(Vec3{2, -1, 0})};
        const double radius[] = {R, 0.75 * R, 0.5 * R};
        for (std::size_t b = 0; b < 3; ++b) {
            const Branch& branch = vessel.branches[b];
            EXPECT_EQ(branch.parent, b == 0 ? -1 : 0);
            EXPECT_EQ(branch.lines.size(), b == 0 ? 2u : 1u);
            for (std::size_t k = branch.first; k <= branch.last; ++k) {
                const CentrelinePoint& p = vessel.point(branch, k);
                if (norm(p.place - parting) < 3 * R) continue;   // where the tubes still meet
                EXPECT_LT(norm(cross(p.place - parting, direction[b])), 0.01 * radius[b]) << b << ' ' << k;
                EXPECT_NEAR(p.radius, radius[b], 0.01 * radius[b]) << b << ' ' << k;
            }
        }
        const std::size_t shared = shared_points(vessel.lines[0], vessel.lines[1]);
        EXPECT_GT(vessel.lines[0].points[shared].arc, 8 * R);
        EXPECT_LT(vessel.lines[0].points[shared].arc, 13 * R);
        for (std::size_t j = 0; j < 2; ++j)
            for (std::size_t k = 0; k < vessel.lines[j].points.size(); ++k)
                EXPECT_EQ(vessel.branch_ids[j][k] < 0, vessel.bifurcation_ids[j][k] == 0) << "one or the other";
    }
}

TEST(Centreline, IsTheSameForAnyNumberOfThreads) {
    const Lumen y = make_y();
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const auto one = find_centrelines(y.distance, y.openings);
    omp_set_num_threads(3);
    const auto three = find_centrelines(y.distance, y.openings);
    omp_set_num_threads(threads);
    for (std::size_t j = 0; j < 2; ++j) {
        ASSERT_EQ(one[j].points.size(), three[j].points.size());
        for (std::size_t k = 0; k < one[j].points.size(); ++k) {
            EXPECT_EQ(one[j].points[k].place, three[j].points[k].place);
            EXPECT_EQ(one[j].points[k].radius, three[j].points[k].radius);
        }
    }
}

TEST(Centreline, DoesNotLoseANarrowThroat) {
    // A tenth of the width over a third of it: the cells must become small there, and only there.
    const Lumen nozzle =
        make_nozzle({{{0, R}, {5 * R, R}, {6 * R, 0.1 * R}, {6.3 * R, 0.1 * R}, {8 * R, R}, {14 * R, R}}});
    const auto lines = find_centrelines(nozzle.distance, nozzle.openings);
    const auto throat = std::min_element(lines[0].points.begin(), lines[0].points.end(),
                                         [](const auto& a, const auto& b) { return a.radius < b.radius; });
    EXPECT_NEAR(throat->radius, 0.1 * R, 0.001 * R);
    EXPECT_GT(throat->place.x, 5.9 * R);
    EXPECT_LT(throat->place.x, 6.4 * R);
    EXPECT_NEAR(lines[0].length(), 14 * R, 0.01 * R);
}

TEST(Centreline, NeverLeaksToANeighbour) {
    // A hairpin whose legs are a twentieth of a diameter apart: the way is around the bend.
    const double apart = 1.05 * R;
    const Lumen hairpin =
        make_branches({{{{{0, apart, 0}, {10 * R, apart, 0}, {12 * R, 0, 0}, {10 * R, -apart, 0}, {0, -apart, 0}},
                         {R, R, R, R, R},
                         "inlet",
                         "outlet"}},
                       2 * R});
    EXPECT_GT(find_centrelines(hairpin.distance, hairpin.openings)[0].length(), 20 * R);
}

TEST(Centreline, SaysWhichOutletCannotBeReached) {
    const Lumen a = make_tube({.length = 5 * R, .radius = R});
    const SignedDistance parts = union_of(body_of_revolution({{0, R}, {5 * R, R}}, TubeEnds::capped),
                                          body_of_revolution({{6 * R, R}, {9 * R, R}}, TubeEnds::capped));
    const std::vector<Opening> ends{a.openings[0], round_opening("far", {9 * R, 0, 0}, {1, 0, 0}, R)};
    try {
        find_centrelines(parts, ends);
        ADD_FAILURE() << "a way through the wall";
    } catch (const GeometryError& e) {
        EXPECT_NE(std::string(e.what()).find("far"), std::string::npos);
    }
    EXPECT_THROW(find_centrelines(a.distance, {a.openings[0]}), GeometryError);
    EXPECT_THROW(find_centrelines(a.distance, {a.openings[0], round_opening("off", {5 * R, 3 * R, 0}, {1, 0, 0}, R)}),
                 GeometryError);
}

TEST(ExactDistance, IsThatOfABoxAndOfATubesCorners) {
    Surface box;
    for (int k = 0; k < 8; ++k) box.points.push_back({double(k & 1), double(k >> 1 & 1), double(k >> 2)});
    box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const SignedDistance exact = make_exact_distance(box), formula = box_between({}, {1, 1, 1});
    for (double x = -0.7; x < 2; x += 0.171)
        for (double y = -0.7; y < 2; y += 0.173)
            for (double z = -0.7; z < 2; z += 0.177) {
                const DistanceSample a = exact.sample({x, y, z}), b = formula.sample({x, y, z});
                ASSERT_NEAR(a.value, b.value, 1e-12) << x << ' ' << y << ' ' << z;
                ASSERT_LT(norm(a.gradient - b.gradient), 1e-9) << x << ' ' << y << ' ' << z;
            }
    box.triangles.pop_back();
    EXPECT_THROW(make_exact_distance(box), GeometryError);
}

TEST(Branches, TakeTheNamesOfCurves) {
    const Lumen y = make_y();
    BranchedLines vessel = find_branches(find_centrelines(y.distance, y.openings));
    const std::vector<NamedCurve> curves{{"side", {{10 * R, 0, 0}, {18 * R, -4 * R, 0}}},
                                         {"main", {{}, {10 * R, 0, 0}, {17 * R, 7 * R, 0}}}};
    name_branches(vessel, curves);
    EXPECT_EQ(vessel.branches[0].name, "main");
    EXPECT_EQ(vessel.branches[1].name, "main_2");
    EXPECT_EQ(vessel.branches[2].name, "side");
}

TEST(Branches, TakeTheNamesOfPointsWithinThem) {
    const Lumen y = make_y();
    BranchedLines vessel = find_branches(find_centrelines(y.distance, y.openings));
    const auto in = [&](std::size_t b) {   // not on the axis, but within
        const CentrelinePoint& middle =
            vessel.point(vessel.branches[b], (vessel.branches[b].first + vessel.branches[b].last) / 2);
        return middle.place + Vec3{0, 0, 0.9 * middle.radius};
    };
    for (std::size_t b = 0; b < 3; ++b) EXPECT_EQ(branch_around(vessel, in(b)), b);
    name_branches(vessel, std::map<std::string, Vec3>{
                              {"branch_3", in(0)}, {"side", in(2)}, {"branch_1", in(1)}});   // names may change places
    EXPECT_EQ(vessel.branches[0].name, "branch_3");
    EXPECT_EQ(vessel.branches[1].name, "branch_1");
    EXPECT_EQ(vessel.branches[2].name, "side");
}

TEST(Branches, TakeNoNameThatWouldLie) {
    const Lumen y = make_y();
    const BranchedLines vessel = find_branches(find_centrelines(y.distance, y.openings));
    const Vec3 trunk = vessel.point(vessel.branches[0], vessel.branches[0].last / 2).place,
               outside = trunk + Vec3{0, 0, 1.2 * vessel.point(vessel.branches[0], 0).radius};
    EXPECT_FALSE(branch_around(vessel, outside));
    const auto refuses = [&](const std::map<std::string, Vec3>& points, const std::string& why) {
        BranchedLines named = vessel;
        try {
            name_branches(named, points);
            ADD_FAILURE() << why;
        } catch (const UsageError& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    };
    refuses({{"a", outside}}, "lies in no branch");
    refuses({{"a", trunk}, {"b", trunk}}, "in the same branch");
    refuses({{"branch_2", trunk}}, "two branches would be 'branch_2'");
}

TEST(Branches, TheNormalOfAVesselIsThatOfThePlaneItLiesIn) {
    const Vec3 normal = normalized(Vec3{1, 2, 2}), a = normalized(cross(normal, {0, 0, 1})), b = cross(normal, a);
    BranchedLines vessel;
    vessel.lines.resize(2);
    for (int k = 0; k < 20; ++k) {
        const double s = 1e-3 * k;
        vessel.lines[0].points.push_back({Vec3{0.1, 0.2, 0.3} + s * a + 3 * s * s * b, a, 1e-3, s});
        vessel.lines[1].points.push_back({Vec3{0.1, 0.2, 0.3} + s * b, b, 1e-3, s});
    }
    EXPECT_NEAR(std::abs(dot(normal_of(vessel), normal)), 1, 1e-9);
}

}   // namespace
}   // namespace patency
