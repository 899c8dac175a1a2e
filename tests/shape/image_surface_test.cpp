// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/image_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"
#include "patency/shape/surface_openings.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi, voxel = 0.4e-3;   // m

/// An image of a shape that is given in steps: value(distance) at every point. Axes turned, the last one mirrored.
struct Scan {
    Image image{.size = {44, 36, 40}, .values = {}, .step = {}, .origin = {0.01, -0.02, 0.03}, .space = "RAS"};
    SignedDistance shape;

    explicit Scan(SignedDistance given) : shape(std::move(given)) {
        image.step = voxel * (motion_along({2, 1, -1}, {}).rotation * Mat3{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}});
    }
    template <class Value>
    Scan& fill(Value value) {
        for (int k = 0; k < image.size[2]; ++k)
            for (int j = 0; j < image.size[1]; ++j)
                for (int i = 0; i < image.size[0]; ++i)
                    image.values.push_back(float(value(shape.value({double(i), double(j), double(k)}))));
        return *this;
    }
    Vec3 index_of(const Vec3& x) const { return inverse(image.step) * (x - image.origin); }
    /// Root mean square distance of a surface's points from the shape [steps]; those at the image's border left out.
    double error(const Surface& surface) const {
        double sum = 0, count = 0;
        for (const Vec3& point : surface.points) {
            const Vec3 x = index_of(point);
            if (x.x < 0 || x.x > image.size[0] - 1) continue;
            sum += std::pow(shape.value(x), 2), ++count;
        }
        return std::sqrt(sum / count);
    }
};

constexpr double radius = 6;   // steps: 12 across the diameter
SignedDistance ball() {
    return moved(union_of_round_cones({{{0, 0, 0}, {1e-9, 0, 0}, radius, radius}}),
                 {identity<double>(), {21.3, 17.8, 19.4}});
}
SignedDistance tilted_tube() { return moved(round_tube(radius), motion_along({1, 0.13, 0.11}, {21.3, 17.8, 19.4})); }
const auto as_label = [](double distance) { return distance < 0 ? 3.0 : 0.0; };

TEST(ImageSurface, labelOfABallIsRoundClosedAndInPlace) {
    const Scan scan = Scan(ball()).fill(as_label);
    const Surface s = make_image_surface(scan.image);
    EXPECT_NEAR(volume(s) / (4 * pi / 3 * std::pow(radius * voxel, 3)), 1,
                0.01);   // positive: outward is out, mirrored or not
    EXPECT_NEAR(area(s) / (4 * pi * std::pow(radius * voxel, 2)), 1, 0.01);
    EXPECT_LT(scan.error(s), 0.12);   // of a voxel, whose steps are 0.29 rms
    EXPECT_TRUE(boundary_edges(edge_uses(s)).empty());
    EXPECT_EQ(s.space, "RAS");
}

TEST(ImageSurface, tubeIsOpenAndFlatWhereItLeavesTheImage) {
    const Scan scan = Scan(tilted_tube()).fill(as_label);
    const CheckedSurface checked = check_surface(make_image_surface(scan.image));
    EXPECT_TRUE(checked.findings.empty());
    const auto openings = find_openings(checked);
    ASSERT_EQ(openings.size(), 2u);
    const double along = normalized(Vec3{1, 0.13, 0.11}).x, length = scan.image.size[0] * voxel / along;
    EXPECT_NEAR(checked.volume / (pi * std::pow(radius * voxel, 2) * length), 1, 0.01);
    EXPECT_NEAR(area(checked.surface) / (2 * pi * radius * voxel * length), 1, 0.01);
    EXPECT_LT(scan.error(checked.surface), 0.12);
    for (const SurfaceOpening& opening : openings) {
        EXPECT_LT(opening.flatness, 1e-9);
        EXPECT_NEAR(opening.opening.area / (pi * std::pow(radius * voxel, 2) / along), 1, 0.03);
        const double x = scan.index_of(opening.opening.centre).x;
        EXPECT_NEAR(std::min(std::abs(x + 0.5), std::abs(x - scan.image.size[0] + 0.5)), 0,
                    1e-9);   // the voxels' outer faces
    }
}

TEST(ImageSurface, levelSetIsExactWhicheverSideIsNegative) {
    for (double sign : {1.0, -1.0}) {
        const Scan scan = Scan(ball()).fill([=](double distance) { return sign * std::min(distance, 3.0); });
        const Surface s = make_image_surface(scan.image);
        EXPECT_LT(scan.error(s), 0.01);
        EXPECT_NEAR(volume(s) / (4 * pi / 3 * std::pow(radius * voxel, 3)), 1, 0.003);
    }
}

TEST(ImageSurface, stepsOfAnyLengthGiveTheSameSurfaceInSteps) {
    Scan scan = Scan(ball()).fill(as_label);
    const Surface before = make_image_surface(scan.image);
    const Mat3 stretched = scan.image.step * Mat3{{1, 0, 0}, {0, 1, 0}, {0, 0, 2.5}};
    const double factor = determinant(stretched) / determinant(scan.image.step);
    scan.image.step = stretched;
    EXPECT_NEAR(volume(make_image_surface(scan.image)) / volume(before), factor, 1e-9);
}

std::string refusal(const Image& image, std::optional<int> label = {}) {
    try {
        make_image_surface(image, label);
    } catch (const GeometryError& e) {
        return e.what();
    }
    return "";
}

TEST(ImageSurface, oneLabelOfSeveralMustBeChosen) {
    Scan scan = Scan(ball()).fill(as_label);
    const std::size_t alone = make_image_surface(scan.image).triangles.size();
    scan.image.values[100] = 8;
    EXPECT_NE(refusal(scan.image).find("3 and 8"), std::string::npos);
    EXPECT_EQ(make_image_surface(scan.image, 3).triangles.size(), alone);
    EXPECT_NE(refusal(scan.image, 5).find("no label 5"), std::string::npos);
}

TEST(ImageSurface, refusesImagesWithoutAVessel) {
    Scan scan(ball());
    scan.fill([](double) { return 0.0; });
    EXPECT_NE(refusal(scan.image).find("0 everywhere"), std::string::npos);
    scan.image.values[7] = 0.5f;
    EXPECT_NE(refusal(scan.image).find("neither a label map"), std::string::npos);
    scan.image.values[7] = -1;
    EXPECT_NE(refusal(scan.image), "");
}

}   // namespace
}   // namespace patency
