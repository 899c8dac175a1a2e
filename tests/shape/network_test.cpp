// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/measure.h"
#include "patency/shape/network_field.h"
#include "patency/shape/network_lumen.h"
#include "patency/shape/surface_check.h"
#include "tests/shape/laws.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double mm = 1e-3;

Tube straight(std::string name, const Vec3& from, const Vec3& to, double r, int pieces = 1) {
    Tube tube{.name = std::move(name), .points = {}, .radii = {}};
    for (int k = 0; k <= pieces; ++k) {
        tube.points.push_back(mm * (from + (double(k) / pieces) * (to - from)));
        tube.radii.push_back(mm * r);
    }
    return tube;
}

/// A T of equal tubes, 12 mm long and 7 mm to the side, turned in space.
constexpr double t_radius = 1.5, t_length = 12, t_side = 7;
Network make_t(double blend = 0) {
    const RigidMotion tilt = motion_along({1, 2, -0.5}, {3, -2, 1});
    Network network{.tubes = {straight("main", tilt.place({-5, 0, 0}), tilt.place({t_length - 5, 0, 0}), t_radius),
                              straight("side", tilt.place({}), tilt.place({0, t_side, 0}), t_radius)},
                    .blend = mm * blend};
    open_free_ends(network);
    return network;
}
// Two equal round tubes across share a solid of 16/3 r^3 with 8 r^2 of wall from each; the side tube only half of it.
const double t_volume = pi * t_radius * t_radius * (t_length + t_side) - 8 / 3.0 * std::pow(t_radius, 3);
const double t_area = 2 * pi * t_radius * (t_length + t_side) - 8 * t_radius * t_radius;

double wall_area(const Surface& s) {
    double sum = 0;
    for (std::size_t k = 0; k < s.triangles.size(); ++k)
        if (s.face_ids[k] == 1) sum += norm(area_vector(s, s.triangles[k]));
    return sum;
}

template <class Action>
std::string refusal(Action action) {
    try {
        action();
    } catch (const GeometryError& e) {
        return e.what();
    }
    return "";
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(Network, surfaceOfATIsTheClosedForm) {
    const Surface s = make_network_surface(make_t(), 2 * t_radius / 12 * mm);   // a twelfth of the diameter
    EXPECT_NEAR(volume(s) / (mm * mm * mm * t_volume), 1, 3e-3);
    EXPECT_NEAR(wall_area(s) / (mm * mm * t_area), 1, 3e-3);
    const CheckedSurface checked = check_surface(s);
    EXPECT_EQ(refusals(checked.findings), "");
    EXPECT_TRUE(checked.ends.empty());   // closed
    for (const auto& opening : openings_of(make_t(), 0)) EXPECT_NEAR(opening.radius, mm * t_radius, 1e-12);
}

TEST(Network, capsAreRoundFlatAndNumberedLikeTheOpenings) {
    const Network network = make_t(0.5);
    const Surface s = make_network_surface(network, 0.25 * mm);
    const std::vector<Opening> openings = openings_of(network, 0);
    ASSERT_EQ(openings.size(), 3u);
    EXPECT_EQ(openings[0].name, "inlet");
    EXPECT_EQ(openings[2].name, "outlet_side");
    for (std::size_t k = 0; k < openings.size(); ++k) {
        Vec3 sum{};
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            if (s.face_ids[t] != int(k) + 2) continue;
            sum += area_vector(s, s.triangles[t]);
            for (std::uint32_t p : s.triangles[t])
                ASSERT_NEAR(opening_coordinates(openings[k], s.points[p]).s, 0, 1e-12);
        }
        EXPECT_NEAR(dot(sum, openings[k].normal) / openings[k].area, 1, 0.01);   // a polygon in a circle
    }
}

