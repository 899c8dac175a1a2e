// SPDX-License-Identifier: Apache-2.0
// What laws of solids share: measures of a deformation gradient F, and one stress told as another.  THEORY (19.1), (19.2)
#pragma once

#include <cmath>

#include "patency/base/lane_math.h"
#include "patency/base/vec.h"

namespace patency {

/// J F^-T, the matrix of cofactors: defined for any F, and F^-T is it over J.
template <class T>
Mat<T> cofactor(const Mat<T>& F) {
    return {cross(F.y, F.z), cross(F.z, F.x), cross(F.x, F.y)};
}
/// a - tr(a)/3 1
template <class T>
Mat<T> deviator(const Mat<T>& a) {
    return a - (number<T>(1.0 / 3) * trace(a)) * identity<T>();
}

/// An upper bound of the largest squared stretch of F, which it meets at F = 1 and comes near to where one stretch stands
/// out: 1 + |C - 1|. Of F^-1: how much a fibre has been shortened.
inline double stretch_bound(const Mat3& F) {
    const Mat3 E = transpose(F) * F - identity<double>();
    return 1 + std::sqrt(double_dot(E, E));
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
