// SPDX-License-Identifier: Apache-2.0
// The shear rate of a velocity gradient: what the laws of rheology.h are asked with.
#pragma once

#include <cmath>

#include "patency/base/vec.h"

namespace patency {

/// sqrt(2 D:D) [1/s], D the rate of deformation; the velocity gradient g by rows [1/s].             THEORY.md (10.1)
template <class T>
T shear_rate(const Mat<T>& g) {
    using std::sqrt;
    const Mat<T> d = T(0.5) * (g + transpose(g));
    return sqrt(T(2) * double_dot(d, d));
}

}   // namespace patency
