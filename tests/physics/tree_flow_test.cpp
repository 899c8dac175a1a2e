// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/tree/tree_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi, mu = 3.5e-3, rho = 1060;
const TreeBlood blood{rho, [](double) { return mu; }};

double disc(double diameter) { return pi / 4 * diameter * diameter; }

TreeBranch tube(int parent, double length, double from, double to, int stations = 101) {
    TreeBranch b;
    b.name = "tube", b.parent = parent;
    for (int k = 0; k < stations; ++k) {
        const double share = double(k) / (stations - 1);
        b.arc.push_back(share * length);
        b.area.push_back(disc(from + share * (to - from)));
    }
    return b;
}

double poiseuille(double length, double diameter) { return 128 * mu * length / (pi * std::pow(diameter, 4)); }

/// A parent that parts into two, straight on.
TreeCase make_y() {
    return {{tube(-1, 0.02, 4e-3, 4e-3), tube(0, 0.03, 3e-3, 3e-3), tube(0, 0.01, 2.5e-3, 2.5e-3)},
            blood,
            TreeFlowRate{2e-6},
            {TreePressure{0}, TreeResistance{2e9, 100}, TreeResistance{3e9, 200}}};
}

TEST(TreeFlow, ATubeHasThePressureDropOfPoiseuille) {
    const TreeCase tree{{tube(-1, 0.03, 3e-3, 3e-3)}, blood, TreeFlowRate{1e-6}, {TreePressure{50}}, 0};
    const TreeFlow answer = solve_tree(tree);
    EXPECT_NEAR(answer.flow[0], 1e-6, 1e-16);
    EXPECT_NEAR(answer.inlet_pressure - 50, poiseuille(0.03, 3e-3) * 1e-6, 1e-6);
    EXPECT_NEAR(answer.pressure[0][50] - 50, 0.5 * poiseuille(0.03, 3e-3) * 1e-6, 1e-6);
}

TEST(TreeFlow, AFlatProfileCostsTheExcessOfAnEntrance) {
    TreeCase tree{{tube(-1, 0.5, 3e-3, 3e-3)}, blood, TreeFlowRate{1e-6}, {TreePressure{0}}, 1};
    const double flat = solve_tree(tree).inlet_pressure;
    tree.inlet_entrance = 0;
    const double excess = flat - solve_tree(tree).inlet_pressure;
    EXPECT_NEAR(excess / (0.5 * rho * std::pow(1e-6 / disc(3e-3), 2)), 1.25, 0.05);   // Shah & London 1978
}

TEST(TreeFlow, BloodThatRunsBackLosesAsMuch) {
    TreeCase tree{{tube(-1, 0.03, 3e-3, 3e-3)}, blood, TreeFlowRate{-1e-6}, {TreePressure{0}}};
    EXPECT_NEAR(solve_tree(tree).inlet_pressure, -poiseuille(0.03, 3e-3) * 1e-6, 1e-6);
}

TEST(TreeFlow, FlowsAddUpAndEveryEndHasItsLaw) {
    const TreeCase tree = make_y();
    const TreeFlow answer = solve_tree(tree);
    EXPECT_NEAR(answer.flow[0], 2e-6, 1e-15);
    EXPECT_NEAR(answer.flow[1] + answer.flow[2], 2e-6, 1e-15);
    EXPECT_NEAR(answer.pressure[1].back(), 100 + 2e9 * answer.flow[1], 1e-4);
    EXPECT_NEAR(answer.pressure[2].back(), 200 + 3e9 * answer.flow[2], 1e-4);
    EXPECT_GT(answer.flow[1], answer.flow[2]);
}

TEST(TreeFlow, APressureAtTheInletDrivesTheFlowThatNeedsIt) {
    TreeCase tree = make_y();
    const TreeFlow driven = solve_tree(tree);
    tree.inlet = TreePressure{driven.inlet_pressure};
    const TreeFlow again = solve_tree(tree);
    for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(again.flow[b] / driven.flow[b], 1, 1e-8);
}

TEST(TreeFlow, AnOffsetOfAllPressuresChangesNoFlow) {
    TreeCase tree = make_y();
    const TreeFlow before = solve_tree(tree);
    std::get<TreeResistance>(tree.outlets[1]).distal_pressure += 10000;
    std::get<TreeResistance>(tree.outlets[2]).distal_pressure += 10000;
    const TreeFlow after = solve_tree(tree);
    EXPECT_NEAR(after.inlet_pressure - before.inlet_pressure, 10000, 1e-3);
    for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(after.flow[b] / before.flow[b], 1, 1e-8);
}

TEST(TreeFlow, TwinBranchesShareEqually) {
    TreeCase tree = make_y();
    tree.branches[2] = tree.branches[1];
    tree.outlets[2] = tree.outlets[1];
    const TreeFlow answer = solve_tree(tree);
    EXPECT_NEAR(answer.flow[1], 1e-6, 1e-14);
}

TEST(TreeFlow, SizesDoNotMatterForLikeFlows) {   // the same Reynolds number at ten times the size
    TreeCase tree = make_y(), large = tree;
    for (TreeBranch& b : large.branches)
        for (std::size_t k = 0; k < b.arc.size(); ++k) b.arc[k] *= 10, b.area[k] *= 100;
    tree.outlets = {TreePressure{0}, TreePressure{0}, TreePressure{0}}, large.outlets = tree.outlets;
    large.inlet = TreeFlowRate{2e-5};
    const TreeFlow a = solve_tree(tree), b = solve_tree(large);
    EXPECT_NEAR(b.flow[1] / a.flow[1], 10, 1e-7);
    EXPECT_NEAR(a.inlet_pressure / b.inlet_pressure, 100, 1e-5);
}