TEST(Network, lumenHasTheVolumeAreaAndDistanceOfTheTubes) {
    const double dp = 0.25 * mm, extension = 12 * dp;   // 12 across
    const Lumen lumen = make_network_lumen(make_t(), extension, 0.5 * dp);
    EXPECT_NEAR(lumen.volume / (mm * mm * mm * t_volume), 1, 1e-3);
    EXPECT_NEAR(lumen.wall_area / (mm * mm * t_area), 1, 2e-3);
    EXPECT_NEAR(measure(lumen, 0.5 * dp).volume / lumen.volume, 1, 2e-3);   // by its distance and opening planes alone
    EXPECT_NEAR(lumen.narrowest, 2 * t_radius * mm, 1e-12);
    const TubeField main(make_t().tubes[0]), side(make_t().tubes[1]);
    int seen = 0;
    for (const Vec3& x : random_points(lumen.bounds, 3000)) {
        const double a = main.value(x), b = side.value(x), value = lumen.distance.value(x);
        if (opening_beyond(lumen, x, 5 * dp) >= 0) continue;
        ASSERT_EQ(value < -0.02 * dp, contains(lumen, x) && value < -0.02 * dp);
        if (std::abs(std::min(a, b)) > 0.02 * mm) {
            ASSERT_EQ(value < 0, std::min(a, b) < 0);
        }
        // Outside of both, away from their seam, the nearest wall is that of one tube.
        if (std::min(a, b) < 0 || std::min(a, b) > 4 * dp || std::abs(a - b) < 4 * dp) continue;
        ASSERT_NEAR(value, std::min(a, b), dp / 20);
        ++seen;
    }
    EXPECT_GT(seen, 100);
    for (const Opening& o : lumen.openings)   // straight past the planes
        for (double s : {-0.2 * dp, 0.2 * dp, 5 * dp, 11 * dp}) {
            const Vec3 across = normalized(cross(o.normal, Vec3{0.3, 0.5, 0.8}));
            for (double depth : {-3 * dp, 0.0, 2 * dp})
                EXPECT_NEAR(lumen.distance.value(o.centre + s * o.normal + (o.radius + depth) * across), depth, dp / 20)
                    << o.name << ' ' << s;
        }
}

TEST(NetworkField, isTheDistanceToOneTubeAndSmoothWhereTubesMeet) {
    const Network network = make_t(0.5);
    const NetworkField field(network);
    const TubeField main(network.tubes[0]), side(network.tubes[1]);
    int blended = 0;
    for (const Vec3& x : random_points(field.bounds(), 5000)) {
        const double least = std::min(main.value(x), side.value(x)), value = field.value(x);
        ASSERT_LE(value, least + 1e-15);
        ASSERT_GE(value, least - 0.25 * network.blend - 1e-15);   // k / 4 where both are equal
        if (std::abs(main.value(x) - side.value(x)) >= network.blend) {
            ASSERT_EQ(value, least);
        } else {
            ++blended;
        }
    }
    EXPECT_GT(blended, 100);
    Network turned = network;
    std::swap(turned.tubes[0], turned.tubes[1]);
    for (const Vec3& x : random_points(field.bounds(), 1000))
        ASSERT_NEAR(NetworkField(turned).value(x), field.value(x), 1e-15);
}

TEST(NetworkField, sectionsAreCirclesOfTheGivenRadius) {
    Tube cone = straight("cone", {0, 0, 0}, {10, 0, 0}, 1, 40);
    for (std::size_t k = 0; k < cone.radii.size(); ++k) cone.radii[k] = mm * (2 - 0.03 * double(k));
    const TubeField field(cone);
    for (double x : {1.0, 2.3, 5.05, 8.0})
        for (double angle : {0.1, 2.0, 4.0}) {
            const double r = mm * (2 - 0.12 * x);
            EXPECT_NEAR(field.value({mm * x, r * std::cos(angle), r * std::sin(angle)}), 0, 1e-15);
        }
}

// Long centrelines are searched by runs of pieces: the same as by every piece.
TEST(NetworkField, nearestPieceIsFoundAmongMany) {
    Tube helix{.name = "helix", .points = {}, .radii = {}};
    for (int k = 0; k < 300; ++k) {
        const double a = 0.1 * k;
        helix.points.push_back({3 * std::cos(a), 3 * std::sin(a), 0.05 * k});
        helix.radii.push_back(0.3);
    }
    const TubeField field(helix);
    for (const Vec3& x : random_points({{-5, -5, -2}, {5, 5, 17}}, 2000)) {
        double least = 1e9;
        for (std::size_t k = 1; k < helix.points.size(); ++k) {
            const Vec3 piece = helix.points[k] - helix.points[k - 1], d = x - helix.points[k - 1];
            least = std::min(least, norm(d - std::clamp(dot(d, piece) / dot(piece, piece), 0.0, 1.0) * piece));
        }
        ASSERT_NEAR(field.value(x), least - 0.3, 1e-12);
        ASSERT_NEAR(field.distance_from_axis(x), least, 1e-12);
        ASSERT_GT(field.value(x, 0.1), std::min(0.1, least - 0.3) - 1e-12);   // below the ceiling it is exact
    }
}

Network one_tube() {
    Network network{.tubes = {straight("lad", {0, 0, 0}, {30, 0, 0}, 1.65, 20)}};
    open_free_ends(network);
    return network;
}

