// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/wall_thickness.h"

#include <gtest/gtest.h>

namespace patency {

TEST(WallThickness, RisesLinearlyBetweenThePapersEndsAndNeverFalls) {
    EXPECT_NEAR(coronary_wall_thickness(2e-3), 0.55e-3, 1e-12);
    EXPECT_NEAR(coronary_wall_thickness(3e-3), 0.775e-3, 1e-12);
    EXPECT_NEAR(coronary_wall_thickness(4e-3), 1e-3, 1e-12);
    EXPECT_EQ(coronary_wall_thickness(0.5e-3), 0.55e-3);
    EXPECT_EQ(coronary_wall_thickness(15e-3), 1e-3);
    double last = 0;
    for (double d = 0.1e-3; d < 6e-3; d += 0.1e-3) {
        EXPECT_GE(coronary_wall_thickness(d), last);
        last = coronary_wall_thickness(d);
    }
}

}   // namespace patency
