// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_rest.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

constexpr double span = 0.1;

StentProfile wide(double mean, double least) {
    StentProfile profile;
    profile.mean_diameter = mean, profile.least_diameter = least;
    return profile;
}

TEST(DeployRest, ComparesOverItsSpanOnly) {
    DeployRest rest;
    EXPECT_FALSE(rest.compare(1, wide(3, 2), span));
    EXPECT_FALSE(rest.compare(1.05, wide(9, 9), span));
    EXPECT_TRUE(rest.compare(1.1, wide(3.03, 2), span));
    EXPECT_NEAR(rest.moved(), 0.01, 1e-12) << "since 1, not since 1.05";
    EXPECT_FALSE(rest.compare(1.15, wide(3.03, 2), span));
    EXPECT_TRUE(rest.compare(1.25, wide(3.03, 2), span)) << "since 1.1";
    EXPECT_EQ(rest.moved(), 0);
}

TEST(DeployRest, TheMeanOrTheLeastWhicheverMovesMore) {
    DeployRest rest;
    rest.compare(0, wide(3, 2), span);
    ASSERT_TRUE(rest.compare(1, wide(3.03, 1.9), span));
    EXPECT_NEAR(rest.moved(), 0.05, 1e-12);
    EXPECT_NEAR(rest.shrunk(), 0.05, 1e-12);
    ASSERT_TRUE(rest.compare(2, wide(2.7, 1.9), span));
    EXPECT_NEAR(rest.moved(), 0.33 / 3.03, 1e-12);
    EXPECT_NEAR(rest.shrunk(), 0.33 / 3.03, 1e-12);
}

/// What swings back is not going after its tool.
TEST(DeployRest, WhatGrowsDoesNotShrink) {
    DeployRest rest;
    rest.compare(0, wide(3, 2), span);
    ASSERT_TRUE(rest.compare(1, wide(3.3, 2.1), span));
    EXPECT_NEAR(rest.moved(), 0.1, 1e-12);
    EXPECT_LT(rest.shrunk(), 0);
}

TEST(DeployRest, BeginsAnewWhereItIsDisturbed) {
    DeployRest rest;
    rest.compare(0, wide(3, 2), span);
    rest.begin();
    EXPECT_FALSE(rest.compare(1, wide(3, 2), span));
    EXPECT_TRUE(rest.compare(1.1, wide(3, 2), span));
}

TEST(DeployRest, GoesOnFromItsNumbers) {
    DeployRest rest, other;
    rest.compare(0, wide(3, 2), span);
    rest.compare(0.1, wide(3.1, 2), span);
    const auto from = rest.numbers(), to = other.numbers();
    ASSERT_EQ(from.size(), to.size());
    for (std::size_t k = 0; k < from.size(); ++k) *to[k] = *from[k];
    EXPECT_EQ(other.moved(), rest.moved());
    EXPECT_EQ(other.shrunk(), rest.shrunk());
    for (DeployRest* r : {&rest, &other}) EXPECT_TRUE(r->compare(0.2, wide(3.2, 1.9), span));
    EXPECT_EQ(other.moved(), rest.moved());
    EXPECT_GT(other.shrunk(), 0);
}

}   // namespace
}   // namespace patency