TEST(Narrowing, narrowsByACosineAndNowhereElse) {
    Network network = one_tube();
    add_lesion(network, {.tube = "lad", .position = 12 * mm, .length = 10 * mm, .stenosis = 0.65 / 1.65});
    EXPECT_NEAR(narrowest_diameter(network), 2 * mm, 1e-6);
    const TubeField field(network.tubes[0]);
    for (double x : {1.0, 6.9, 8.0, 10.3, 12.0, 14.0, 17.1, 25.0}) {
        const double z = std::abs(x - 12) / 5, r = 1.65 - (z < 1 ? 0.65 * 0.5 * (1 + std::cos(pi * z)) : 0);
        EXPECT_NEAR(field.value({x * mm, 0, 0}), -r * mm, 2e-3 * mm) << x;
    }
    EXPECT_EQ(length_of(network.tubes[0]), length_of(one_tube().tubes[0]));
}

TEST(Narrowing, eccentricOneTouchesTheHealthyWallOppositeToThePlaque) {
    for (double eccentricity : {0.0, 0.5, 1.0}) {
        Network network = one_tube();
        add_lesion(network, {.tube = "lad",
                             .position = 15 * mm,
                             .length = 8 * mm,
                             .stenosis = 0.5,
                             .eccentricity = eccentricity,
                             .side = Vec3{5, 0, 2}});
        const TubeField field(network.tubes[0]);
        const auto wall_at = [&](double direction) {   // by bisection from the axis of the healthy tube
            double low = 0, high = 3 * mm;
            while (high - low > 1e-9)
                (field.value({15 * mm, 0, direction * 0.5 * (low + high)}) < 0 ? low : high) = 0.5 * (low + high);
            return low;
        };
        // The middle moves away from the plaque by the eccentricity times what the radius loses, 0.825 mm.
        EXPECT_NEAR(wall_at(1), (0.825 - eccentricity * 0.825) * mm, 5e-3 * mm);
        EXPECT_NEAR(wall_at(-1), (0.825 + eccentricity * 0.825) * mm, 5e-3 * mm);
    }
}

TEST(Narrowing, mustLieInItsBranch) {
    Network network = one_tube();
    EXPECT_TRUE(
        has(refusal([&] { add_lesion(network, {.tube = "lcx", .position = 0.015, .length = 0.01, .stenosis = 0.5}); }),
            "it has lad"));
    EXPECT_TRUE(
        has(refusal([&] { add_lesion(network, {.tube = "lad", .position = 0.027, .length = 0.01, .stenosis = 0.5}); }),
            "30 mm long"));
    EXPECT_TRUE(has(refusal([&] {
                        add_lesion(network, {.tube = "lad",
                                             .position = 0.015,
                                             .length = 0.01,
                                             .stenosis = 0.5,
                                             .eccentricity = 1,
                                             .side = Vec3{1, 0, 0}});
                    }),
                    "across"));
}

TEST(Network, graphBecomesTubesBetweenItsForks) {
    // A trunk of three points, a fork, two branches; the second line repeats the trunk as VMTK's do.
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0},
                                      {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, -1, 0}};
    const std::vector<double> radii = {0.5, 0.5, 0.5, 0.3, 0.5, 0.5, 0.5, 0.2};
    Network network = network_of_graph(points, radii, {{0, 1}, {1, 2}, {2, 3}, {4, 5}, {5, 6}, {6, 7}});
    ASSERT_EQ(network.tubes.size(), 3u);
    EXPECT_EQ(network.tubes[0].points.size(), 3u);
    EXPECT_EQ(network.tubes[2].radii,
              (std::vector<double>{0.2, 0.2}));   // a branch has its own radius from the fork on
    open_free_ends(network);
    expect_sound(network);
    EXPECT_EQ(network.tubes[0].start->name, "inlet");
    EXPECT_EQ(network.tubes[1].end->name, "outlet_1");
    EXPECT_EQ(network.tubes[2].end->name, "outlet_2");
    EXPECT_FALSE(network.tubes[1].start);
    EXPECT_TRUE(has(refusal([&] {
                        network_of_graph({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 1, 1}, {{0, 1}, {1, 2}, {2, 0}});
                    }),
                    "closed ring"));
}

TEST(Network, linesThatShareTheirWayArePartedWhereTheyPart) {
    Network network;
    for (double sign : {1.0, -1.0}) {
        Tube line{.name = sign > 0 ? "a" : "b", .points = {}, .radii = {}};
        for (int k = 0; k <= 40; ++k) {
            const double x = 0.25 * k, aside = x > 5 ? 0.8 * (x - 5) : 0.001 * std::sin(x);
            line.points.push_back({x, sign * aside, 0});
            line.radii.push_back(0.5);
        }
        network.tubes.push_back(line);
    }
    network.tubes.push_back(network.tubes[0]);   // a third of the same way
    part_shared_tubes(network);
    ASSERT_EQ(network.tubes.size(), 2u);
    EXPECT_EQ(network.tubes[0].points.size(), 41u);
    EXPECT_EQ(network.tubes[1].points.front(), (Vec3{5, -0.001 * std::sin(5), 0}));
    EXPECT_EQ(network.tubes[1].points.back(), (Vec3{10, -4, 0}));
}

