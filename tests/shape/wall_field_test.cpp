// SPDX-License-Identifier: Apache-2.0
// The wall as a body: its faces where the rules put them, cut across, whole at bifurcations.
#include "patency/shape/wall_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"
#include "patency/shape/flat_loop.h"
#include "patency/shape/wall_face.h"
#include "patency/shape/wall_thickness.h"

namespace patency {
namespace {

Centreline straight(const Vec3& from, const Vec3& to, double radius, const std::string& outlet) {
    Centreline line{outlet};
    const double length = norm(to - from);
    const int n = int(std::ceil(length / 0.5e-3));
    for (int k = 0; k <= n; ++k)
        line.points.push_back({from + (double(k) / n) * (to - from), normalized(to - from), radius, length * k / n});
    return line;
}
Centreline followed_by(Centreline a, const Centreline& b) {
    const double arc = a.length();
    for (std::size_t k = 1; k < b.points.size(); ++k) a.points.push_back(b.points[k]), a.points.back().arc += arc;
    a.outlet = b.outlet;
    return a;
}
std::vector<std::vector<double>> diameters(const BranchedLines& lines, double diameter) {
    std::vector<std::vector<double>> d;
    for (const Centreline& line : lines.lines) d.emplace_back(line.points.size(), diameter);
    return d;
}

const double R = 1.5e-3;
BranchedLines tube() { return find_branches({straight({0, 0, 0}, {20e-3, 0, 0}, R, "outlet")}); }
WallField tube_wall(WallSettings settings, double lumen_radius = R) {
    const BranchedLines lines = tube();
    return {lines, diameters(lines, 2 * R), {{-1, 0, 0}, {1, 0, 0}}, round_tube(lumen_radius), settings};
}

TEST(WallField, FollowsTheLumenWithTheThicknessOfItsHealthyDiameter) {
    const WallField wall = tube_wall({.line = 0, .from = 8e-3, .to = 12e-3, .reach = 3e-3});
    const double t = coronary_wall_thickness(2 * R);
    EXPECT_DOUBLE_EQ(wall.thinnest(), t);
    for (const double angle : {0.3, 2.0, 4.0}) {
        const auto value = [&](double r, double x) {
            return wall.value({x, r * std::cos(angle), r * std::sin(angle)});
        };
        EXPECT_NEAR(value(R, 10e-3), 0, 1e-12);
        EXPECT_NEAR(value(R + t, 10e-3), 0, 1e-12);
        EXPECT_NEAR(value(R + t / 2, 10e-3), -t / 2, 1e-12);
        EXPECT_GT(value(0.9 * R, 10e-3), 0);
        EXPECT_GT(value(R + 1.1 * t, 10e-3), 0);
    }
    ASSERT_EQ(wall.ends().size(), 2u);   // at 5 and 15 mm, on points of the line
    EXPECT_NEAR(wall.value({4.5e-3, R + t / 2, 0}), 0.5e-3, 1e-9);
    EXPECT_NEAR(wall.value({15.2e-3, R + t / 2, 0}), 0.2e-3, 1e-9);
    EXPECT_GT(wall.value({1e-3, R + t / 2, 0}), 0);
    for (const VesselEnd& end : wall.ends()) EXPECT_FALSE(end.is_opening);
}

TEST(WallField, TakesAThicknessThatIsGivenAndEndsAtOpenings) {
    const WallField wall = tube_wall({.thickness = 0.5e-3, .line = 0, .from = 2e-3, .to = 12e-3, .reach = 30e-3});
    EXPECT_DOUBLE_EQ(wall.thinnest(), 0.5e-3);
    EXPECT_NEAR(wall.value({10e-3, 0, R + 0.5e-3}), 0, 1e-12);
    ASSERT_EQ(wall.ends().size(), 2u);
    for (const VesselEnd& end : wall.ends()) EXPECT_TRUE(end.is_opening);
    EXPECT_NEAR(wall.value({-0.1e-3, R + 0.2e-3, 0}), 0.1e-3, 1e-12);
    EXPECT_NEAR(wall.value({20.1e-3, R + 0.2e-3, 0}), 0.1e-3, 1e-12);
    EXPECT_THROW(tube_wall({.thickness = -1e-3, .line = 0, .from = 2e-3, .to = 12e-3}), GeometryError);
}

TEST(WallField, PlaqueFillsFromTheLumenToTheHealthyOne) {
    const double t = coronary_wall_thickness(2 * R), narrow = 0.8e-3;
    const WallField filled =
        tube_wall({.is_filled = true, .line = 0, .from = 8e-3, .to = 12e-3, .reach = 3e-3}, narrow);
    const WallField thin = tube_wall({.line = 0, .from = 8e-3, .to = 12e-3, .reach = 3e-3}, narrow);
    EXPECT_NEAR(filled.value({10e-3, narrow, 0}), 0, 1e-12);
    EXPECT_NEAR(filled.value({10e-3, R + t, 0}), 0, 1e-9);
    EXPECT_LT(filled.at({10e-3, 1.2e-3, 0}).healthy, 0);
    EXPECT_NEAR(thin.value({10e-3, narrow + t, 0}), 0, 1e-12);
    EXPECT_GT(filled.at({10e-3, R + 0.1e-3, 0}).healthy, 0);
}

TEST(WallField, IsWholeAtABifurcation) {
    const Centreline trunk = straight({0, 0, 0}, {12e-3, 0, 0}, R, "a");
    const Vec3 up = {12e-3 + 12e-3, 9e-3, 0}, down = {12e-3 + 12e-3, -9e-3, 0};
    const BranchedLines y = find_branches({followed_by(trunk, straight({12e-3, 0, 0}, up, 1.2e-3, "a")),
                                           followed_by(trunk, straight({12e-3, 0, 0}, down, 1.2e-3, "b"))});
    const SignedDistance lumen = union_of_round_cones(
        {{{0, 0, 0}, {12e-3, 0, 0}, R, R}, {{12e-3, 0, 0}, up, 1.2e-3, 1.2e-3}, {{12e-3, 0, 0}, down, 1.2e-3, 1.2e-3}});
    std::vector<std::vector<double>> healthy;
    for (const Centreline& line : y.lines) {
        healthy.emplace_back();
        for (const CentrelinePoint& p : line.points) healthy.back().push_back(2 * p.radius);
    }
    // Reaching into the bifurcation takes all of it in: one end upstream, one in each branch.
    const WallField wall(y, healthy,
                         {{-1, 0, 0}, normalized(up - Vec3{12e-3, 0, 0}), normalized(down - Vec3{12e-3, 0, 0})}, lumen,
                         {.line = 0, .from = 5e-3, .to = 9e-3, .reach = 2.5e-3});
    ASSERT_EQ(wall.ends().size(), 3u);
    // A plane just behind it would cut where the walls of both branches are one.
    const WallField behind(y, healthy,
                           {{-1, 0, 0}, normalized(up - Vec3{12e-3, 0, 0}), normalized(down - Vec3{12e-3, 0, 0})},
                           lumen, {.line = 0, .from = 18e-3, .to = 20e-3, .reach = 3e-3});
    EXPECT_EQ(behind.ends().size(), 3u);
    EXPECT_LT(behind.value(Vec3{12e-3, R + 0.3e-3, 0}), 0);
    // On the outer side of both branches the wall is there, in the crotch it is, and nothing of it stands in the blood.
    const double t = coronary_wall_thickness(2.4e-3);
    for (const Vec3& end : {up, down}) {
        const Vec3 along = normalized(end - Vec3{12e-3, 0, 0}), out = {-along.y, along.x, 0};
        const double side = end.y > 0 ? 1 : -1;
        EXPECT_NEAR(wall.value(Vec3{12e-3, 0, 0} + 2e-3 * along + (side * (1.2e-3 + t / 2)) * out), -t / 2, 0.1 * t);
    }
    const Vec3 crotch = {12e-3 + 1.2e-3 / 0.6 + t / 3, 0, 0};
    EXPECT_LT(wall.value(crotch), 0);
    EXPECT_GT(wall.value({12e-3, 0, 0}), 0);
    EXPECT_GT(wall.value(up), 0);   // cut before
    // Its faces are closed but for the three ends.
    const double size = 0.25e-3;
    for (const WallFace face : {WallFace::lumen, WallFace::outer}) {
        const Surface s = wall_face(wall, face, size);
        EXPECT_EQ(find_loops(s, boundary_edges(edge_uses(s))).size(), 3u);
        for (const Vec3& x : s.points) {
            const WallPlace p = wall.at(x);
            EXPECT_LT(p.region, size);
            EXPECT_NEAR(face == WallFace::lumen ? p.lumen : p.lumen - p.thickness, 0, 0.02 * size);
        }
    }
}

TEST(WallFace, LooksOutOfTheWall) {
    const WallField wall = tube_wall({.thickness = 0.8e-3, .line = 0, .from = 8e-3, .to = 12e-3, .reach = 3e-3});
    const Surface lumen = wall_face(wall, WallFace::lumen, 0.2e-3), outer = wall_face(wall, WallFace::outer, 0.2e-3);
    const auto radial = [](const Vec3& x) { return Vec3{0, x.y, x.z}; };
    for (const Triangle& t : lumen.triangles) EXPECT_LT(dot(area_vector(lumen, t), radial(centroid(lumen, t))), 0);
    for (const Triangle& t : outer.triangles) EXPECT_GT(dot(area_vector(outer, t), radial(centroid(outer, t))), 0);
    EXPECT_NEAR(area(lumen), 2 * std::numbers::pi * R * 10e-3, 0.05 * area(lumen));
}

}   // namespace
}   // namespace patency
