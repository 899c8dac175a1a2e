// SPDX-License-Identifier: Apache-2.0
// Functions that no register has an instruction for, of a number or lane by lane of a pack: the same bits for both.
#pragma once

#include <cmath>
#include <type_traits>

#include "patency/base/pack.h"

namespace patency {

/// A parameter, as the number type of the values it meets: a number or a pack of it.
template <class T>
PATENCY_INLINE T number(double value) {
    if constexpr (std::is_arithmetic_v<T>)
        return T(value);
    else
        return T(typename T::Scalar(value));
}

namespace detail {
template <class T, int W, class F>
Pack<T, W> for_each_lane(Pack<T, W> a, F f) {
    for (int l = 0; l < W; ++l) a.v[l] = f(a.v[l]);
    return a;
}
}   // namespace detail

using std::cbrt;
using std::exp;
template <class T, int W>
Pack<T, W> exp(Pack<T, W> a) {
    return detail::for_each_lane(a, [](T x) { return std::exp(x); });
}
template <class T, int W>
Pack<T, W> cbrt(Pack<T, W> a) {
    return detail::for_each_lane(a, [](T x) { return std::cbrt(x); });
}

}   // namespace patency
