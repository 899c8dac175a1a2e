// SPDX-License-Identifier: Apache-2.0
// How narrow the way through a vessel is, for speeds and losses that are expected before anything is computed.
#pragma once

namespace patency {

/// Of a vessel whose outlets share the flow. Zeros where nobody said.
struct Passage {
    /// The smallest section over the share of the inflow that is likely to pass it: the inflow over it is the largest mean
    /// speed [m^2]; planar: the width [m].
    double tightest_area = 0;
    /// Share of the inflow over the squared section, summed along the way on which that is most: Poiseuille's loss is
    /// 8 pi mu Q times it [1/m^3].
    double drag = 0;
};

}   // namespace patency
