// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_doubts.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

Json good() { return {{"opened_over_wanted", 1.01}, {"kinetic_to_internal", 0.049}, {"drift_percent", 0.049}}; }
Json with(const char* key, const Json& value) {
    Json deploy = good();
    deploy[key] = value;
    return deploy;
}

std::string only_doubt_about(const Json& deploy) {
    const auto doubts = doubts_about(deploy);
    EXPECT_EQ(doubts.size(), 1u);
    return doubts.empty() ? "" : doubts.front();
}

TEST(DeployDoubts, AreAboutTheBarsThatWereMissed) {
    EXPECT_EQ(doubts_about(good()).size(), 0u);
    EXPECT_NE(only_doubt_about(with("opened_over_wanted", 0.979)).find("wanted diameter"), std::string::npos);
    EXPECT_EQ(doubts_about(with("opened_over_wanted", 0.981)).size(), 0u);
    EXPECT_NE(only_doubt_about(with("kinetic_to_internal", 0.051)).find("quasi-static"), std::string::npos);
    EXPECT_NE(only_doubt_about(with("drift_percent", 0.051)).find("still moving"), std::string::npos);
    Json bad = with("opened_over_wanted", 0.5);
    bad["drift_percent"] = 1;
    EXPECT_EQ(doubts_about(bad).size(), 2u);
}

TEST(DeployDoubts, WhatAGeometricOneDoesNotKnowMissesNothing) {
    EXPECT_EQ(doubts_about(Json::object()).size(), 0u);
    EXPECT_EQ(doubts_about(with("kinetic_to_internal", nullptr)).size(), 0u);
}

}   // namespace
}   // namespace patency