TEST(TreeFlow, ATurnCostsAndStraightOnAtTheSameSpeedDoesNot) {
    TreeCase tree{{tube(-1, 0.01, 3e-3, 3e-3), tube(0, 0.01, 3e-3, 3e-3)},
                  blood,
                  TreeFlowRate{2e-6},
                  {TreePressure{0}, TreePressure{0}},
                  0};
    const double straight = solve_tree(tree).inlet_pressure;
    TreeCase one{{tube(-1, 0.01, 3e-3, 3e-3)}, blood, TreeFlowRate{2e-6}, {TreePressure{0}}, 0};
    const double first = solve_tree(one).inlet_pressure;
    const double dynamic = 0.5 * rho * std::pow(2e-6 / disc(3e-3), 2);
    EXPECT_GT(straight, 2 * first + 0.05 * dynamic);   // friction and a part of an entrance, no more
    EXPECT_LT(straight, 2 * first + 0.7 * dynamic);
    tree.branches[1].turn = pi / 2;
    EXPECT_NEAR(solve_tree(tree).inlet_pressure, straight + 2 * (1 - std::cos(0.375 * pi)) * dynamic, 1e-6);
}

TEST(TreeFlow, ASlowBranchRegainsPartOfWhatItsParentsSpeedIsWorth) {
    // Straight on into twice the area. Borda and Carnot: rho U_b (U_p - U_b), less friction.
    const double flow = 2e-6, parent_speed = flow / disc(3e-3), gain = rho * 0.5 * parent_speed * 0.5 * parent_speed;
    const TreeCase tree{{tube(-1, 0.01, 3e-3, 3e-3), tube(0, 0.05, 3e-3 * std::sqrt(2), 3e-3 * std::sqrt(2))},
                        blood,
                        TreeFlowRate{flow},
                        {TreePressure{0}, TreePressure{0}},
                        0};
    const TreeFlow answer = solve_tree(tree);
    const auto& pressure = answer.pressure[1];
    EXPECT_NEAR(pressure.front(), answer.pressure[0].back(), 1e-9);   // a jet has its parent's
    const double regained = *std::max_element(pressure.begin(), pressure.end()) - pressure.front();
    EXPECT_GT(regained, 0.25 * gain);
    EXPECT_LT(regained, gain);
    EXPECT_GT(answer.profile[1].front().speed[0], 2.4);   // 1.5 on the axis, over half of the area: 3, in a ring's mean
    EXPECT_EQ(answer.profile[1].front().speed.back(), 0);
}

TEST(TreeFlow,
     AHairThinThroatLetsThroughWhatThePressureDrives) {   // the flow that it begins with is far too much for it
    TreeBranch throat = tube(-1, 0.03, 3e-3, 3e-3, 301);
    for (std::size_t k = 0; k < throat.arc.size(); ++k)
        throat.area[k] *= std::pow(1 - 0.95 * std::exp(-std::pow((throat.arc[k] - 0.015) / 1e-3, 2)), 2);
    const TreeFlow answer = solve_tree({{throat}, blood, TreePressure{10000}, {TreePressure{0}}, 0});
    EXPECT_GT(answer.flow[0], 0);
    EXPECT_LT(answer.flow[0], disc(0.15e-3) * std::sqrt(2 * 10000 / rho));
    EXPECT_NEAR(answer.pressure[0].back(), 0, 1e-2);
}

TEST(TreeFlow, NoGivenFlowEndsInAPressureThatIsNotANumber) {   // through throats that nothing drives it through
    int refused = 0;
    for (double depth : {0.85, 0.93, 0.97})
        for (double width : {1e-3, 4e-3})
            for (double flow : {1e-6, 1e-5}) {
                TreeBranch throat = tube(-1, 0.03, 3e-3, 3e-3, 301);
                for (std::size_t k = 0; k < throat.arc.size(); ++k)
                    throat.area[k] *= std::pow(1 - depth * std::exp(-std::pow((throat.arc[k] - 0.015) / width, 2)), 2);
                try {
                    const TreeFlow answer = solve_tree({{throat}, blood, TreePressure{0}, {TreeFlowRate{flow}}, 0});
                    EXPECT_TRUE(std::isfinite(answer.pressure[0].back())) << depth << " " << width << " " << flow;
                } catch (const GeometryError&) {
                    ++refused;
                }
            }
    EXPECT_GT(refused, 0);
}

TEST(TreeFlow, WhatCannotBeSolvedIsSaid) {
    TreeCase tree = make_y();
    tree.outlets[1] = TreeFlowRate{1e-6}, tree.outlets[2] = TreeFlowRate{1e-6};
    EXPECT_THROW(solve_tree(tree), DeckError);
    tree = make_y();
    tree.branches[1].area[3] = 0;
    EXPECT_THROW(solve_tree(tree), GeometryError);
    tree = make_y();
    tree.branches[1].parent = 2;
    EXPECT_THROW(solve_tree(tree), GeometryError);
}

}   // namespace
}   // namespace patency
