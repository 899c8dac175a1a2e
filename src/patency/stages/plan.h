// SPDX-License-Identifier: Apache-2.0
// What a flow will cost, said before it runs.
#pragma once

#include "patency/stages/scene.h"

namespace patency {

struct FlowPlan {
    double reynolds;                          ///< of the mean speed through the narrowest width
    double speed;                             ///< the largest expected [m/s]
    double sound_speed;                       ///< [m/s]
    double advection_step;                    ///< [s]
    double acoustic_step;                     ///< [s]
    double acoustic_steps;                    ///< until the probable end
    double fluid_particles, wall_particles;   ///< buffers and walls beyond the openings included
    double across_narrowest;                  ///< particles
    double memory;                            ///< bytes
    double seconds;                           ///< expected on `threads` threads, until then
    double longest_seconds;                   ///< over the whole duration
    int threads;
};

/// Of a scene without particles (build_frame), at its spacing or at another one [m].
FlowPlan plan_flow(const Scene& scene, int threads);
FlowPlan plan_flow(const Scene& scene, int threads, double spacing);

/// What a flow may cost.
struct Budget {
    double seconds;   ///< of computing at the longest, on `threads` threads
    double memory;    ///< bytes
    int threads;
};

/// The largest of the spacings that people write, 1.00, 1.05 to 9.95 times a power of ten, which is not above this one [m].
double round_spacing(double spacing);

/// The finest of these spacings that the budget pays for, and all coarser ones up to `coarsest` with it; `coarsest` rounded
/// if it pays for none. More budget never gives a coarser one.
double finest_spacing(const Scene& scene, const Budget& budget, double coarsest);

}   // namespace patency
