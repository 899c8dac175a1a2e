// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/offenders.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

TEST(Offenders, AreTheLargestWithWhatIsNoNumberFirst) {
    const std::vector<double> badness{1, NAN, 3, 2, INFINITY, 3};
    EXPECT_EQ(worst_of(badness), (std::vector<std::uint32_t>{1, 4, 2, 5, 3, 0}));
    EXPECT_EQ(worst_of(badness, 3), (std::vector<std::uint32_t>{1, 4, 2}));
    EXPECT_TRUE(worst_of({}).empty());
}

}   // namespace
}   // namespace patency
