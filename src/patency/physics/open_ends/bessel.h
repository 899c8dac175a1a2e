// SPDX-License-Identifier: Apache-2.0
// Modified Bessel functions of the first kind of complex argument, as oscillating flow in a tube needs them.
// Only orders 0 and 1, and only the sector named below.
#pragma once

#include <complex>

namespace patency {

/// e^(-z) I_n(z) for n = 0 or 1 and |arg z| <= pi/4; scaled so that it never overflows. Relative error below 1e-12
/// (measured against the integral that defines it; power series to |z| = 30, Hankel's expansion beyond: Abramowitz and
/// Stegun 9.6.10 and 9.7.1). I_n(z) = i^(-n) J_n(i z).
std::complex<double> scaled_bessel_i(int n, std::complex<double> z);

}   // namespace patency
