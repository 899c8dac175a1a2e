// SPDX-License-Identifier: Apache-2.0
// Velocity over the section of an opening: plug, parabola, or the oscillating flow of Womersley, over a circle or the
// gap between two plates, scaled so that its integral over the section is the flow. Knows no particles and no place:
// position is s, the distance from the axis over the radius (from the mid-plane over the half gap), 0..1.
#pragma once

#include <complex>
#include <vector>

#include "patency/physics/open_ends/waveform.h"

namespace patency {

enum class Section {
    circular,   ///< a disc of radius a; area pi a^2
    planar,     ///< a gap of half width a, per metre of depth; area 2 a
};

/// Area of the section [m2; planar: m2 per metre of depth], `radius` the radius or half gap [m].
double section_area(Section section, double radius);

/// Velocity over mean velocity. Zero outside the section (s > 1).
inline double plug_profile(double s) { return s <= 1 ? 1.0 : 0.0; }
/// Velocity over mean velocity: 2 (1 - s^2) in a circle, 1.5 (1 - s^2) in a gap, THEORY (8.3). Zero outside.
double parabola_profile(Section section, double s);

/// Womersley number a sqrt(w rho / mu), w in rad/s.
double womersley_number(double radius, double angular_frequency, double density, double viscosity);

/// One frequency of the flow of a Newtonian liquid driven by a pressure gradient -dp/dx = Re(G e^(i w t)) in a long
/// rigid tube or gap. With z = sqrt(i) alpha the velocity over its mean is
///   circular  [1 - I_0(z s) / I_0(z)] / [1 - 2 I_1(z) / (z I_0(z))]
///   planar    [1 - cosh(z s) / cosh(z)] / [1 - tanh(z) / z]
/// THEORY (12.5) with I_n(z) = i^(-n) J_n(i z). For alpha -> 0 all three functions go to those of the parabola without
/// loss of digits.
class WomersleyMode {
public:
    /// alpha >= 0.
    WomersleyMode(Section section, double alpha);

    /// Velocity over mean velocity at s; zero outside.
    std::complex<double> shape(double s) const;
    /// Wall shear stress over (mu mean velocity / a): -d shape/ds at s = 1; 4 (circular) or 3 (planar) for alpha -> 0.
    std::complex<double> wall_shear() const { return wall_shear_; }
    /// Mean velocity over (a^2 G / mu): 1/8 (circular) or 1/3 (planar) for alpha -> 0.
    std::complex<double> mobility() const { return mobility_; }

private:
    std::complex<double> from_series(double s) const;   // numerator of the shape

    Section section_;
    double alpha_;
    std::complex<double> z_;
    std::complex<double> mean_;    // mean of the numerator, with the normalisation of from_series or of 1 - I_0/I_0
    std::complex<double> scale_;   // e^(-z) I_0(z) or e^(-z) cosh(z)
    std::complex<double> wall_shear_, mobility_;
};

/// Velocity over a section at one instant, tabulated: a few nanoseconds for each of many particles.
class ProfileSnapshot {
public:
    static constexpr int intervals = 256;   // over s = 0..1

    /// Axial velocity [m/s] at s, by cubic interpolation; zero outside. Off by (alpha / intervals)^4 / 40 of the mode's
    /// velocity: 4e-6 at alpha = 30.
    double operator()(double s) const;

private:
    friend class WomersleyProfile;
    std::vector<double> velocities_;   // at s = k / intervals
};

/// Velocity over a section at any time, from the Fourier modes of the flow.
class WomersleyProfile {
public:
    /// flow: the flow through the section [m3/s; planar m2/s]; radius or half gap [m]; density [kg/m3]; dynamic
    /// viscosity [Pa s]. All positive.
    WomersleyProfile(Section section, double radius, double density, double viscosity, const FourierSeries& flow);

    /// Axial velocity [m/s] at distance s a from the axis.
    double velocity(double s, double time) const;
    /// All of it at one instant, for many places.
    ProfileSnapshot at(double time) const;
    /// Wall shear stress [Pa], positive when the liquid near the wall moves forward.
    double wall_shear_stress(double time) const;
    /// Pressure gradient -dp/dx [Pa/m].
    double pressure_gradient(double time) const;

private:
    Section section_;
    double radius_, viscosity_;
    FourierSeries mean_velocity_;
    std::vector<WomersleyMode> modes_;
    std::vector<std::complex<double>> shapes_;   // of every mode, at the places of a snapshot
};

/// The flow [m3/s; planar m2/s] that a periodic pressure gradient -dp/dx [Pa/m] drives; then WomersleyProfile applies.
FourierSeries make_womersley_flow(Section section, double radius, double density, double viscosity,
                                  const FourierSeries& pressure_gradient);

}   // namespace patency
