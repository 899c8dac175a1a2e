// SPDX-License-Identifier: Apache-2.0
// A stent along a line: on a straight one a rigid motion, on a bent one lengths along the line are kept and places have
// one set of coordinates.
#include "patency/shape/stent_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "patency/base/errors.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/stent_library.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;

// An arc of this radius [m], from the origin along x, bending to y; some length of it.
std::vector<Vec3> arc(double radius, double length, int pieces) {
    std::vector<Vec3> line;
    for (int k = 0; k <= pieces; ++k) {
        const double a = length / radius * k / pieces;
        line.push_back({radius * std::sin(a), radius * (1 - std::cos(a)), 0});
    }
    return line;
}
// A helix: bends and twists.
std::vector<Vec3> helix(double radius, double slope, double angle, int pieces) {
    std::vector<Vec3> line;
    for (int k = 0; k <= pieces; ++k) {
        const double a = angle * k / pieces;
        line.push_back({radius * slope * a, radius * std::cos(a), radius * std::sin(a)});
    }
    return line;
}
double length_of(const std::vector<Vec3>& line) {
    double sum = 0;
    for (std::size_t k = 1; k < line.size(); ++k) sum += norm(line[k] - line[k - 1]);
    return sum;
}

TEST(StentAxis, OnAStraightLineIsARigidMotion) {
    const Vec3 from{1e-3, 2e-3, 3e-3}, direction = normalized(Vec3{1, -2, 0.5});
    std::vector<Vec3> line;
    for (double s : {0.0, 3e-3, 4e-3, 11e-3, 30e-3}) line.push_back(from + s * direction);
    const StentAxis axis(line, 12e-3, 0.4, 10e-3, 1e-3), straight;
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<StentPoint> points;
    for (int k = 0; k < 200; ++k) points.push_back({1e-3 * (1 + unit(engine)), pi * unit(engine), 6e-3 * unit(engine)});
    for (std::size_t k = 0; k < points.size(); ++k) {
        const StentPoint &p = points[k], &q = points[(k + 77) % points.size()];
        ASSERT_NEAR(norm(axis.place(p) - axis.place(q)), norm(straight.place(p) - straight.place(q)), 1e-15);
        ASSERT_NEAR(axis.stretch(p), 1, 1e-12);
        ASSERT_NEAR(dot(axis.place(p) - (from + 12e-3 * direction), direction), p.along, 1e-15);
    }
    // And no reflection.
    const auto orientation = [](const StentAxis& a) {
        const Vec3 o = a.place({0, 0, 0});
        return dot(a.place({0, 0, 1e-3}) - o, cross(a.place({1e-3, 0, 0}) - o, a.place({1e-3, pi / 2, 0}) - o));
    };
    EXPECT_NEAR(orientation(axis), orientation(straight), 1e-20);
    EXPECT_GT(orientation(straight), 0);
}

TEST(StentAxis, PlacesHaveOneSetOfCoordinates) {
    for (const auto& line : {arc(8e-3, 20e-3, 40), helix(5e-3, 0.4, 3, 60)}) {
        const StentAxis axis(line, 0.5 * length_of(line), 0.3, 12e-3, 1e-3);
        std::mt19937 engine(2);
        std::uniform_real_distribution<double> unit(-1, 1);
        for (int k = 0; k < 5000; ++k) {
            const StentPoint p{0.6e-3 * (1 + unit(engine)), 3.14 * unit(engine), 6e-3 * unit(engine)};
            const StentPoint back = axis.coordinates(axis.place(p));
            ASSERT_NEAR(back.radius, p.radius, 1e-14);
            ASSERT_NEAR(back.along, p.along, 1e-13);
            const double turned = std::remainder(back.angle - p.angle, 2 * pi);
            ASSERT_LT(std::abs(turned) * p.radius, 1e-12);
        }
    }
}

