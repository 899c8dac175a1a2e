// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/bed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "patency/base/errors.h"

namespace patency {
namespace {

const BedDemand demand{12400, 666, 4e-6, 3};

TEST(Bed, SharesGoWithThePowerOfTheDiameter) {
    const auto shares = murray_shares({2e-3, 1e-3}, 3);
    EXPECT_NEAR(shares[0], 8.0 / 9, 1e-14);
    EXPECT_NEAR(shares[1], 1.0 / 9, 1e-14);
    for (double share : murray_shares({3e-3, 2e-3, 1e-3, 0.7e-3}, 0)) EXPECT_NEAR(share, 0.25, 1e-14);
}

TEST(Bed, ResistancesBesideEachOtherTakeTheWholeFlow) {
    const auto resistances = bed_resistances({3e-3, 2.5e-3, 1.2e-3}, demand);
    double flow = 0;
    for (double r : resistances) flow += (demand.aortic_pressure - demand.venous_pressure) / r;
    EXPECT_NEAR(flow / demand.flow, 1, 1e-12);
    EXPECT_NEAR(resistances[2] / resistances[0], std::pow(3 / 1.2, 3), 1e-9);
}

TEST(Bed, WithoutADrivingPressureThereIsNoAnswer) {
    EXPECT_THROW(bed_resistances({3e-3}, {600, 666, 4e-6, 3}), DeckError);
}

}   // namespace
}   // namespace patency
