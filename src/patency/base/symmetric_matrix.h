// SPDX-License-Identifier: Apache-2.0
// Symmetric 3x3 matrices by their six numbers, of any arithmetic type: fewer operations than with nine.
#pragma once

#include "patency/base/pack.h"
#include "patency/base/vec.h"

namespace patency {

template <class T>
struct Sym {
    T xx, yy, zz, xy, xz, yz;

    PATENCY_INLINE friend Sym operator+(const Sym& a, const Sym& b) {
        return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
    }
    PATENCY_INLINE friend Sym operator*(const T& s, const Sym& a) {
        return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
    }
    PATENCY_INLINE friend T trace(const Sym& a) { return a.xx + a.yy + a.zz; }
    PATENCY_INLINE friend T double_dot(const Sym& a, const Sym& b) {
        const T diagonal = fma(a.xx, b.xx, fma(a.yy, b.yy, a.zz * b.zz)),
                rest = fma(a.xy, b.xy, fma(a.xz, b.xz, a.yz * b.yz));
        return diagonal + (rest + rest);
    }
};

/// a + s 1
template <class T>
PATENCY_INLINE Sym<T> plus_unit(const Sym<T>& a, const T& s) {
    return {a.xx + s, a.yy + s, a.zz + s, a.xy, a.xz, a.yz};
}

namespace detail {
template <class T>
PATENCY_INLINE T dot3(const T& a, const T& b, const T& c, const T& x, const T& y, const T& z) {
    return fma(a, x, fma(b, y, c * z));
}
}   // namespace detail

/// a b where the two commute, so that the product is symmetric too.
template <class T>
PATENCY_INLINE Sym<T> commuting_product(const Sym<T>& a, const Sym<T>& b) {
    using detail::dot3;
    return {dot3(a.xx, a.xy, a.xz, b.xx, b.xy, b.xz), dot3(a.xy, a.yy, a.yz, b.xy, b.yy, b.yz),
            dot3(a.xz, a.yz, a.zz, b.xz, b.yz, b.zz), dot3(a.xx, a.xy, a.xz, b.xy, b.yy, b.yz),
            dot3(a.xx, a.xy, a.xz, b.xz, b.yz, b.zz), dot3(a.xy, a.yy, a.yz, b.xz, b.yz, b.zz)};
}

template <class T>
PATENCY_INLINE Vec<T> operator*(const Sym<T>& s, const Vec<T>& v) {
    using detail::dot3;
    return {dot3(s.xx, s.xy, s.xz, v.x, v.y, v.z), dot3(s.xy, s.yy, s.yz, v.x, v.y, v.z),
            dot3(s.xz, s.yz, s.zz, v.x, v.y, v.z)};
}

/// M S M^T
template <class T>
PATENCY_INLINE Sym<T> congruent(const Mat<T>& m, const Sym<T>& s) {
    const auto times = [](const Vec<T>& a, const Vec<T>& b) __attribute__((always_inline)) {
        return detail::dot3(a.x, a.y, a.z, b.x, b.y, b.z);
    };
    const Vec<T> x = s * m.x, y = s * m.y, z = s * m.z;
    return {times(x, m.x), times(y, m.y), times(z, m.z), times(x, m.y), times(x, m.z), times(y, m.z)};
}

/// The inverse by cofactors; the determinant must not vanish.
template <class T>
PATENCY_INLINE Sym<T> inverse(const Sym<T>& a) {
    const auto minor = [](const T& p, const T& q, const T& r, const T& s) __attribute__((always_inline)) {
        return fma(p, q, -(r * s));
    };
    const Sym<T> c{minor(a.yy, a.zz, a.yz, a.yz), minor(a.xx, a.zz, a.xz, a.xz), minor(a.xx, a.yy, a.xy, a.xy),
                   minor(a.xz, a.yz, a.xy, a.zz), minor(a.xy, a.yz, a.xz, a.yy), minor(a.xy, a.xz, a.xx, a.yz)};
    const T det = detail::dot3(a.xx, a.xy, a.xz, c.xx, c.xy, c.xz);
    return (T(1) / det) * c;
}

}   // namespace patency
