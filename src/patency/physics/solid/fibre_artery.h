// SPDX-License-Identifier: Apache-2.0
// The artery wall of Gasser, Ogden & Holzapfel (2006): a soft matrix and two families of collagen fibres, dispersed
// around their mean directions.
#pragma once

#include "patency/physics/solid/hyperelastic.h"

namespace patency {

/// Mean directions of the two families in the reference configuration; unit vectors.
template <class T>
struct Fibres {
    Vec<T> first, second;
};

/// W = c/2 (I1 - 3) + sum_f k1/(2 k2) [exp(k2 <E_f>^2) - 1] + U(J),
/// E_f = kappa (I1 - 3) + (1 - 3 kappa) (I_f - 1), I_f = a_f . C a_f.                                THEORY (19.9)
/// I1 is isochoric, I_f is not: with an isochoric I_f a fibre would resist a change of volume. <E> = max(E, 0): fibres
/// carry no pressure, and the stress is continuous where they begin to pull. kappa: 0 all along the mean direction, 1/3
/// isotropic.
struct FibreArtery {
    double shear;               ///< c: shear modulus of the matrix [Pa]
    double stiffness, growth;   ///< k1 [Pa], k2 [1] of the fibres, above zero
    double dispersion;          ///< kappa, 0 to 1/3
    double bulk;                ///< K [Pa]

    /// Of the matrix: what the tissue shows where the fibres do not pull.
    ElasticModuli moduli() const { return {shear, bulk}; }

    double energy(const Mat3& F, const Fibres<double>& fibres) const {
        const double J = determinant(F), i1 = trace(isochoric_left(F, J));
        double w = 0.5 * shear * (i1 - 3) + volumetric_energy(bulk, J);
        for (const Vec3& a : {fibres.first, fibres.second}) {
            const double E = fibre_strain(i1, F * a);
            w += stiffness / (2 * growth) * std::expm1(growth * E * E);
        }
        return w;
    }
    template <class T>
    Mat<T> pk1(const Mat<T>& F, const Fibres<T>& fibres) const {
        const Mat<T> c = cofactor(F);
        return (T(1) / dot(F.x, c.x)) * (kirchhoff(F, fibres) * c);
    }
    template <class T>
    Mat<T> kirchhoff(const Mat<T>& F, const Fibres<T>& fibres) const {
        const T J = determinant(F);
        const Mat<T> b = isochoric_left(F, J);
        const T i1 = trace(b);
        T w1 = number<T>(0.5 * shear);
        Mat<T> tau = volumetric_kirchhoff(bulk, J) * identity<T>();
        for (const Vec<T>& a : {fibres.first, fibres.second}) {
            const Vec<T> now = F * a;
            const T w = fibre_slope(fibre_strain(i1, now));
            w1 = w1 + number<T>(dispersion) * w;
            tau += (number<T>(2 * (1 - 3 * dispersion)) * w) * outer(now, now);
        }
        return tau + isochoric_kirchhoff(b, w1, T(0));
    }
    Mat3 pk2(const Mat3& C, const Fibres<double>& fibres) const {
        const double J2 = determinant(C), i1 = trace(C) * std::pow(J2, -1.0 / 3);
        double w1 = 0.5 * shear;
        Mat3 S = 0.5 * bulk * (J2 - 1) * inverse(C);
        for (const Vec3& a : {fibres.first, fibres.second}) {
            const double E = dispersion * (i1 - 3) + (1 - 3 * dispersion) * (dot(a, C * a) - 1),
                         w = fibre_slope(std::max(E, 0.0));
            w1 += dispersion * w;
            S += 2 * (1 - 3 * dispersion) * w * outer(a, a);
        }
        return S + isochoric_pk2(C, w1, 0);
    }

    double wave_modulus(const Mat3& F, const Fibres<double>& fibres) const {
        const double i1 = trace(isochoric_left(F, determinant(F)));
        double fibre = 0;
        for (const Vec3& a : {fibres.first, fibres.second}) {
            const Vec3 now = F * a;
            const double E = fibre_strain(i1, now), rise = std::exp(growth * E * E);
            fibre += stiffness * rise * (4 * dot(now, now) * (1 + 2 * growth * E * E) + 2 * E);
        }
        return isochoric_wave_modulus(F, shear, bulk) + fibre;
    }

    /// dW/dE of one family [Pa].
    template <class T>
    T fibre_slope(const T& E) const {
        return number<T>(stiffness) * E * exp(number<T>(growth) * E * E);
    }

private:
    template <class T>
    T fibre_strain(const T& i1, const Vec<T>& now) const {
        return max(number<T>(dispersion) * (i1 - T(3)) + number<T>(1 - 3 * dispersion) * (dot(now, now) - T(1)), T(0));
    }
};

}   // namespace patency
