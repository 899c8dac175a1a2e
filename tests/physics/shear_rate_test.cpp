// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/fluid/shear_rate.h"

#include <gtest/gtest.h>

namespace patency {
namespace {

TEST(ShearRate, is_the_slope_of_a_plane_shear_whichever_way) {
    EXPECT_DOUBLE_EQ(shear_rate(Mat3{{0, 3, 0}, {}, {}}), 3);
    EXPECT_DOUBLE_EQ(shear_rate(Mat3{{}, {}, {0, -3, 0}}), 3);
}

TEST(ShearRate, does_not_see_rotation) {
    const Mat3 spin{{0, -2, 5}, {2, 0, -7}, {-5, 7, 0}};
    EXPECT_EQ(shear_rate(spin), 0);
    const Mat3 shear{{1, 4, 0}, {0, -3, 2}, {6, 0, 2}};
    EXPECT_DOUBLE_EQ(shear_rate(shear + spin), shear_rate(shear));
}

TEST(ShearRate, of_a_stretching_thread) {   // D = diag(e, -e/2, -e/2): 2 D:D = 3 e^2
    EXPECT_DOUBLE_EQ(shear_rate(Mat3{{2, 0, 0}, {0, -1, 0}, {0, 0, -1}}), std::sqrt(12.0));
}

}   // namespace
}   // namespace patency
