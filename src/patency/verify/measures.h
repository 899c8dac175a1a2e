// SPDX-License-Identifier: Apache-2.0
// How far a computed field or signal is from the exact one. Plain numbers in, one number out; THEORY section 13.
// Lists that belong together have equal, non-zero length.
#pragma once

#include <array>
#include <complex>
#include <span>

namespace patency {

/// 100 sqrt(mean of ((computed - exact) / exact)^2) [%], THEORY (13.1). No exact value may vanish: leave out points on
/// the wall.
double rmsep_percent(std::span<const double> computed, std::span<const double> exact);

/// 100 sqrt(mean of (computed - exact)^2) / scale [%], THEORY (13.2); the scale is the largest exact value, or any other.
double l2_percent(std::span<const double> computed, std::span<const double> exact, double scale);

/// log(error_1 / error_2) / log(spacing_1 / spacing_2), THEORY (13.3).
double observed_order(double error_1, double spacing_1, double error_2, double spacing_2);

/// Spacings from coarse to fine, and what was found with them. THEORY (13.11), of second order.
struct SpacingStudy {
    std::array<double, 3> spacings, values;

    double extrapolated() const;   ///< Richardson's value at no spacing, from the two finest
    /// Roache's grid convergence index, percent of the finest value: a quarter more than its distance from the extrapolated one,
    /// by the two finest or by the two coarsest, whichever is more.
    double convergence_index_percent() const;
};

/// Complex amplitude a of a signal, f = mean + Re(a e^(i w t)) + other modes, THEORY (13.4): from samples at increasing
/// times [s], spaced evenly or not, that cover a whole number of periods from the first to the last. w in rad/s.
std::complex<double> amplitude(std::span<const double> times, std::span<const double> values, double angular_frequency);

/// Rate of decay [1/s] of a positive signal by a straight line through its logarithm, THEORY (13.5).
double decay_rate(std::span<const double> times, std::span<const double> values);

}   // namespace patency
