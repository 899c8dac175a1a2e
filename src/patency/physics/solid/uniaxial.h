// SPDX-License-Identifier: Apache-2.0
// A material point in a testing machine: pulled along x, free to contract across.
#pragma once

#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/vec.h"

namespace patency {

struct UniaxialPoint {
    double lateral = 1;   ///< stretch across
    double stress = 0;    ///< Kirchhoff, along [Pa]
};

/// The lateral stretch at which tau_yy vanishes, for an axial stretch; kirchhoff: Mat3 -> Mat3 of a law that is isotropic
/// about x. By the secant method from `guess`; modulus [Pa] scales what counts as zero.
/// @throws DivergedError if it does not find one.
template <class Kirchhoff>
UniaxialPoint pull_uniaxially(const Kirchhoff& kirchhoff, double axial, double guess, double modulus) {
    const auto at = [&](double lateral) { return kirchhoff(Mat3{{axial, 0, 0}, {0, lateral, 0}, {0, 0, lateral}}); };
    double a = guess, b = guess * (1 + 1e-7), fa = at(a).y.y, fb = at(b).y.y;
    for (int k = 0; k < 100; ++k) {
        if (std::abs(fb) <= 1e-15 * modulus || fb == fa) return {b, at(b).x.x};
        const double next = b - fb * (b - a) / (fb - fa);
        a = b, fa = fb, b = next, fb = at(b).y.y;
        if (!(std::abs(b - a) > 1e-15 * std::abs(b))) return {b, at(b).x.x};
    }
    throw DivergedError("the lateral stretch of a material point under tension was not found");
}

}   // namespace patency
