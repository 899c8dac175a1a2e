// SPDX-License-Identifier: Apache-2.0
// The flow stage: moves a scene's blood on in time. What is to be recorded is the observer's business.
#pragma once

#include <functional>
#include <vector>

#include "patency/stages/scene.h"

namespace patency {

/// Makes the scheme over the particles that the scene has and ties the openings' laws to it.
void start_scheme(Scene& scene);

struct FlowRun {
    double until = 0;   ///< [s]
    /// Called after every advection step.
    std::function<void(const Scene&, const FlowStep&)> observe = {};
    /// Asked after every advection step; true ends the run there.
    std::function<bool()> interrupted = {};
    /// Times that a step must end at, rising [s]; those that have passed are skipped.
    std::vector<double> exact_times = {};
};

/// Steps until scene.time is exactly `until`. Throws DivergedError: what, where, when.
void advance(Scene& scene, const FlowRun& run);

}   // namespace patency
