// SPDX-License-Identifier: Apache-2.0
// Cubes of space by a number, for places that may lie anywhere.
#pragma once

#include <cmath>
#include <cstdint>

#include "patency/base/vec.h"

namespace patency {

struct CellHash {
    double side;   ///< [m]
    std::uint64_t operator()(const Vec3& x) const { return key(index(x.x), index(x.y), index(x.z)); }
    std::int64_t index(double x) const { return std::int64_t(std::floor(x / side)); }
    /// Different for cubes within 2^20 of each other on every axis.
    static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
        return (std::uint64_t(i) & 0x1fffff) << 42 | (std::uint64_t(j) & 0x1fffff) << 21 |
               (std::uint64_t(k) & 0x1fffff);
    }
};

}   // namespace patency
