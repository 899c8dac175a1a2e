// SPDX-License-Identifier: Apache-2.0
// What laws of solids share: measures of a deformation gradient F, and one stress told as another.  THEORY (19.1), (19.2)
#pragma once

#include <type_traits>

#include "patency/base/lane_math.h"
#include "patency/base/vec.h"

namespace patency {

/// J F^-T, the matrix of cofactors: defined for any F, and F^-T is it over J.
template <class T>
Mat<T> cofactor(const Mat<T>& F) {
    return {cross(F.y, F.z), cross(F.z, F.x), cross(F.x, F.y)};
}
template <class T>
T double_dot(const Mat<T>& a, const Mat<T>& b) {
    return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
}
/// A parameter of a law, as the number type of its arguments.
template <class T>
T number(double value) {
    if constexpr (std::is_arithmetic_v<T>) return T(value);
    else return T(typename T::Scalar(value));
}
/// a - tr(a)/3 1
template <class T>
Mat<T> deviator(const Mat<T>& a) {
    return a - (number<T>(1.0 / 3) * trace(a)) * identity<T>();
}

/// P = tau F^-T, S = F^-1 P: first and second Piola-Kirchhoff from the Kirchhoff stress tau = J sigma.
inline Mat3 pk1_of_kirchhoff(const Mat3& tau, const Mat3& F) { return tau * transpose(inverse(F)); }
inline Mat3 pk2_of_pk1(const Mat3& P, const Mat3& F) { return inverse(F) * P; }
inline Mat3 kirchhoff_of_pk1(const Mat3& P, const Mat3& F) { return P * transpose(F); }

/// sqrt(3/2 dev : dev) of a symmetric stress: equals |sigma| in uniaxial tension.
inline double von_mises(const Mat3& stress) {
    const Mat3 s = deviator(stress);
    return std::sqrt(1.5 * double_dot(s, s));
}

}   // namespace patency
