// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_openings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/errors.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

std::vector<SurfaceOpening> openings_of(const Surface& surface) { return find_openings(check_surface(surface)); }

// 1 % is the bar; a polygon of 48 corners is 0.14 % narrower than its circle.
void expect_tube_ends(const std::vector<SurfaceOpening>& openings) {
    ASSERT_EQ(openings.size(), 2u);
    EXPECT_EQ(openings[0].opening.name, "inlet");
    EXPECT_EQ(openings[1].opening.name, "outlet_1");
    for (const SurfaceOpening& o : openings) {
        EXPECT_NEAR(2 * o.opening.radius, 2e-3, 0.01 * 2e-3);
        EXPECT_NEAR(o.opening.area, std::numbers::pi * 1e-6, 0.01 * std::numbers::pi * 1e-6);
        EXPECT_NEAR(o.perimeter, 2e-3 * std::numbers::pi, 0.01 * 2e-3 * std::numbers::pi);
        EXPECT_NEAR(o.opening.reach, 1e-3, 1e-5);
        EXPECT_NEAR(o.flatness, 0, 1e-9);
        const bool is_start = o.opening.centre.x < 3e-3;
        EXPECT_NEAR(norm(o.opening.centre - Vec3{is_start ? 0 : 6e-3, 0, 0}), 0, 1e-9);
        EXPECT_NEAR(o.opening.normal.x, is_start ? -1 : 1, 1e-9);
    }
}

TEST(SurfaceOpenings, OfAnOpenTube) {
    const auto openings = openings_of(make_tube_mesh({}));
    expect_tube_ends(openings);
    EXPECT_FALSE(openings[0].face_id);
    EXPECT_TRUE(openings[0].triangles.empty());
}

TEST(SurfaceOpenings, OfFacesWithIds) {
    const auto openings = openings_of(make_tube_mesh({.start_cap = true, .end_cap = true}));
    expect_tube_ends(openings);
    EXPECT_EQ(openings[0].face_id.value() + openings[1].face_id.value(), 5);
    EXPECT_EQ(openings[0].triangles.size(), 48u);
}

TEST(SurfaceOpenings, OfFlatCapsWithoutIds) {
    Surface tube = make_tube_mesh({.start_cap = true, .end_cap = true});
    tube.face_ids.clear();
    expect_tube_ends(openings_of(tube));
    expect_tube_ends(openings_of(subdivided(tube)));
    tube = make_tube_mesh({.start_cap = true});   // one open, one capped
    tube.face_ids.clear();
    expect_tube_ends(openings_of(tube));
}

TEST(SurfaceOpenings, OfACapCutAtAnAngle) {
    Surface tube = make_tube_mesh({.start_cap = true, .end_cap = true});
    tube.face_ids.clear();
    for (Vec3& x : tube.points) x.x += 0.7 * x.y * (1 - x.x / 6e-3);
    const auto openings = openings_of(tube);
    ASSERT_EQ(openings.size(), 2u);
    EXPECT_NEAR(openings[0].opening.area, std::numbers::pi * 1e-6 * std::hypot(1, 0.7), 0.01 * std::numbers::pi * 1e-6);
}

// Noise and smoothing bend a cap: it is one as long as its edge is sharp.
TEST(SurfaceOpenings, OfCapsThatAreBent) {
    Surface tube = subdivided(make_tube_mesh({.start_cap = true, .end_cap = true}));
    tube.face_ids.clear();
    for (Vec3& x : tube.points)
        x += Vec3{0.06e-3 * std::sin(2e3 * x.y + 1e3 * x.z), 0.1e-3 * std::sin(0.9e3 * x.x),
                  0};   // six degrees across a cap
    const auto openings = openings_of(tube);
    ASSERT_EQ(openings.size(), 2u);
    for (const SurfaceOpening& o : openings) {
        EXPECT_GT(o.flatness, 0.02e-3);
        EXPECT_NEAR(2 * o.opening.radius, 2e-3, 0.02 * 2e-3);
        EXPECT_NEAR(std::abs(o.opening.normal.x), 1, 0.02);
    }
}

TEST(SurfaceOpenings, ARoundedEndIsNone) {
    Surface tube = make_tube_mesh({.start_cap = true, .round_end = true});
    tube.face_ids.clear();
    const auto openings = openings_of(tube);
    ASSERT_EQ(openings.size(), 1u);
    const auto findings = find_missing_openings(openings);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].verdict, Verdict::refused);
    EXPECT_NE(findings[0].sentence.find("rounded"), std::string::npos);
    EXPECT_EQ(find_missing_openings(openings_of(make_torus_mesh(4e-3, 1e-3, 60, 30))).size(), 1u);
    EXPECT_TRUE(find_missing_openings(openings_of(make_tube_mesh({}))).empty());
}

