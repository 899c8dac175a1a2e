// SPDX-License-Identifier: Apache-2.0
// Exact answers for solids: beam, tubes, contact. SI units. They know no particles.        THEORY (22.1) to (22.8)
#pragma once

#include <vector>

#include "patency/physics/solid/hyperelastic.h"

namespace patency {

/// A plate in plane strain, clamped at one end.
struct Cantilever {
    double length, height;   // m
    double density;
    ElasticModuli moduli;
};
/// First angular frequency [rad/s] of Timoshenko's beam, and its deflection at x in 0..length over that of the tip.
///                                                                                             THEORY (22.1), (22.2)
double cantilever_frequency(const Cantilever& beam);
double cantilever_shape(const Cantilever& beam, double x);

/// A neo-Hookean tube in plane strain, radii A < B [m] at first.
struct RubberTube {
    double inner, outer;
    NeoHookean law;
};
/// The pressure [Pa] that holds the inner radius at a [m], by integration of the radial equilibrium.    THEORY (22.3)
double tube_pressure(const RubberTube& tube, double a);
/// The inner radius at a pressure below the largest.
double tube_radius(const RubberTube& tube, double pressure);

/// Lame's stresses [Pa] at r of a tube of small strain.                                                 THEORY (22.4)
struct TubeStress {
    double radial, hoop;
};
TubeStress lame_stress(double inner, double outer, double pressure, double r);

/// Elastic, perfectly plastic tubes in plane strain, incompressible: yield stress [Pa].        THEORY (22.5), (22.6)
double collapse_pressure(double inner, double outer, double yield);
/// How far it has yielded at a pressure between first yield and collapse [m].
double plastic_radius(double inner, double outer, double yield, double pressure);
/// Stress at r after that pressure is gone.
TubeStress residual_stress(double inner, double outer, double yield, double pressure, double r);

/// Two cylinders pressed together by a line load [N/m]; moduli in plane strain [Pa].                   THEORY (22.7)
struct HertzLine {
    double radius;    ///< 1 / (1/R1 + 1/R2) [m]
    double modulus;   ///< E* [Pa]

    double half_width(double load) const;      ///< [m]
    double peak_pressure(double load) const;   ///< [Pa]
};
double contact_modulus(const ElasticModuli& a, const ElasticModuli& b);   ///< E* [Pa]
/// Force [N] between two spheres whose centres have come nearer by `approach` [m].                     THEORY (22.8)
double hertz_force(double radius, double modulus, double approach);
/// How far a place on the axis, `depth` [m] below the middle of Hertz' pressure of a force [N] between spheres, goes into a half-space
/// of young [Pa] and poisson; at depth 0 it is that body's part of the approach.                      THEORY (22.10)
double hertz_sinking(double radius, double modulus, double force, double young, double poisson, double depth);

}   // namespace patency
