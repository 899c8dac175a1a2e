// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_terms.h"

#include <gtest/gtest.h>

namespace patency::cell_terms {
namespace {

const CellState left{1.5, {0.3, -0.1, 0.2}, {2, -1, 4}, {{1, 2, 3}, {-2, 0.5, 1}, {0, 1, -1.5}}, 0.02, 0.4};
const CellState right{0.7, {0.2, 0.4, -0.3}, {1, 0, -2}, {{0.3, 1, -1}, {2, 1, 0}, {1, 4, -1.3}}, 0.05, 0.7};
const Vec3 area{0.02, 0.01, -0.005}, from_left{0.1, 0.03, -0.02}, from_right{-0.08, -0.04, 0.03};

TEST(CellTerms, leaveOneCellAndEnterTheOther) {
    for (const bool is_newtonian : {true, false}) {
        const Flux there =
            through_face({area, norm(area), 0.1, from_left, from_right}, left, right, sharp, is_newtonian);
        const Flux back =
            through_face({-area, norm(area), 0.1, from_right, from_left}, right, left, sharp, is_newtonian);
        EXPECT_DOUBLE_EQ(there.volume, -back.volume);
        EXPECT_LT(norm(there.momentum + back.momentum), 1e-15);
        EXPECT_NE(there.volume, 0);
    }
}

// A linear pressure is the same from both sides: nothing is dissipated.
TEST(CellTerms, carryALinearFieldExactly) {
    const auto state_at = [](const Vec3& x) {
        const Mat3 g{{1, 2, 3}, {-2, 0.5, 1}, {0, 1, -1.5}};
        const Vec3 slope{2, -1, 4};
        return CellState{5 + dot(slope, x), Vec3{1, 0, 2} + g * x, slope, g, 0.02, 0.4};
    };
    const Vec3 a{0.1, 0.2, 0}, b{0.3, 0.1, 0.1}, c{0.22, 0.17, 0.04};
    const Flux flux = through_face({area, norm(area), 0.1, c - a, c - b}, state_at(a), state_at(b), sharp, true);
    const CellState there = state_at(c);
    EXPECT_NEAR(flux.volume, dot(area, there.u), 1e-15);
    const Vec3 normal = (1 / norm(area)) * area;
    const Vec3 expected = flux.volume * there.u +
                          carried_by_spread(norm(area), normal, there.grad_u, sharp.second_moment) + there.p * area -
                          0.02 * 0.1 * (there.grad_u * (b - a));
    EXPECT_LT(norm(flux.momentum - expected), 1e-15);
}

// Over a square the mean of (u' . n) u' is known in closed form; the face's second moment is that of a rounder one.
TEST(CellTerms, carryTheSpreadOfAShear) {
    const double side = 0.2, rate = 3, tilt = 0.7;   // u = (tilt y, rate y, 0), n = y's neighbour x
    Mat3 g{};
    g = outer(Vec3{tilt, rate, 0}, Vec3{0, 1, 0});
    const Vec3 spread = carried_by_spread(side * side, Vec3{1, 0, 0}, g, sharp.second_moment);
    const double second_moment = side * side / 12;   // mean of y^2
    EXPECT_NEAR(spread.x / (side * side * tilt * tilt * second_moment), 1, 0.05);
    EXPECT_NEAR(spread.y / (side * side * tilt * rate * second_moment), 1, 0.05);
    EXPECT_EQ(spread.z, 0);
    EXPECT_EQ(norm(carried_by_spread(1, Vec3{0, 1, 0}, g, sharp.second_moment)),
              0);   // along n itself there is no spread
}

// u = s (alpha + beta s) over a plane wall: value and slope at s give alpha.
TEST(CellTerms, readTheSlopeOfAParabolaAtTheWall) {
    const double alpha = 3, beta = -2, s = 0.1;
    const Vec3 normal{0, 1, 0};   // out of the blood
    CellState cell{};
    cell.u = {s * (alpha + beta * s), 0, 0};
    cell.grad_u.x = -(alpha + 2 * beta * s) * normal;
    EXPECT_NEAR(wall_slope(cell, s * normal, s).x, alpha, 1e-14);
    cell.grad_u.x = -alpha * normal;
    cell.u = {s * alpha, 0, 0};
    EXPECT_NEAR(wall_slope(cell, s * normal + Vec3{0.3, 0, 0.2}, s).x, alpha, 1e-14) << "beside the point too";
}

TEST(CellTerms, answerToAFlowAtOnce) {
    const OpenResponse outlet{2, 30};
    const double free = 0.4, conductance = 0.05, p = outlet.pressure(free, conductance);
    EXPECT_NEAR(p, 2 + 30 * (free - conductance * p), 1e-14);
    EXPECT_NEAR(outlet.slope(conductance), (outlet.pressure(free + 1, conductance) - p), 1e-14);
}

}   // namespace
}   // namespace patency::cell_terms
