// SPDX-License-Identifier: Apache-2.0
// Which of many values a run that went wrong is to show.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace patency {

inline constexpr std::size_t most_offenders = 1000;   // enough to see where

/// The indices of the largest numbers, those that are none first; of equal ones the lower index.
inline std::vector<std::uint32_t> worst_of(std::span<const double> badness, std::size_t most = most_offenders) {
    const auto value = [&](std::uint32_t i) { return std::isfinite(badness[i]) ? badness[i] : INFINITY; };
    std::vector<std::uint32_t> worst(badness.size());
    std::iota(worst.begin(), worst.end(), 0u);
    const std::size_t count = std::min(most, worst.size());
    std::partial_sort(
        worst.begin(), worst.begin() + std::ptrdiff_t(count), worst.end(),
        [&](std::uint32_t a, std::uint32_t b) { return value(a) != value(b) ? value(a) > value(b) : a < b; });
    worst.resize(count);
    return worst;
}

}   // namespace patency
