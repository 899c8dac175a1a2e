// SPDX-License-Identifier: Apache-2.0
// Every kind of defect, planted and found; what is repaired leaves the shape as it was.
#include "patency/shape/surface_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "patency/base/errors.h"
#include "patency/shape/surface_openings.h"
#include "patency/shape/triangle_pairs.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;

const Finding* find(const CheckedSurface& checked, std::string_view kind) {
    for (const Finding& finding : checked.findings)
        if (finding.kind == kind) return &finding;
    return nullptr;
}

void expect_finding(const CheckedSurface& checked, std::string_view kind, Verdict verdict, std::size_t count) {
    const Finding* finding = find(checked, kind);
    ASSERT_TRUE(finding) << kind << " not found";
    EXPECT_EQ(finding->verdict, verdict) << kind;
    EXPECT_EQ(finding->count, count) << finding->sentence;
}

Surface capped_tube() { return make_tube_mesh({.start_cap = true, .end_cap = true}); }

TEST(Surface, AreaAndVolumeOfATubeAndATorus) {
    // A polygon of n corners lacks 2/3 (pi/n)^2 of the circle's area: 0.3 % for 48.
    const Surface tube = capped_tube();
    EXPECT_NEAR(volume(tube), pi * 6e-9, 0.004 * pi * 6e-9);
    EXPECT_NEAR(area(tube), 2 * pi * 7e-6, 0.004 * 2 * pi * 7e-6);
    const Surface torus = make_torus_mesh(4e-3, 1e-3, 200, 80);
    EXPECT_NEAR(volume(torus), 2 * pi * pi * 4e-9, 0.002 * 2 * pi * pi * 4e-9);
    EXPECT_NEAR(area(torus), 4 * pi * pi * 4e-6, 0.002 * 4 * pi * pi * 4e-6);
    EXPECT_NEAR(bounds(torus).high.x, 5e-3, 1e-12);
    EXPECT_NEAR(bounds(torus).low.z, -1e-3, 1e-12);
}

TEST(SurfaceCheck, ASoundSurfaceHasNoFindings) {
    const CheckedSurface torus = check_surface(make_torus_mesh(4e-3, 1e-3, 60, 30));
    EXPECT_TRUE(torus.findings.empty()) << torus.findings[0].sentence;
    EXPECT_TRUE(torus.ends.empty());
    const CheckedSurface tube = check_surface(make_tube_mesh({}));
    EXPECT_TRUE(tube.findings.empty()) << tube.findings[0].sentence;
    ASSERT_EQ(tube.ends.size(), 2u);
    EXPECT_NEAR(tube.volume, volume(capped_tube()), 1e-18);
    EXPECT_EQ(refusals(tube.findings), "");
}

