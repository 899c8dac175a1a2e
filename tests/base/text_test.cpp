// SPDX-License-Identifier: Apache-2.0
#include "patency/base/text.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

TEST(EditDistance, IsAMetric) {
    const std::vector<std::string> words{"", "velocity", "velocty", "viscosity", "flow", "folw"};
    for (const auto& a : words) {
        EXPECT_EQ(edit_distance(a, a), 0u);
        for (const auto& b : words) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << " " << b;
    }
    EXPECT_EQ(edit_distance("velocity", "velocty"), 1u) << "one letter lost";
    EXPECT_EQ(edit_distance("flow", "folw"), 1u) << "neighbours swapped";
    EXPECT_EQ(edit_distance("Flow", "flow"), 0u) << "the size of letters counts for nothing";
    EXPECT_EQ(edit_distance("", "flow"), 4u);
}

TEST(NearestName, IsNearOrNone) {
    const std::vector<std::string> names{"spacing", "sound_speed", "scheme", "seed"};
    EXPECT_EQ(nearest_name("spacng", names), "spacing");
    EXPECT_EQ(nearest_name("soundspeed", names), "sound_speed");
    EXPECT_EQ(nearest_name("duration", names), "");
    EXPECT_EQ(nearest_name(std::string(100000, 'x'), names), "");
}

TEST(Text, SplitAndJoinAreInverse) {
    for (const std::string text : {"", "a", "a.b", ".", "a..b."}) EXPECT_EQ(join(split(text, '.'), "."), text);
    const std::vector<std::string> three{"a", "b", "c"};
    EXPECT_EQ(join(three, ", ", " or "), "a, b or c");
}

TEST(Text, UTF8IsRecognisedAndNeverCut) {
    EXPECT_TRUE(is_utf8_text("5 µm"));
    EXPECT_FALSE(is_utf8_text("5 \xB5m")) << "Latin-1";
    EXPECT_FALSE(is_utf8_text("5 \xC2")) << "cut short";
    EXPECT_FALSE(is_utf8_text(std::string_view("a\0b", 3)));
    for (std::size_t length = 0; length < 8; ++length) EXPECT_TRUE(is_utf8_text(shortened("µµµµ", length))) << length;
}

TEST(Text, QuotesAreEscaped) { EXPECT_EQ(double_quoted("a\"b\\c\nd\x01"), R"("a\"b\\c\nd\u0001")"); }

TEST(Text, NamesAreSafeInPaths) {
    EXPECT_TRUE(is_plain_name("outlet_1-b"));
    for (const char* name : {"", "a b", "../a", "a.b", "a/b", "ä"}) EXPECT_FALSE(is_plain_name(name)) << name;
}

}   // namespace
}   // namespace patency
