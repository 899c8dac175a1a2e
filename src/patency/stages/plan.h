// SPDX-License-Identifier: Apache-2.0
// What a flow will cost, said before it runs.
#pragma once

#include "patency/stages/scene.h"

namespace patency {

struct FlowPlan {
    double reynolds;              ///< of the mean speed through the narrowest width
    double speed;                 ///< the largest expected [m/s]
    double sound_speed;           ///< [m/s]
    double advection_step;        ///< [s]
    double acoustic_step;         ///< [s]
    double acoustic_steps;        ///< over the duration
    double fluid_particles, wall_particles;   ///< buffers and walls beyond the openings included
    double across_narrowest;      ///< particles
    double memory;                ///< bytes
    double seconds;               ///< expected on `threads` threads
    int threads;
};

/// Of a scene without particles (build_frame).
FlowPlan plan_flow(const Scene& scene, int threads);

}  // namespace patency
