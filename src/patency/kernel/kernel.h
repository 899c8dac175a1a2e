// SPDX-License-Identifier: Apache-2.0
// The Wendland C2 kernel, in the plane and in space. Support radius 2h.                        THEORY.md (1.1)
#pragma once

#include <numbers>

namespace patency {

/// With q = r/h and t = max(0, 1 - q/2):
///     W = sigma t^4 (1 + 2q) = sigma t^4 (5 - 4t),     dW/dr = -slope r t^3,     slope = 5 sigma / h^2,
/// so that the gradient of W is -slope t^3 (x_i - x_j): no division by r, regular at r = 0.
struct WendlandC2 {
    double h;      ///< smoothing length [m]
    bool planar;   ///< normalised in the plane [1/m^2] instead of in space [1/m^3]

    double support() const { return 2 * h; }
    double sigma() const {
        using std::numbers::pi;
        return planar ? 7 / (4 * pi * h * h) : 21 / (16 * pi * h * h * h);
    }
    double slope() const { return 5 * sigma() / (h * h); }
    double w(double r) const {
        const double t = r < 2 * h ? 1 - r / (2 * h) : 0.0;
        return sigma() * t * t * t * t * (5 - 4 * t);
    }
    double dw_dr(double r) const {
        const double t = r < 2 * h ? 1 - r / (2 * h) : 0.0;
        return -slope() * r * t * t * t;
    }
};

}   // namespace patency
