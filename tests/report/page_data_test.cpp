// SPDX-License-Identifier: Apache-2.0
#include "patency/report/page_data.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patency {
namespace {

PolyData tent() {
    PolyData data{.points = {{0, 0, 0}, {0.02, 0, 0}, {0.02, 0.01, 0.003}, {0, 0.01, -0.001}},
                  .lines = {},
                  .triangles = {{0, 1, 2}, {0, 2, 3}}};
    data.arrays = {{"Pressure", "Pa", 1, {100, 50, 0, 25}},
                   {"WSS", "Pa", 3, {3, 4, 0, 0, 0, 2, 1, 2, 2, 0, 0, 0}},
                   {"IsResolved", "1", 1, {1, 1, 1, 0}}};
    return data;
}
const std::vector<FieldChoice> fields = {{"Pressure", "P"}, {"WSS", "S"}, {"Absent", "A"}};

/// The layout that web/src/model.ts reads, and what rounding to 16 bits may cost: half a step.
TEST(PageData, PointsAndFieldsComeBackWithinHalfAStep) {
    const PolyData data = tent();
    const Piece piece = make_piece(data, shown_surface(data, 100), fields, Joints::included);
    ASSERT_EQ(piece.words.size(), 3 * 4u + 2 * 4u + 3 * 2u);
    EXPECT_EQ(piece.points, 4u);
    EXPECT_EQ(piece.triangles, 2u);
    const double step = piece.step;
    EXPECT_NEAR(step, 20.0 / 65535, 1e-12);   // the longest side of the box
    for (std::size_t p = 0; p < 4; ++p) {
        const Vec3 x = 1e3 * data.points[p];
        const double here[3] = {x.x - piece.origin.x, x.y - piece.origin.y, x.z - piece.origin.z};
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(step * piece.words[3 * p + c], here[c], 0.5001 * step);
    }
    ASSERT_EQ(piece.fields.size(), 2u);
    const auto value = [&](std::size_t field, std::size_t p) {
        const PieceField& about = piece.fields[field];
        return about.low + piece.words[12 + 4 * field + p] / 65534.0 * (about.high - about.low);
    };
    for (std::size_t p = 0; p < 3; ++p) EXPECT_NEAR(value(0, p), data.arrays[0].values[p], 100.0 / 65534 * 0.51);
    EXPECT_NEAR(value(1, 0), 5, 1e-3);   // of a vector its length
    EXPECT_NEAR(value(1, 2), 3, 1e-3);
    EXPECT_EQ(piece.fields[0].low, 0);   // the point without a value does not count
}

TEST(PageData, WhatIsNotResolvedHasNoValue) {
    const PolyData data = tent();
    const Piece piece = make_piece(data, shown_surface(data, 100), fields, Joints::included);
    EXPECT_EQ(piece.words[12 + 3], no_value);
    for (std::size_t p = 0; p < 3; ++p) EXPECT_NE(piece.words[12 + p], no_value);
}

TEST(PageData, AFieldOfOneValueIsThatValue) {
    PolyData data = tent();
    data.arrays[0].values = {7, 7, 7, 7};
    const Piece piece = make_piece(data, shown_surface(data, 100), fields, Joints::left_out);
    EXPECT_EQ(piece.triangles, 0u);
    EXPECT_EQ(piece.fields[0].low, 7);
    EXPECT_EQ(piece.words[12], 0);
}

TEST(PageData, LinesKeepTheirEnds) {
    PolyData data{.points = std::vector<Vec3>(25), .lines = {{}, {}}};
    for (std::uint32_t k = 0; k < 25; ++k) data.points[k] = {0.001 * k, 0, 0}, data.lines[k < 20 ? 0 : 1].push_back(k);
    const Shown shown = shown_lines(data, 10);
    ASSERT_EQ(shown.lines.size(), 2u);
    EXPECT_EQ(shown.lines[0] + shown.lines[1], shown.points.size());
    EXPECT_EQ(shown.points.front(), 0u);
    EXPECT_EQ(shown.points[shown.lines[0] - 1], 19u);
    EXPECT_EQ(shown.points.back(), 24u);
    EXPECT_LE(shown.points.size(), 10 + 2 * data.lines.size());
    EXPECT_EQ(shown_lines(data, 100).points.size(), 25u);
}

TEST(PageData, PointsAreThinnedEvenly) {
    const PolyData data{.points = std::vector<Vec3>(100)};
    const Shown shown = shown_points(data, 30);
    EXPECT_LE(shown.points.size(), 30u);
    EXPECT_GE(shown.points.size(), 20u);
}

}   // namespace
}   // namespace patency
