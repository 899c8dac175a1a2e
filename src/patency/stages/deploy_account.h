// SPDX-License-Identifier: Apache-2.0
// What a deployment by contact remembers of its past: kept in its checkpoints, put back from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "patency/bodies/contact.h"

namespace patency {

/// The struts' own pressure: rises until the stent is as wide as wanted, then falls to nothing. Times of the program [s].
struct RadialLoad {
    double from = 0, ramp = 1, most = 0;
    double stopped = INFINITY, reached = 0;   ///< when, and at what pressure [Pa]

    bool is_stopped() const { return stopped < INFINITY; }
    double pressure(double time) const {
        if (time <= from) return 0;
        if (time < stopped) return most * std::min(1.0, (time - from) / ramp);
        return reached * std::max(0.0, 1 - (time - stopped) / (0.2 * ramp));
    }
    std::vector<double*> numbers() { return {&stopped, &reached}; }
};

/// What is known after the phase in which it is measured.
struct DeployMarks {
    double crimped_length = 0, crimped_diameter = 0;   ///< before it opens [m]
    double opened_diameter = 0, opened_length = 0;     ///< before it is let go [m]
    double touched = 0;                                ///< when stent and wall first met while it opens [s]
    double stent_ratio = 0,
           wall_ratio = 0;         ///< the largest kinetic over internal while it opens, after the first tenth
    double balloon_pressure = 0;   ///< the largest [Pa]
    double deepest = 0;            ///< of stent in wall [m]

    std::vector<double*> numbers() {
        return {&crimped_length, &crimped_diameter, &opened_diameter,  &opened_length, &touched,
                &stent_ratio,    &wall_ratio,       &balloon_pressure, &deepest};
    }
};

/// What tools gave and contacts took [J].
struct ContactAccount {
    double work = 0, stored = 0, friction = 0, damping = 0;

    void add(const ContactReport& r) {
        work += r.work, stored += r.energy, friction += r.friction_loss, damping += r.damping_loss;
    }
    std::vector<double*> numbers() { return {&work, &stored, &friction, &damping}; }
};

}   // namespace patency
