// SPDX-License-Identifier: Apache-2.0
#include "patency/base/median.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

TEST(Median, IsInTheMiddleOfWhatIsSorted) {
    EXPECT_EQ(median({7}), 7);
    EXPECT_EQ(median({9, 1, 4}), 4);
    EXPECT_EQ(median({3, 8, 1, 5}), 5);   // the larger of the two
    EXPECT_EQ(median({1e9, 2, 2, 1, 3}), 2);
}

}   // namespace
}   // namespace patency
