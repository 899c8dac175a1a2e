// SPDX-License-Identifier: Apache-2.0
// Exact solutions that the program is measured against: channel, pipe, vortices, a Y of tubes. Steady and unsteady,
// in SI units. They know no particles and no results; THEORY section 12.
#pragma once

#include <complex>
#include <vector>

#include "patency/base/vec.h"
#include "patency/physics/fluid/rheology.h"
#include "patency/physics/open_ends/outlets.h"
#include "patency/physics/open_ends/profile.h"

namespace patency {

/// Two plates at y = 0 and y = gap.
struct PlaneFlow {
    double gap;                 // d, m
    double pressure_gradient;   // -dp/dx = Delta P / L, Pa/m
    double density;             // kg/m3
    double viscosity;           // Pa s
};

/// Steady velocity [m/s] at height y [m] in 0..gap. THEORY (12.1); its mean is 2/3 of the peak.
double plane_poiseuille_velocity(const PlaneFlow& flow, double y);
double plane_poiseuille_peak(const PlaneFlow& flow);
/// Velocity [m/s] at height y a time [s] >= 0 after the start from rest. THEORY (12.2), the series subtracted.
double plane_startup_velocity(const PlaneFlow& flow, double y, double time);

/// Shear rate [1/s] at which a law's stress mu(g) g [Pa], which must grow with g, is `stress` >= 0; to round-off.
double shear_rate_at(const Rheology& law, double stress);
/// Steady velocity [m/s] between the plates, and flow per depth [m2/s], of a liquid of any law in the place of the
/// viscosity: u = int g ds from s = |y - d/2| to d/2 with mu(g) g = G s. THEORY (12.12)
double thinning_plane_velocity(const PlaneFlow& flow, const Rheology& law, double y);
double thinning_plane_flow(const PlaneFlow& flow, const Rheology& law);

/// Channel started as a plug (Fukuchi's problem), all without units: y in half heights, -1..1; time nu t / h^2 > 0;
/// velocity over the plug's. Driven so that the mean ends as 1. THEORY (12.3).
double plug_start_velocity(double y, double time);
/// Mean of the above over the gap: 1 at the start, 0.87 at the lowest, 1 in the end.
double plug_start_mean(double time);
/// The time at which the velocity on the mid-plane reaches `peak`, 1 < peak < 1.5; to 1e-12 of itself.
double plug_start_time(double peak);

/// A straight tube.
struct PipeFlow {
    double radius;              // R, m
    double pressure_gradient;   // -dp/dx, Pa/m; the amplitude G if it oscillates
};

/// Hagen-Poiseuille, THEORY (12.4): velocity [m/s] at distance r [m] <= radius from the axis, flow [m3/s], and the
/// pressure gradient [Pa/m] and wall shear stress [Pa] of a given flow.
double pipe_velocity(const PipeFlow& pipe, double viscosity, double r);
double pipe_flow(const PipeFlow& pipe, double viscosity);
double pipe_pressure_gradient(double radius, double viscosity, double flow);
double pipe_wall_shear_stress(double radius, double viscosity, double flow);

/// Amplitudes of the flow that -dp/dx = Re(G e^(i w t)) drives, THEORY (12.5) and (12.6): multiply by e^(i w t) and take
/// the real part. Lags are minus their arguments. w in rad/s, > 0.
struct Oscillation {
    double angular_frequency, density, viscosity;
};
std::complex<double> womersley_pipe_velocity(const PipeFlow& pipe, const Oscillation& o, double r);   // m/s
std::complex<double> womersley_pipe_flow(const PipeFlow& pipe, const Oscillation& o);                 // m3/s
std::complex<double> womersley_pipe_wall_shear_stress(const PipeFlow& pipe, const Oscillation& o);    // Pa

/// Power law mu = K g^(n-1), unclamped, in a tube:
///   u = n/(n+1) (G / 2K)^(1/n) [R^((n+1)/n) - r^((n+1)/n)],   Q = pi n/(3n+1) (G / 2K)^(1/n) R^((3n+1)/n).
double power_law_pipe_velocity(const PipeFlow& pipe, const PowerLaw& law, double r);
double power_law_pipe_flow(const PipeFlow& pipe, const PowerLaw& law);
/// The gradient -dp/dx [Pa/m] that drives a flow [m3/s]; the wall shear stress is half of it times the radius.
double power_law_pipe_pressure_gradient(double radius, const PowerLaw& law, double flow);

/// Casson's law without regularisation in a tube. Where the stress G r / 2 stays below the yield stress, r < r_c, moves
/// a plug; outside it
///   u = G / (4 mu_c) [R^2 - r^2 - 8/3 sqrt(r_c) (R^1.5 - r^1.5) + 2 r_c (R - r)],   r_c = 2 tau_y / G,
///   Q = pi R^4 G / (8 mu_c) [1 - 16/7 sqrt(b) + 4/3 b - b^4/21],   b = r_c / R  (0 if b >= 1: no flow).
double casson_pipe_velocity(const PipeFlow& pipe, const Casson& law, double r);
double casson_pipe_flow(const PipeFlow& pipe, const Casson& law);

/// Taylor-Green vortices in a periodic square, THEORY (12.7).
struct TaylorGreen {
    double length;      // L, m
    double speed;       // U, m/s
    double density;     // kg/m3
    double viscosity;   // Pa s

    double wave_number() const;         // k = 2 pi / L, 1/m
    double energy_decay_rate() const;   // 4 nu k^2, 1/s
    Vec3 velocity(const Vec3& place, double time) const;
    double pressure(const Vec3& place, double time) const;   // with zero mean
};

/// One inlet tube that splits into branches, each ending in an RCR. Long rigid tubes: no losses at the junction.
struct YNetwork {
    struct Tube {
        double radius, length;   // m (planar: half gap)
    };
    struct Branch {
        Tube tube;
        Rcr outlet;
    };
    Section section = Section::circular;
    double density, viscosity;
    Tube inlet;
    std::vector<Branch> branches;
};

/// What flows in it, periodic; pressures in Pa, flows in m3/s towards the outlets.
struct YNetworkFlow {
    FourierSeries inlet_pressure, junction_pressure;
    std::vector<FourierSeries> flows, outlet_pressures;   // one per branch
};

/// Impedance of a long rigid tube [Pa s/m3] at w >= 0 rad/s: length / (area a^2 / mu mobility), the exact counterpart of
/// THEORY (12.9), which it meets at w = 0.
std::complex<double> tube_impedance(Section section, const YNetwork::Tube& tube, double density, double viscosity,
                                    double angular_frequency);

/// The periodic state for a periodic inflow [m3/s], mode by mode; when the start is forgotten.
YNetworkFlow solve_y_network(const YNetwork& network, const FourierSeries& inflow);

}   // namespace patency
