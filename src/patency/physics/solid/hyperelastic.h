// SPDX-License-Identifier: Apache-2.0
// Elastic solids at large strain: each law is an energy per reference volume, the first Piola-Kirchhoff stress that the
// loops use, and the same stress by the material (S of C) and the spatial route (tau of F), which tests compare.
// No damage, no viscosity, no state. wave_modulus bounds rho_0 c^2 of the fastest wave in the reference configuration,
// for the time step: exact at F = 1, where it is the P-wave modulus.                          THEORY (19.4) to (19.9)
#pragma once

#include <algorithm>
#include <cmath>

#include "patency/physics/solid/elastic_moduli.h"
#include "patency/physics/solid/strain.h"

namespace patency {

/// Volumetric energy U = K/4 (J^2 - 1 - 2 ln J), which keeps J from 0; J U' needs no logarithm.       THEORY (19.4)
inline double volumetric_energy(double bulk, double J) { return 0.25 * bulk * (J * J - 1 - 2 * std::log(J)); }
template <class T>
T volumetric_kirchhoff(double bulk, const T& J) {
    return number<T>(0.5 * bulk) * (J * J - T(1));
}

/// W = G/2 (I1 - 3 - 2 ln J) + lambda/4 (J^2 - 1 - 2 ln J).                                          THEORY (19.5)
struct NeoHookean {
    double shear, lame;   ///< G, lambda [Pa]

    static NeoHookean from(const ElasticModuli& m) { return {m.shear, m.lame()}; }
    ElasticModuli moduli() const { return {shear, lame + 2 * shear / 3}; }

    double energy(const Mat3& F) const {
        const double J = determinant(F);
        return 0.5 * shear * (double_dot(F, F) - 3 - 2 * std::log(J)) + volumetric_energy(lame, J);
    }
    template <class T>
    Mat<T> pk1(const Mat<T>& F) const {
        const Mat<T> c = cofactor(F);
        const T J = dot(F.x, c.x), G = number<T>(shear);
        return G * F + ((volumetric_kirchhoff(lame, J) - G) / J) * c;
    }
    Mat3 pk2(const Mat3& C) const {
        const double J2 = determinant(C);
        return shear * (identity<double>() - inverse(C)) + 0.5 * lame * (J2 - 1) * inverse(C);
    }
    double wave_modulus(const Mat3& F) const {
        const double J = determinant(F);
        return shear + stretch_bound(inverse(F)) * (shear + 0.5 * lame * (J * J + 1));
    }
    Mat3 kirchhoff(const Mat3& F) const {
        const Mat3 b = F * transpose(F), one = identity<double>();
        return shear * (b - one) + volumetric_kirchhoff(lame, determinant(F)) * one;
    }
};

/// Hooke's law between S and Green's strain: for large rotations, not for large compression, where it softens.
/// W = lambda/2 (tr E)^2 + G E : E, E = (C - 1)/2.                                                   THEORY (19.6)
struct StVenantKirchhoff {
    double shear, lame;   ///< G, lambda [Pa]

    static StVenantKirchhoff from(const ElasticModuli& m) { return {m.shear, m.lame()}; }
    ElasticModuli moduli() const { return {shear, lame + 2 * shear / 3}; }

    double energy(const Mat3& F) const {
        const Mat3 E = 0.5 * (transpose(F) * F - identity<double>());
        return 0.5 * lame * trace(E) * trace(E) + shear * double_dot(E, E);
    }
    template <class T>
    Mat<T> pk1(const Mat<T>& F) const {
        const Mat<T> E = number<T>(0.5) * (transpose(F) * F - identity<T>());
        return F * (number<T>(2 * shear) * E + (number<T>(lame) * trace(E)) * identity<T>());
    }
    Mat3 pk2(const Mat3& C) const {
        return shear * (C - identity<double>()) + 0.5 * lame * (trace(C) - 3) * identity<double>();
    }
    double wave_modulus(const Mat3& F) const {
        const Mat3 S = pk2(transpose(F) * F);
        return moduli().p_wave() * stretch_bound(F) + std::sqrt(double_dot(S, S));
    }
    Mat3 kirchhoff(const Mat3& F) const {
        const Mat3 b = F * transpose(F);
        return shear * (b * b - b) + 0.5 * lame * (trace(b) - 3) * b;
    }
};

/// The distorting part of an energy in I1 and I2 of C J^(-2/3), as a Kirchhoff stress: w1, w2 its derivatives.
///                                                                                                 THEORY (19.7)
template <class T>
Mat<T> isochoric_kirchhoff(const Mat<T>& b_bar, const T& w1, const T& w2) {
    return number<T>(2) * deviator((w1 + trace(b_bar) * w2) * b_bar - w2 * (b_bar * b_bar));
}
/// The same by the material route: S = 2 J^(-2/3) [w1 Dev(1) + w2 Dev(I1 1 - C_bar)], Dev(A) = A - (A : C)/3 C^-1.
inline Mat3 isochoric_pk2(const Mat3& C, double w1, double w2) {
    const double scale = std::pow(determinant(C), -1.0 / 3);
    const Mat3 C_bar = scale * C, one = identity<double>();
    const Mat3 a = 2 * scale * ((w1 + trace(C_bar) * w2) * one - w2 * C_bar);
    return a - (double_dot(a, C) / 3) * inverse(C);
}

/// J^(-2/3) F F^T
template <class T>
Mat<T> isochoric_left(const Mat<T>& F, const T& J) {
    const T c = cbrt(J);
    return (T(1) / (c * c)) * (F * transpose(F));
}

/// Of the laws in isochoric invariants; shear: what 2 (w1 + w2) has become [Pa].
inline double isochoric_wave_modulus(const Mat3& F, double shear, double bulk) {
    const double J = determinant(F), f = stretch_bound(inverse(F));
    return 4.0 / 3 * shear * std::max(stretch_bound(F), f) + 0.5 * bulk * (J * J + 1) * f;
}

/// W = c10 (I1 - 3) + c01 (I2 - 3) + U(J) of the isochoric invariants; G = 2 (c10 + c01).            THEORY (19.7)
struct MooneyRivlin {
    double c10, c01, bulk;   ///< Pa

