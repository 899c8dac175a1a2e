// SPDX-License-Identifier: Apache-2.0
// Velocity over the section of a long straight vessel that carries a flow which changes in time: what has come a long way
// when it enters. In steady flow it is the parabola, of an oscillation Womersley's profile. Knows no particles and no place:
// s is the distance from the axis over the radius.                                                  THEORY (18.17)
#pragma once

#include <span>
#include <vector>

#include "patency/physics/open_ends/profile.h"

namespace patency {

/// du/dt at the end of a step: now u + last u_last + before u_before.                                THEORY (18.16)
struct TimeRate {
    double now = 0, last = 0, before = 0;   ///< [1/s]

    /// Of second order for steps that differ; of first order if there was none before (0) [s].
    static TimeRate of_steps(double dt, double dt_before);
};

class DevelopedFlow {
public:
    /// Radius or half gap [m], kinematic viscosity [m^2/s]. At rest.
    DevelopedFlow(Section section, double radius, double viscosity);

    /// Prepares what is possible at the end of a step: rest(s) + mean speed times unit(s).
    void begin_step(const TimeRate& rate);
    double rest(double s) const { return at(rest_, s); }   ///< carries nothing [m/s]; zero outside
    double unit(double s) const { return at(unit_, s); }   ///< of a mean of one
    void end_step(double mean_speed);                      ///< that it turned out to be [m/s]
    /// What blood at places s does now, and did before: speeds [m/s], smoothed over `reach`. Of no places: rest.
    void start_from(std::span<const double> places, std::span<const double> speeds, double reach);

    /// For checkpoints: velocities at the end of the last step and the one before.
    std::vector<double> state() const;
    void restore(std::span<const double> state);

private:
    double at(const std::vector<double>& values, double s) const;
    double mean(const std::vector<double>& values) const;
    std::vector<double> solve(double rate, std::vector<double> right) const;

    Section section_;
    double diffusion_;                                  // viscosity over radius^2 [1/s]
    std::vector<double> last_, before_, rest_, unit_;   // in the middles of rings
};

}   // namespace patency
