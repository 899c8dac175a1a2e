// SPDX-License-Identifier: Apache-2.0
// A stent's surface from anywhere: its axis and its measures.
#include "patency/shape/stent_import.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/stent_library.h"
#include "tests/shape/surfaces.h"

namespace patency {
namespace {

Surface moved_stent(const StrutCurves& curves, const RigidMotion& motion) {
    return make_stent_surface(curves, StentAxis(motion), 40e-6);   // coarse: what it is compared with is it itself
}

TEST(StentImport, FindsAxisAndMeasuresOfAMovedStent) {
    StentPattern p = find_stent("paper").pattern;
    p.rings = 2, p.length = 2.4e-3;
    const StrutCurves curves = make_strut_curves(p);
    for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 2, 0.3}}) {
        const RigidMotion motion = motion_along(direction, {5e-3, -3e-3, 20e-3});
        const Surface read = moved_stent(curves, motion);
        const ImportedStent stent = recognise_stent(read);
        EXPECT_NEAR(stent.diameter, p.diameter, 2e-3 * p.diameter);
        EXPECT_NEAR(stent.length, p.length, 0.05 * p.strut_width);
        EXPECT_NEAR(stent.strut_thickness, p.strut_thickness, 0.01 * p.strut_thickness);
        EXPECT_NEAR(stent.volume, volume(read), 1e-6 * stent.volume);
        EXPECT_NEAR(stent.area, area(read), 1e-6 * stent.area);
        EXPECT_GT(std::abs(dot(stent.placement.turn({1, 0, 0}), normalized(direction))), 1 - 1e-5);
        EXPECT_LT(norm(stent.placement.origin - motion.origin), 5e-6);
        // In its own frame around the x axis and the origin, and back where it was.
        const Bounds own = bounds(stent.surface);
        EXPECT_NEAR(own.low.x, -own.high.x, 1e-12);
        const Bounds there = bounds(read);
        for (std::size_t k = 0; k < stent.surface.points.size(); k += 97) {
            const Vec3 x = stent.placement.place(stent.surface.points[k]);
            EXPECT_GT(x.x, there.low.x - 1e-9);
            EXPECT_LT(x.z, there.high.z + 1e-9);
        }
    }
}

// A short, wide ring: the axis is the short one.
TEST(StentImport, AShortRingHasItsAxisToo) {
    StentPattern p = find_stent("paper").pattern;
    p.rings = 1, p.connectors = 0, p.length = 1.2e-3;
    const ImportedStent stent = recognise_stent(moved_stent(make_strut_curves(p), motion_along({0, 0, 1}, {})));
    EXPECT_NEAR(std::abs(stent.placement.turn({1, 0, 0}).z), 1, 1e-6);
    EXPECT_NEAR(stent.length, 1.2e-3, 5e-6);
}

TEST(StentImport, RefusesWhatIsNoStent) {
    const auto refused = [](Surface surface, const char* word) {
        try {
            recognise_stent(std::move(surface));
            ADD_FAILURE() << word;
        } catch (const GeometryError& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    StentPattern p = find_stent("paper").pattern;
    p.rings = 1, p.connectors = 0, p.length = 1.2e-3;
    const Surface ring = make_stent_surface(make_strut_curves(p), {}, 40e-6);
    Surface scaled = ring;
    for (Vec3& x : scaled.points) x *= 1000;
    refused(scaled, "unit");
    Surface stretched = ring;
    for (Vec3& x : stretched.points) x.y *= 1.7;
    refused(stretched, "no axis");
    Surface hurt = ring;
    hurt.triangles.erase(hurt.triangles.begin() + 500, hurt.triangles.begin() + 520);
    refused(hurt, "");
    refused(make_tube_mesh({}), "open");
}

}   // namespace
}   // namespace patency