TEST(StentAxis, SightIsThatOfTheCoordinatesWhereverItWasSeenLast) {
    const auto line = helix(5e-3, 0.4, 3, 60);
    const StentAxis axis(line, 0.5 * length_of(line), 0.3, 12e-3, 1e-3);
    std::mt19937 engine(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::size_t near = 0;
    for (int k = 0; k < 3000; ++k) {
        const double reach = k % 10 ? 6e-3 : 0.7 * length_of(line);   // now and then past the ends
        const StentPoint p{0.6e-3 * (1 + unit(engine)), 3.14 * unit(engine), reach * unit(engine)};
        const Vec3 x = axis.place(p);
        const StentPoint at = axis.coordinates(x);
        std::size_t anywhere = std::size_t(k) % 59;   // it jumps, and it stays
        const StentAxis::Sight jumped = axis.sight(x, anywhere), seen = axis.sight(x, near),
                               again = axis.sight(x, near);
        EXPECT_EQ(anywhere, near);
        for (const auto& s : {jumped, again}) {
            EXPECT_EQ(s.radius, seen.radius);
            EXPECT_EQ(s.along, seen.along);
            EXPECT_EQ(s.outward, seen.outward);
        }
        ASSERT_NEAR(seen.radius, at.radius, 1e-14);
        ASSERT_NEAR(seen.along, at.along, 1e-13);
        ASSERT_LT(norm(seen.outward - axis.outward(at)) * at.radius, 1e-13);
        ASSERT_LT(norm(seen.tangent - axis.tangent(at)), 1e-11);
    }
}

// Most of a circle, from where much of the line lies behind the plane that it begins at, or in the normal planes of its first pieces.
TEST(StentAxis, APlaceThatWasNotSeenYetIsSeenFromNearby) {
    const double bend = 12e-3;
    const std::vector<Vec3> line = arc(bend, 4.8 * bend, 240);
    const StentAxis axis(line, 4 * bend, 0, 15e-3, 1.5e-3);
    for (double along = -7e-3; along < 7e-3; along += 0.37e-3)
        for (const double angle : {0.0, 1.9, 3.8}) {
            const StentPoint p{1.3e-3, angle, along};
            std::size_t piece = StentAxis::unseen;
            const StentAxis::Sight s = axis.sight(axis.place(p), piece);
            ASSERT_NEAR(s.radius, p.radius, 1e-12);
            ASSERT_NEAR(s.along, p.along, 1e-12);
        }
}

TEST(StentAxis, LengthsAlongTheLineAreKeptAndThoseBesideItStretched) {
    const double bend = 8e-3;
    const std::vector<Vec3> line = arc(bend, 20e-3, 400);
    const StentAxis axis(line, 10e-3, 0, 12e-3, 1e-3);
    const double e = 1e-6;
    for (double along : {-5.03e-3, -1.01e-3, 0.02e-3, 4.42e-3}) {
        EXPECT_NEAR(norm(axis.place({0, 0, along + e}) - axis.place({0, 0, along - e})), 2 * e, 1e-4 * 2 * e);
        for (double angle : {0.0, 0.7, pi, 4.0}) {
            const StentPoint p{1e-3, angle, along};
            const Vec3 centre{0, bend, 0};
            const Vec3 x = axis.place(p);
            // Round the arc's centre everything turns alike: lengths go with the distance from its axis.
            const double expected = std::hypot(x.x - centre.x, x.y - centre.y) / bend;
            EXPECT_NEAR(axis.stretch(p), expected, 2e-4);
            const double step = norm(axis.place({1e-3, angle, along + e}) - axis.place({1e-3, angle, along - e}));
            EXPECT_NEAR(step, 2 * e * expected, 2e-3 * 2 * e);
        }
    }
}

// Its frame does not turn around the line: along a helix, the rotation about the tangent is that of parallel transport.
TEST(StentAxis, TheFrameTurnsAsLittleAsItCan) {
    const StentAxis axis(helix(5e-3, 0.4, 3, 600), 8e-3, 0, 12e-3, 1e-3);
    const double e = 2e-5;
    for (double along = -5e-3; along < 5e-3; along += 1e-3) {
        const StentPoint p{1e-3, 0.5, along}, q{1e-3, 0.5, along + e};
        const Vec3 change = (axis.outward(q) - axis.outward(p)) / e;   // along the tangent only
        EXPECT_LT(norm(change - dot(change, axis.tangent(p)) * axis.tangent(p)),
                  2);   // 1/m, where the curvature is 172/m
        EXPECT_LT(std::abs(dot(change, axis.tangent(p))), 180);
    }
}

TEST(StentAxis, RefusesWhatCannotBe) {
    const auto refused = [](const std::vector<Vec3>& line, double at, const char* word) {
        try {
            StentAxis(line, at, 0, 10e-3, 1e-3);
            ADD_FAILURE() << word;
        } catch (const GeometryError& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    const std::vector<Vec3> straight{{0, 0, 0}, {20e-3, 0, 0}};
    refused(straight, 4e-3, "between 5 and 15 mm");
    refused(straight, 16e-3, "between 5 and 15 mm");
    refused(straight, std::nan(""), "between 5 and 15 mm");
    refused({{0, 0, 0}}, 0, "two different points");
    refused({{0, 0, 0}, {0, 0, 0}}, 0, "two different points");
    refused({{0, 0, 0}, {std::nan(""), 0, 0}}, 0, "not finite");
    refused(arc(0.9e-3, 5e-3, 100), 2.5e-3, "does not lie");
    refused({{0, 0, 0}, {20e-3, 0, 0}, {1e-3, 0, 0}}, 10e-3, "turns back");
    std::vector<Vec3> bend{{0, 0, 0}, {8e-3, 0, 0}};   // a quarter circle of 0.9 mm, then straight on
    for (const Vec3& x : arc(0.9e-3, 0.9e-3 * pi / 2, 30)) bend.push_back(x + Vec3{9e-3, 0, 0});
    bend.push_back({9.9e-3, 9e-3, 0});
    refused(bend, 8e-3, "bends to a radius of 0.9 mm, less than the stent's 1 mm");
    EXPECT_NO_THROW(StentAxis(bend, 8e-3, 0, 10e-3, 0.85e-3));
    std::vector<Vec3> loop = helix(1.2e-3, 0.05, 10, 250);   // bends wide enough, but comes around to itself
    refused(loop, 5e-3, "comes back to itself");
}

TEST(BentStent, IsTheStraightOneBent) {
    StentPattern p = find_stent("paper").pattern;
    p.rings = 3, p.length = 3.8e-3, p.edge_radius = 0;   // the mesh has sharp edges
    const StrutCurves curves = make_strut_curves(p);
    const std::vector<Vec3> line = arc(6e-3, 10e-3, 200);
    const StentAxis axis(line, 5e-3, 0.2, curves.length, outer_radius(curves)), straight;
    const Surface bent = make_stent_surface(curves, axis), plain = make_stent_surface(curves);
    const double v = volume(plain);
    EXPECT_NEAR(volume(bent), v, 5e-3 * v);   // Pappus: the inner side loses what the outer gains
    const SignedDistance metal = make_stent_metal(curves, axis);
    for (std::size_t k = 0; k < bent.points.size(); k += 7)
        // The mesh's step is a sixth of the width. Between struts the distance has a kink; its slope along an edge of the mesh lies
        // between 0 and 1, so that the chord on which a vertex is sought misses it by up to a quarter of the step.
        ASSERT_NEAR(metal.value(bent.points[k]), 0, p.strut_width / 24);
    // Off the metal, walking the distance back ends on it.
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int k = 0; k < 5000; ++k) {
        const Vec3 x = axis.place({1e-3 + 2e-4 * unit(engine), pi * unit(engine), 2e-3 * unit(engine)});
        const DistanceSample s = metal.sample(x);
        ASSERT_NEAR(norm(s.gradient), 1, 1e-9);
        if (s.value > 0 && s.value < p.strut_width) {
            ASSERT_NEAR(metal.value(x - s.value * s.gradient), 0, 0.01 * p.strut_width);
        }
    }
    // Rings keep their distance along the line.
    const Vec3 first = axis.place({0, 0, -1e-3}), last = axis.place({0, 0, 1e-3});
    EXPECT_NEAR(norm(last - first), 2 * 6e-3 * std::sin(1e-3 / 6e-3), 1e-8);
}

}   // namespace
}   // namespace patency
