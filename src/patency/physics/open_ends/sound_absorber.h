// SPDX-License-Identifier: Apache-2.0
// An end that imposes a flow throws sound back whole. A flow that is steady in the end may breathe meanwhile: what the pressure
// departs from its own slow mean, times A / (rho c), is let out, which is what an endless vessel would do. THEORY.md (8.12)
#pragma once

#include <cmath>

namespace patency {

struct SoundAbsorber {
    double admittance = 0;   ///< A / (rho c) of the section [m^3/(Pa s)]; 0: everything comes back
    double memory = 0;       ///< of the slow mean: a few times what sound needs through the vessel [s]
    double delay = 0;        ///< of the answer: a few times what it needs from the end to where the pressure is heard [s]

    double mean = 0;         ///< slow mean of the pressure; at the start the pressure that is thought steady [Pa]
    double flow = 0;         ///< let out [m^3/s]

    /// The pressure [Pa] has been this for dt [s]. Both lags are exact for it.
    void hear(double pressure, double dt) {
        mean += -std::expm1(-dt / memory) * (pressure - mean);
        flow += -std::expm1(-dt / delay) * (admittance * (pressure - mean) - flow);
    }
};

}  // namespace patency