TEST(Network, openingCutsTheTubeThatItCrosses) {
    Network network{
        .tubes = {straight("main", {-5, 0, 0}, {5, 0, 0}, 1.5, 7), straight("side", {0, 0, 0}, {0, 8, 0}, 1, 5)}};
    open_at(network, "inlet", {-3 * mm, 0, 0}, {-1, 0, 0});
    open_at(network, "left", {4 * mm, 0, 0}, {1, 0, 0});
    open_at(network, "right", {0, 6 * mm, 0}, {0, 1, 0});
    expect_sound(network);
    EXPECT_EQ(network.tubes[0].points.front(), (Vec3{-3 * mm, 0, 0}));
    EXPECT_EQ(network.tubes[0].points.back(), (Vec3{4 * mm, 0, 0}));
    EXPECT_NEAR(length_of(network.tubes[1]), 6 * mm, 1e-12);
    EXPECT_TRUE(has(refusal([&] { open_at(network, "x", {0, 3 * mm, 0}, {1, 0, 0}); }), "across its plane"));
    EXPECT_TRUE(has(refusal([&] { open_at(network, "x", {0, 3 * mm, 2 * mm}, {0, 1, 0}); }), "across its plane"));
}

TEST(Network, aPointOrARadiusFarTooLargeIsRefusedAtOnce) {
    // Minutes of looking for a wall of square metres in cells of a tenth of a millimetre, without the estimate of it.
    Network wide = make_t(), far = make_t();
    wide.tubes[1].radii.front() = 22;
    far.tubes[1].points.back() += 900 * normalized(far.tubes[1].points.back() - far.tubes[1].points.front());
    for (const Network& network : {wide, far}) {
        EXPECT_TRUE(has(refusal([&] { make_network_surface(network, mm); }), "points or radii wrong"));
        EXPECT_TRUE(has(refusal([&] { make_network_lumen(network, 0, mm); }), "points or radii wrong"));
    }
}

TEST(Network, aRadiusFarTooSmallIsRefusedBeforeStepsOfItsLength) {
    Network network = make_t();
    network.tubes[0].radii.front() = 1e-160;   // its continuation was looked along in steps of a quarter of that
    EXPECT_TRUE(has(refusal([&] { expect_sound(network); }), "narrower than any vessel"));
}

TEST(Network, refusesWhatCannotBe) {
    const auto refused = [](auto change) {
        Network network = make_t();
        change(network);
        return refusal([&] { make_network_surface(network, 0.25 * mm); });
    };
    EXPECT_EQ(refused([](Network&) {}), "");
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes.clear(); }), "no tubes"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[0].radii[1] = -1; }), "must be positive"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[0].radii[0] = std::nan(""); }), "must be positive"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[0].points[1].y = std::nan(""); }), "no place in a body"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[1].points[1] = n.tubes[1].points[0]; }), "same place twice"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[1].radii.pop_back(); }), "2 points and 1 radii"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[1].name = "main"; }), "names must differ"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[1].end->name = "inlet"; }), "names must differ"));
    EXPECT_TRUE(has(refused([](Network& n) { n.blend = -1; }), "blend width"));
    EXPECT_TRUE(has(refused([](Network& n) {
                        for (Vec3& x : n.tubes[1].points) x.z += 20 * mm;
                    }),
                    "do not hang together"));
    EXPECT_TRUE(has(refused([](Network& n) { n.tubes[0].start.reset(), n.tubes[0].end.reset(); }), "1 opening;"));
    EXPECT_TRUE(has(refusal([] {
                        Network close = make_t();
                        close.tubes.push_back(straight("near", {0, 0, 0}, {0, 0, 0}, 1));
                        close.tubes[2].points = {close.tubes[0].points[1] + Vec3{0, 0, 2.5 * mm},
                                                 close.tubes[0].points[0] + Vec3{0, 0, 2.5 * mm},
                                                 close.tubes[0].points[0] + Vec3{0, 0, 0.5 * mm}};
                        close.tubes[2].radii = {mm, mm, mm};
                        openings_of(close, 0);
                    }),
                    "runs into another tube"));
}

}   // namespace
}   // namespace patency
