// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/bessel.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace patency {

std::complex<double> scaled_bessel_i(int n, std::complex<double> z) {
    using Complex = std::complex<double>;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    if (std::abs(z) < 30) {
        // I_n(z) = (z/2)^n sum_k (z^2/4)^k / (k! (k+n)!). On |arg z| = pi/4 the largest term exceeds the sum by
        // e^(0.29 |z|): 6000 at the switch.
        const Complex w = z * z / 4.0;
        Complex term = n == 0 ? Complex{1} : z / 2.0, sum = term;
        for (int k = 1; std::abs(term) > epsilon * 1e-3 * std::abs(sum); ++k)
            sum += term *= w / (double(k) * double(k + n));
        return sum * std::exp(-z);
    }
    // I_n(z) = e^z / sqrt(2 pi z) sum_k (-1)^k a_k / z^k, a_k = (4n^2 - 1)(4n^2 - 9)..(4n^2 - (2k-1)^2) / (k! 8^k).
    // The neglected e^(-z) part is below e^(-42) there; the terms fall to e^(-2|z|) before they grow.
    const double mu = 4.0 * n * n;
    Complex term{1}, sum{1};
    for (int k = 1; k < 50 && std::abs(term) > epsilon; ++k) {
        const double odd = 2.0 * k - 1;
        sum += term *= -(mu - odd * odd) / (8.0 * k * z);
    }
    return sum / std::sqrt(2 * std::numbers::pi * z);
}

}   // namespace patency
