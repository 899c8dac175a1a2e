// SPDX-License-Identifier: Apache-2.0
// The numbers that the loops over neighbours work in.
#pragma once

namespace patency {

/// mixed: the state in double, sums over neighbours in float of coordinates in fixed point.
enum class Precision { mixed, double_precision };

}   // namespace patency