    ElasticModuli moduli() const { return {2 * (c10 + c01), bulk}; }
    double wave_modulus(const Mat3& F) const { return isochoric_wave_modulus(F, 2 * (c10 + c01), bulk); }

    double energy(const Mat3& F) const {
        const double J = determinant(F);
        const Mat3 b = isochoric_left(F, J);
        const double i1 = trace(b), i2 = 0.5 * (i1 * i1 - double_dot(b, b));
        return c10 * (i1 - 3) + c01 * (i2 - 3) + volumetric_energy(bulk, J);
    }
    template <class T>
    Mat<T> pk1(const Mat<T>& F) const {
        const Mat<T> c = cofactor(F);
        const T J = dot(F.x, c.x);
        const Mat<T> tau = isochoric_kirchhoff(isochoric_left(F, J), number<T>(c10), number<T>(c01)) +
                           volumetric_kirchhoff(bulk, J) * identity<T>();
        return (T(1) / J) * (tau * c);
    }
    Mat3 pk2(const Mat3& C) const {
        return isochoric_pk2(C, c10, c01) + 0.5 * bulk * (determinant(C) - 1) * inverse(C);
    }
    Mat3 kirchhoff(const Mat3& F) const {
        const double J = determinant(F);
        return isochoric_kirchhoff(isochoric_left(F, J), c10, c01) + volumetric_kirchhoff(bulk, J) * identity<double>();
    }
};

/// W = sum_k c_k (I1 - 3)^k + U(J), k = 1..3, of the isochoric invariant; G = 2 c1.                  THEORY (19.8)
struct Yeoh {
    double c1, c2, c3, bulk;   ///< Pa

    ElasticModuli moduli() const { return {2 * c1, bulk}; }
    double wave_modulus(const Mat3& F) const {
        const Mat3 b = isochoric_left(F, determinant(F)), away = deviator(b);
        const double i1 = trace(b),
                     bend = std::max(2 * c2 + 6 * c3 * (i1 - 3), 0.0);   // W'' in I1, |dI1/dF| = |2 dev b F^-T|
        return isochoric_wave_modulus(F, 2 * std::max(slope(i1), c1), bulk) +
               4 * bend * double_dot(away, away) * stretch_bound(inverse(F));
    }

    double energy(const Mat3& F) const {
        const double J = determinant(F), x = trace(isochoric_left(F, J)) - 3;
        return x * (c1 + x * (c2 + x * c3)) + volumetric_energy(bulk, J);
    }
    template <class T>
    T slope(const T& i1) const {   // dW/dI1
        const T x = i1 - T(3);
        return number<T>(c1) + x * (number<T>(2 * c2) + x * number<T>(3 * c3));
    }
    template <class T>
    Mat<T> pk1(const Mat<T>& F) const {
        const Mat<T> c = cofactor(F);
        const T J = dot(F.x, c.x);
        const Mat<T> b = isochoric_left(F, J);
        const Mat<T> tau =
            isochoric_kirchhoff(b, slope(trace(b)), T(0)) + volumetric_kirchhoff(bulk, J) * identity<T>();
        return (T(1) / J) * (tau * c);
    }
    Mat3 pk2(const Mat3& C) const {
        const double J2 = determinant(C), i1 = trace(C) * std::pow(J2, -1.0 / 3);
        return isochoric_pk2(C, slope(i1), 0) + 0.5 * bulk * (J2 - 1) * inverse(C);
    }
    Mat3 kirchhoff(const Mat3& F) const {
        const double J = determinant(F);
        const Mat3 b = isochoric_left(F, J);
        return isochoric_kirchhoff(b, slope(trace(b)), 0.0) + volumetric_kirchhoff(bulk, J) * identity<double>();
    }
};

}   // namespace patency
