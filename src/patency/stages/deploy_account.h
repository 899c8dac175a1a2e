// SPDX-License-Identifier: Apache-2.0
// What a deployment by contact remembers of its past: kept in its checkpoints, put back from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "patency/bodies/contact.h"

namespace patency {

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
