// SPDX-License-Identifier: Apache-2.0
// Sums of vectors by weights from all over memory: what carries a vertex, what moves with a patch.
#pragma once

#include "patency/base/pack.h"
#include "patency/base/vec.h"

namespace patency {

/// sum w v, with two components side by side.
class WeightedSum {
public:
    PATENCY_INLINE void add(double w, const Vec3& v) {
        xy_ = fma(Pack<double, 2>(w), Pack<double, 2>::load(&v.x), xy_);
        z_ = std::fma(w, v.z, z_);
    }
    PATENCY_INLINE Vec3 value() const { return {xy_[0], xy_[1], z_}; }

private:
    Pack<double, 2> xy_{0.0};
    double z_ = 0;
};

}   // namespace patency
