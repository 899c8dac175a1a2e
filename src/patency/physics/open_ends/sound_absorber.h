// SPDX-License-Identifier: Apache-2.0
// Ends throw sound back: whole, with an imposed flow, and whole but turned over, with an imposed pressure. In a flow that is steady
// in the end they may breathe meanwhile: what departs from its own slow mean is answered with the impedance rho c / A of an endless
// vessel. THEORY.md (8.12), (8.13)
#pragma once

#include <cmath>

namespace patency {

struct SoundAbsorber {
    double impedance = 0;   ///< rho c / A of the section [Pa s/m^3]; 0: everything comes back
    double memory = 0;      ///< of the slow mean [s]
    double delay =
        0;   ///< of the answer of an end with an imposed flow: what sound needs to where its pressure is heard, and more [s]

    double mean =
        0;   ///< slow mean of the pressure at an imposed flow [Pa], of the flow out at an imposed pressure [m^3/s]
    double let_out = 0;   ///< beside an imposed flow [m^3/s]

    bool is_there() const { return impedance > 0; }

    /// Of an imposed flow: the pressure [Pa] has been this for dt [s].
    void hear(double pressure, double dt) {
        follow(pressure, dt);
        let_out += -std::expm1(-dt / delay) * ((pressure - mean) / impedance - let_out);
    }
    /// The slow mean of a value that has been this for dt [s].
    void follow(double value, double dt) { mean += -std::expm1(-dt / memory) * (value - mean); }
};

}   // namespace patency
