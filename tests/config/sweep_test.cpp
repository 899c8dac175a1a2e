// SPDX-License-Identifier: Apache-2.0
#include "patency/config/sweep.h"

#include <gtest/gtest.h>

#include <set>

#include "patency/base/errors.h"

namespace patency::deck {
namespace {

using Texts = std::vector<std::string>;

TEST(SweepAxis, HasTheValuesBetweenItsCommas) {
    const SweepAxis axis = parse_axis("blood.viscosity= 3.5 mPa s , 4 mPa s");
    EXPECT_EQ(axis.key, "blood.viscosity");
    EXPECT_EQ(axis.values, (Texts{"3.5 mPa s", "4 mPa s"}));
    EXPECT_EQ(parse_axis("case.name=a=b").values, Texts{"a=b"});
}

TEST(SweepAxis, KeepsCommasThatBelongToAValue) {
    EXPECT_EQ(parse_axis("stent.placement={branch: a, arc_length: 2 mm},null").values,
              (Texts{"{branch: a, arc_length: 2 mm}", "null"}));
    EXPECT_EQ(parse_axis("body_force=[0, [1, 2]],[3]").values, (Texts{"[0, [1, 2]]", "[3]"}));
    EXPECT_EQ(parse_axis("case.name=\"a,b\",'c,\"d'").values, (Texts{"\"a,b\"", "'c,\"d'"}));
}

TEST(SweepAxis, RefusesWhatIsNone) {
    for (const char* wrong : {"viscosity", "=3", "a=", "a=1,,2", "a=1,1"})
        EXPECT_THROW(parse_axis(wrong), UsageError) << wrong;
}

TEST(SweepPoints, AreAllCombinationsWithTheLastAxisFastest) {
    const auto points = combine({{"a", {"1", "2"}}, {"b", {"x"}}, {"c", {"3", "4", "5"}}});
    ASSERT_EQ(points.size(), 6u);
    EXPECT_EQ(points[0].values, (Texts{"1", "x", "3"}));
    EXPECT_EQ(points[1].values, (Texts{"1", "x", "4"}));
    EXPECT_EQ(points[5].values, (Texts{"2", "x", "5"}));
    EXPECT_EQ(points[5].name, "a=2,c=5");   // b does not vary
}

TEST(SweepPoints, HaveNamesThatAreDifferentAndFitForFolders) {
    const auto points = combine({{"a.spacing", {"0.2 mm", "0.2_mm"}}, {"b.spacing", {"{x: /}", "\"../..\""}}});
    std::set<std::string> names;
    for (const SweepPoint& point : points) {
        names.insert(point.name);
        EXPECT_EQ(point.name.find_first_of("/ \"{}\\"), std::string::npos) << point.name;
    }
    EXPECT_EQ(names.size(), 4u);
    EXPECT_EQ(points[0].name, "a.spacing=0.2_mm,b.spacing=x");   // keys alike in their last part stay whole
}

TEST(SweepPoints, KeepTheirNamesWhenValuesAreAdded) {
    const auto small = combine({{"a", {"2", "3"}}, {"b", {"4", "5"}}}),
               large = combine({{"a", {"1", "2", "3"}}, {"b", {"5", "4"}}});
    std::set<std::string> names;
    for (const SweepPoint& point : large) names.insert(point.name);
    for (const SweepPoint& point : small) EXPECT_TRUE(names.count(point.name)) << point.name;
}

TEST(SweepPoints, NeedSomethingThatVariesAndEachKeyOnce) {
    EXPECT_THROW(combine({}), UsageError);
    EXPECT_THROW(combine({{"a", {"1"}}}), UsageError);
    EXPECT_THROW(combine({{"a", {"1", "2"}}, {"a", {"3"}}}), UsageError);
}

}   // namespace
}   // namespace patency::deck