TEST(SurfaceCheck, EqualPointsAreMerged) {
    const Surface tube = capped_tube();
    Surface soup{.points = {}};
    for (const Triangle& t : tube.triangles) {
        const auto first = std::uint32_t(soup.points.size());
        for (std::uint32_t point : t)
            soup.points.push_back(tube.points[point] + Vec3{1e-10 * (first % 7), 0, 0});   // 0.1 nm: rounding
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    const CheckedSurface checked = check_surface(soup);
    expect_finding(checked, "equal_points", Verdict::repaired, soup.points.size() - tube.points.size());
    EXPECT_EQ(checked.findings.size(), 1u);
    EXPECT_EQ(checked.surface.triangles.size(), tube.triangles.size());
    EXPECT_NEAR(checked.volume, volume(tube), 1e-6 * volume(tube));
}

TEST(SurfaceCheck, FlatTrianglesGoAndLeaveNoSlit) {
    // The edge of a triangle gets a point in its middle on one side only, and a flat triangle that fills the slit.
    Surface tube = capped_tube();
    const auto middle = std::uint32_t(tube.points.size());
    const Triangle t = tube.triangles[100];
    tube.points.push_back(0.5 * (tube.points[t[0]] + tube.points[t[1]]));
    tube.triangles[100] = {t[0], middle, t[2]};
    tube.triangles.push_back({middle, t[1], t[2]});
    tube.triangles.push_back({t[0], t[1], middle});
    tube.triangles.push_back({t[0], t[0], t[1]});
    tube.face_ids.clear();
    const CheckedSurface checked = check_surface(tube);
    expect_finding(checked, "zero_area_triangles", Verdict::repaired, 2);
    EXPECT_EQ(checked.findings.size(), 1u) << checked.findings.back().sentence;
    EXPECT_NEAR(checked.volume, volume(capped_tube()), 1e-18);
}

TEST(SurfaceCheck, DuplicatesGo) {
    Surface tube = capped_tube();
    tube.face_ids.clear();
    const Triangle t = tube.triangles[7];
    tube.triangles.push_back({t[1], t[2], t[0]});
    const auto tip = std::uint32_t(tube.points.size());   // a flap without thickness, back to back
    tube.points.push_back({3e-3, 3e-3, 0});
    tube.triangles.push_back({t[0], t[1], tip});
    tube.triangles.push_back({t[1], t[0], tip});
    const CheckedSurface checked = check_surface(tube);
    expect_finding(checked, "duplicate_triangles", Verdict::repaired, 3);
    EXPECT_EQ(checked.findings.size(), 1u) << checked.findings.back().sentence;
    EXPECT_NEAR(volume(checked.surface), volume(capped_tube()), 1e-18);
}

TEST(SurfaceCheck, DustGoesAndASecondVesselIsRefused) {
    const Surface dust = make_torus_mesh(1e-4, 3e-5, 12, 8);
    const CheckedSurface dusty =
        check_surface(joined_surfaces(joined_surfaces(capped_tube(), dust, {0, 5e-3, 0}), dust, {0, 6e-3, 0}));
    expect_finding(dusty, "components", Verdict::repaired, 2);
    EXPECT_NEAR(volume(dusty.surface), volume(capped_tube()), 1e-18);
    const CheckedSurface two = check_surface(joined_surfaces(capped_tube(), capped_tube(), {0, 5e-3, 0}));
    expect_finding(two, "components", Verdict::refused, 1);
    EXPECT_NE(refusals(two.findings).find("components"), std::string::npos);
}

TEST(SurfaceCheck, TurnedTrianglesAndInsideOutAreTurned) {
    Surface tube = make_tube_mesh({});
    for (std::uint32_t k : {3u, 50u, 51u, 900u}) std::swap(tube.triangles[k][1], tube.triangles[k][2]);
    const CheckedSurface turned = check_surface(tube);
    expect_finding(turned, "turned_triangles", Verdict::repaired, 4);
    EXPECT_EQ(turned.findings.size(), 1u);
    EXPECT_NEAR(turned.volume, volume(capped_tube()), 1e-18);
    for (Triangle& t : tube.triangles) std::swap(t[1], t[2]);
    const CheckedSurface inside_out = check_surface(tube);
    expect_finding(inside_out, "inside_out", Verdict::repaired, tube.triangles.size());
    EXPECT_NEAR(inside_out.volume, volume(capped_tube()), 1e-18);
    ASSERT_EQ(inside_out.ends.size(), 2u);
    EXPECT_NEAR(std::abs(inside_out.ends[0].normal.x), 1, 1e-9);
    EXPECT_GT(dot(inside_out.ends[0].normal, inside_out.ends[0].centre - Vec3{3e-3, 0, 0}), 0);   // outward
}

TEST(SurfaceCheck, AOneSidedSurfaceIsRefused) {
    Surface strip;   // Moebius
    constexpr std::uint32_t n = 40;
    for (std::uint32_t k = 0; k < n; ++k) {
        const double a = 2 * pi * k / n;
        for (double side : {-1.0, 1.0}) {
            const double r = 3e-3 + side * 1e-3 * std::cos(a / 2);
            strip.points.push_back({r * std::cos(a), r * std::sin(a), side * 1e-3 * std::sin(a / 2)});
        }
        const std::uint32_t c = k + 1 < n ? 2 * k + 2 : 1, d = k + 1 < n ? 2 * k + 3 : 0;
        strip.triangles.push_back({2 * k, c, 2 * k + 1});
        strip.triangles.push_back({2 * k + 1, c, d});
    }
    const CheckedSurface checked = check_surface(strip);
    ASSERT_TRUE(find(checked, "one_sided"));
    EXPECT_EQ(find(checked, "one_sided")->verdict, Verdict::refused);
}

TEST(SurfaceCheck, CrowdedEdgesAreRefused) {
    Surface tube = capped_tube();
    tube.face_ids.clear();
    const Triangle t = tube.triangles[7];
    tube.points.push_back({3e-3, 3e-3, 0});
    tube.triangles.push_back({t[0], t[1], std::uint32_t(tube.points.size() - 1)});
    const CheckedSurface checked = check_surface(tube);
    expect_finding(checked, "non_manifold_edges", Verdict::refused, 1);
    ASSERT_EQ(find(checked, "non_manifold_edges")->lines.size(), 1u);
}

TEST(SurfaceCheck, HolesInTheWallAreRefusedAndEndsAreNot) {
    Surface tube = make_tube_mesh({});
    tube.face_ids.clear();
    const std::uint32_t middle = 20 * 48 + 5;
    const auto has_point = [](const Triangle& t, std::uint32_t point) {
        return std::find(t.begin(), t.end(), point) != t.end();
    };
    std::erase_if(tube.triangles, [&](const Triangle& t) { return has_point(t, middle); });   // six edges
    std::erase_if(tube.triangles, [&](const Triangle& t) {                                    // a larger one, round
        return norm(centroid(tube, t) - Vec3{1.5e-3, -1e-3, 0}) < 0.45e-3;
    });
    const CheckedSurface checked = check_surface(tube);
    expect_finding(checked, "holes", Verdict::refused, 2);
    EXPECT_EQ(checked.ends.size(), 2u);
    const Finding& holes = *find(checked, "holes");
    EXPECT_NEAR(holes.place.x, 1.5e-3, 0.1e-3);
    EXPECT_NEAR(holes.size, 0.9e-3, 0.2e-3);
    EXPECT_NE(holes.sentence.find("lies within the wall"), std::string::npos) << holes.sentence;
    EXPECT_EQ(holes.lines.size(), 2u);
}

TEST(SurfaceCheck, EndsThatAreNotFlatOrNotRoundAreRefused) {
    Surface bent = make_tube_mesh({});
    for (std::uint32_t k = 0; k < 48; ++k) bent.points[k].x += 0.5e-3 * std::cos(4 * pi * k / 48);   // a saddle
    expect_finding(check_surface(bent), "holes", Verdict::refused, 1);
    expect_finding(check_surface(make_tube_mesh({.flat_share = 0.1})), "holes", Verdict::refused, 2);
}

TEST(SurfaceCheck, ALoopThatCrossesItselfHasItsCentreAmongItsPoints) {
    // Two triangles at the origin, one run through the other way round, each 1 mm wide but for a billionth: their areas
    // cancel to nearly nothing, and the centroid of that is a thousand kilometres away.
    const double a = 1e-3, b = 1e-3 * (1 + 1e-9);
    const Surface surface{.points = {{0, 0, 0}, {a, -a, 0}, {a, a, 0}, {-b, -b, 0}, {-b, b, 0}}};
    const FlatLoop loop = measured_loop(surface, {0, 1, 2, 0, 3, 4});
    EXPECT_LE(norm(loop.centre), 2 * b);
    EXPECT_LE(loop.reach, 4 * b);
}

TEST(SurfaceCheck, PartsThatPassThroughEachOtherAreRefused) {
    // A tube that is bent so far that its end runs through its beginning.
    Surface tube = make_tube_mesh({.length = 30e-3, .along = 200});
    for (Vec3& x : tube.points) {
        const double r = 4e-3 - x.y, a = x.x / 4e-3;                // once around and a fifth
        x = {r * std::sin(a), r * std::cos(a), x.z + 0.1e-3 * a};   // a little beside itself, so that no faces coincide
    }
    const CheckedSurface checked = check_surface(tube);
    ASSERT_TRUE(find(checked, "crossings"));
    EXPECT_EQ(find(checked, "crossings")->verdict, Verdict::refused);
    EXPECT_GT(find(checked, "crossings")->count, 20u);
    EXPECT_FALSE(find(checked, "crossings")->shown.triangles.empty());
}

TEST(SurfaceCheck, PartsThatLieOnEachOtherInOnePlaneAreRefused) {
    const auto block = [](const Vec3& low, const Vec3& high) {
        Surface s;
        for (const double x : {low.x, high.x})
            for (const double y : {low.y, high.y})
                for (const double z : {low.z, high.z}) s.points.push_back({x, y, z});
        s.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                       {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
        return s;
    };
    const auto turned = [](Surface s) {   // so that no plane is one of the axes', as 32-bit files have it
        for (Vec3& x : s.points)
            x = {double(float(0.36 * x.x + 0.48 * x.y - 0.8 * x.z)), double(float(-0.8 * x.x + 0.6 * x.y)),
                 double(float(0.48 * x.x + 0.64 * x.y + 0.6 * x.z))};
        return s;
    };
    const Surface large = block({0, 0, 0}, {4e-3, 4e-3, 2e-3});
    const auto crossings = [&](const Surface& small, bool is_turned) {
        const Surface both = joined_surfaces(large, small, {});
        const CheckedSurface checked = check_surface(is_turned ? turned(both) : both);
        const Finding* found = find(checked, "crossings");
        if (found) {
            EXPECT_EQ(found->verdict, Verdict::refused);
        }
        return found ? found->count : 0;
    };
    for (const bool is_turned : {false, true}) {
        // Within one triangle of the large block's top: no side passes through anything.
        EXPECT_GE(crossings(block({2.5e-3, 0.5e-3, 2e-3}, {3.5e-3, 1.5e-3, 3e-3}), is_turned), 2u) << is_turned;
        // Just above it, and beside it with the tops in one plane.
        EXPECT_EQ(crossings(block({2.5e-3, 0.5e-3, 2.001e-3}, {3.5e-3, 1.5e-3, 3e-3}), is_turned), 0u) << is_turned;
        EXPECT_EQ(crossings(block({4.001e-3, 0, 0}, {6e-3, 4e-3, 2e-3}), is_turned), 0u) << is_turned;
    }
}

TEST(SurfaceCheck, ATriangleTurnedOverOntoItsNeighbourLiesOnIt) {
    Surface pair;
    pair.points = {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {0.8e-3, 0.7e-3, 0}, {0.5e-3, -1e-3, 0}};
    pair.triangles = {{0, 1, 2}, {1, 0, 3}};
    EXPECT_EQ(find_crossing_triangles(pair, 10).size(), 1u);
    pair.triangles[1] = {1, 0, 4};   // on the other side of the edge, where it belongs
    EXPECT_TRUE(find_crossing_triangles(pair, 10).empty());
}

TEST(SurfaceCheck, CrumplesAreHarmless) {
    Surface tube = capped_tube();
    // Two neighbours stand out of the wall and lean over each other.
    const double angle = 2 * pi * 5 / 48;
    const Vec3 out{0, std::cos(angle), std::sin(angle)}, along{1, 0, 0};
    tube.points[20 * 48 + 5] += 0.5e-3 * out + 0.3e-3 * along;
    tube.points[21 * 48 + 5] += 0.5e-3 * out - 0.15e-3 * along + Vec3{0, 0, 0.02e-3};
    const CheckedSurface checked = check_surface(tube);
    ASSERT_TRUE(find(checked, "folds"));
    EXPECT_EQ(find(checked, "folds")->verdict, Verdict::harmless);
    EXPECT_EQ(refusals(checked.findings), "");
}

TEST(SurfaceCheck, CrossingTrianglesAreThoseOfASlowSearch) {
    Surface cloud;   // no two share a point
    unsigned state = 1;
    const auto random = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / double(1u << 24); };
    for (std::uint32_t k = 0; k < 300; ++k) {
        const Vec3 centre{random(), random(), random()};
        for (int corner = 0; corner < 3; ++corner)
            cloud.points.push_back(centre + 0.2 * Vec3{random() - 0.5, random() - 0.5, random() - 0.5});
        cloud.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    const auto pairs = find_crossing_triangles(cloud, 100000);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < 300; ++i)
        for (std::uint32_t j = i + 1; j < 300; ++j) {
            const Surface two = part_of(cloud, std::array{i, j});
            if (find_crossing_triangles(two, 2).empty()) continue;
            ASSERT_LT(next, pairs.size());
            EXPECT_EQ(std::pair(pairs[next].a, pairs[next].b), std::pair(i, j));
            ++next;
        }
    EXPECT_EQ(next, pairs.size());
    EXPECT_GT(next, 50u);
    EXPECT_EQ(find_crossing_triangles(cloud, 10).size(), 10u);
}

TEST(SurfaceCheck, NothingLeftIsAnError) {
    EXPECT_THROW(check_surface(Surface{.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}}),
                 GeometryError);
    EXPECT_THROW(check_surface(Surface{}), GeometryError);
}

TEST(SurfaceCheck, AHundredAndFortyThousandTrianglesTakeSeconds) {
    const Surface torus = make_torus_mesh(4e-3, 1e-3, 500, 140);
    ASSERT_EQ(torus.triangles.size(), 140000u);
    const auto start = std::clock();
    EXPECT_TRUE(check_surface(torus).findings.empty());
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 5)
        << "CPU seconds; 10 are allowed with reading and drawing";
}

}   // namespace
}   // namespace patency
