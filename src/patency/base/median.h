// SPDX-License-Identifier: Apache-2.0
// The value in the middle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace patency {

/// Of at least one value; of an even number of them the larger of the two in the middle.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}   // namespace patency
