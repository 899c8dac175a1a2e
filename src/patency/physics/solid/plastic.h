// SPDX-License-Identifier: Apache-2.0
// Metal that yields: von Mises' criterion at finite strain, isotropic hardening, the elastic part in logarithmic strain.
// No kinematic hardening, no rate, no temperature.                                        THEORY (19.10) to (19.14)
#pragma once

#include <cmath>

#include "patency/base/symmetric_eigen.h"
#include "patency/physics/solid/elastic_moduli.h"
#include "patency/physics/solid/strain.h"

namespace patency {

/// Yield stress over equivalent plastic strain a >= 0: y0 + H a + (y_inf - y0) (1 - exp(-d a)).     THEORY (19.11)
/// Linear hardening: y_inf = y0; Voce: H = 0 or what remains of it at large strain.
struct Hardening {
    double yield = 0;        ///< y0 [Pa]
    double slope = 0;        ///< H [Pa]
    double saturation = 0;   ///< y_inf [Pa]; below y0: none
    double rate = 0;         ///< d [1]

    double rise() const { return saturation > yield ? saturation - yield : 0.0; }
    double stress(double a) const {
        const double linear = yield + slope * a, more = rise();
        return more > 0 ? linear - more * std::expm1(-rate * a) : linear;
    }
    double tangent(double a) const {
        const double more = rise();
        return more > 0 ? slope + more * rate * std::exp(-rate * a) : slope;
    }
    /// Plastic work per volume on the way to a [J/m^3]: the integral of the yield stress.
    double work(double a) const {
        const double saturating = rate > 0 ? rise() * (a + std::expm1(-rate * a) / rate) : 0.0;
        return a * (yield + 0.5 * slope * a) + saturating;
    }
};

/// What a metal remembers: the inverse of the plastic right Cauchy-Green tensor, the same in every rotated frame, and
/// the equivalent plastic strain.
struct PlasticState {
    Mat3 inverse_plastic = identity<double>();   ///< C_p^-1
    double strain = 0;                           ///< a
};

struct PlasticStress {
    Mat3 kirchhoff;       ///< tau [Pa]
    PlasticState state;   ///< after the step
};

struct J2Plastic {
    ElasticModuli elastic;
    Hardening hardening;

    ElasticModuli moduli() const { return elastic; }
    /// Bounds rho_0 c^2 of the fastest wave in the reference configuration [Pa], for the time step.
    double wave_modulus(const Mat3& F) const { return elastic.p_wave() * stretch_bound(inverse(F)); }

    /// The stress at F, having been at `before`: b_e = F C_p^-1 F^T, log strain e = ln(b_e)/2, radial return to the
    /// yield surface in e. Exact for proportional loading however large the step.                THEORY (19.12), (19.13)
    PlasticStress stress(const Mat3& F, const PlasticState& before) const {
        const SymmetricEigen b = symmetric_eigen(F * before.inverse_plastic * transpose(F));
        const Vec3 e = 0.5 * Vec3{std::log(b.values.x), std::log(b.values.y), std::log(b.values.z)};
        const double volume = e.x + e.y + e.z, pressure = elastic.bulk * volume;
        const Vec3 distortion = e - (volume / 3) * Vec3{1, 1, 1};
        const double trial = 2 * elastic.shear * std::sqrt(1.5 * dot(distortion, distortion));
        PlasticStress result{{}, before};
        Vec3 kept = distortion;   // elastic
        if (trial > hardening.stress(before.strain)) {
            const double increment = plastic_increment(trial, before.strain);
            kept = ((trial - 3 * elastic.shear * increment) / trial) * distortion;
            const Vec3 now = kept + (volume / 3) * Vec3{1, 1, 1};
            const Mat3 b_e = from_eigen({std::exp(2 * now.x), std::exp(2 * now.y), std::exp(2 * now.z)}, b.vectors);
            const Mat3 G = inverse(F);
            result.state = {G * b_e * transpose(G), before.strain + increment};
        }
        result.kirchhoff = from_eigen(pressure * Vec3{1, 1, 1} + 2 * elastic.shear * kept, b.vectors);
        return result;
    }

    /// Elastic energy per reference volume [J/m^3]: K/2 (tr e)^2 + G dev e : dev e.                  THEORY (19.10)
    double energy(const Mat3& F, const PlasticState& state) const {
        const SymmetricEigen b = symmetric_eigen(F * state.inverse_plastic * transpose(F));
        const Vec3 e = 0.5 * Vec3{std::log(b.values.x), std::log(b.values.y), std::log(b.values.z)};
        const double volume = e.x + e.y + e.z;
        const Vec3 distortion = e - (volume / 3) * Vec3{1, 1, 1};
        return 0.5 * elastic.bulk * volume * volume + elastic.shear * dot(distortion, distortion);
    }
    Mat3 kirchhoff(const Mat3& F) const { return stress(F, {}).kirchhoff; }

    /// Secant over elastic shear modulus after monotonic straining: 1 while elastic.                 THEORY (19.14)
    double secant_share(double strain) const {
        const double y = hardening.stress(strain);
        return y / (y + 3 * elastic.shear * strain);
    }

    /// x > 0 with trial - 3 G x = yield stress at (a + x). The difference falls with x and is convex, so Newton from the
    /// left never steps too far.
    double plastic_increment(double trial, double a) const {
        double x = 0;
        for (int k = 0; k < 50; ++k) {
            const double gap = trial - 3 * elastic.shear * x - hardening.stress(a + x);
            const double step = gap / (3 * elastic.shear + hardening.tangent(a + x));
            x += step;
            if (std::abs(step) <= 1e-15 * (x + a)) break;
        }
        return x;
    }
};

}   // namespace patency