TEST(SurfaceOpenings, FacetsOfACoarseTubeAreNone) {
    Surface tube = make_tube_mesh(
        {.around = 10, .along = 10, .start_cap = true, .end_cap = true});   // facets as long as wide, 36 degrees
    tube.face_ids.clear();
    EXPECT_EQ(openings_of(tube).size(), 2u);
}

TEST(SurfaceOpenings, OfABranchingVessel) {
    const BranchesShape shape{
        .branches = {{.points = {{-6e-3, 0, 0}, {6e-3, 0, 0}}, .radii = {2e-3, 2e-3}, .start = "a", .end = "b"},
                     {.points = {{0, 0, 0}, {0, 6e-3, 0}}, .radii = {1.25e-3, 1.25e-3}, .start = "", .end = "c"}},
        .extension = 4e-3};
    const Lumen lumen = make_branches(shape);
    // Within 1 % at an eighth of the small radius: a chord of a circle r over a step h lies h^2 / 12 r inside on average.
    const Surface mesh = make_level_mesh(lumen.distance, {{-6e-3, -3e-3, -3e-3}, {6e-3, 6e-3, 3e-3}}, 0.15e-3);
    const CheckedSurface checked = check_surface(mesh);
    EXPECT_EQ(refusals(checked.findings), "");
    EXPECT_NEAR(checked.volume, lumen.volume, 0.01 * lumen.volume);
    EXPECT_NEAR(area(checked.surface), lumen.wall_area, 0.01 * lumen.wall_area);
    auto openings = find_openings(checked);
    ASSERT_EQ(openings.size(), 3u);
    for (int k : {0, 1}) EXPECT_NEAR(openings[k].opening.radius, 2e-3, 2e-5);
    EXPECT_NEAR(openings[2].opening.radius, 1.25e-3, 1.25e-5);
    EXPECT_NEAR(norm(openings[2].opening.centre - Vec3{0, 6e-3, 0}), 0, 2e-5);
    EXPECT_NEAR(openings[2].opening.normal.y, 1, 1e-6);

    choose_inlet(openings, "outlet_2");
    EXPECT_NEAR(openings[0].opening.radius, 1.25e-3, 1.25e-5);
    EXPECT_EQ(openings[0].opening.name, "inlet");
    EXPECT_EQ(openings[2].opening.name, "outlet_2");
    choose_inlet(openings, "3");
    EXPECT_NEAR(openings[0].opening.radius, 2e-3, 2e-5);
    EXPECT_NEAR(openings[2].opening.radius, 1.25e-3, 1.25e-5);
    for (const char* wrong : {"4", "0", "outlet_3", "", "1x", "-1"})
        EXPECT_THROW(choose_inlet(openings, wrong), UsageError) << wrong;
}

TEST(SurfaceOpenings, TakeNamesOfTheirOwn) {
    std::vector<SurfaceOpening> openings(3);
    openings[0].opening.name = "inlet", openings[1].opening.name = "outlet_1", openings[2].opening.name = "outlet_2";
    std::vector<SurfaceOpening> turned = openings;
    rename_openings(turned, {{"outlet_1", "outlet_2"}, {"outlet_2", "outlet_1"}});   // both at once
    EXPECT_EQ(turned[0].opening.name, "inlet");
    EXPECT_EQ(turned[1].opening.name, "outlet_2");
    EXPECT_EQ(turned[2].opening.name, "outlet_1");
    EXPECT_THROW(rename_openings(openings, {{"outlet_3", "distal"}}), UsageError);
    EXPECT_THROW(rename_openings(openings, {{"outlet_1", "inlet"}}), UsageError);   // two would have it
}

TEST(SurfaceOpenings, AnImpossibleSizeIsAQuestionAboutTheUnit) {
    SurfaceOpening inlet{};
    inlet.opening.radius = 1.7;   // 3400 in mm
    try {
        expect_vessel_size(inlet, "mm");
        FAIL();
    } catch (const GeometryError& error) {
        EXPECT_NE(std::string(error.what()).find("Did you mean --unit um (3.4 mm)?"), std::string::npos)
            << error.what();
    }
    for (double radius : {0.24e-3, 20.1e-3}) {
        inlet.opening.radius = radius;
        EXPECT_THROW(expect_vessel_size(inlet, "mm"), GeometryError);
    }
    for (double radius : {0.26e-3, 19.9e-3}) {
        inlet.opening.radius = radius;
        EXPECT_NO_THROW(expect_vessel_size(inlet, "mm"));
    }
}

}   // namespace
}   // namespace patency
