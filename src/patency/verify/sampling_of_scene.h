// SPDX-License-Identifier: Apache-2.0
// What several verification cases measure in a scene: profiles across it, its flow, its pressure gradient. Means are
// over the particles themselves, which all have the same volume, weighted with time.
#pragma once

#include <span>

#include "patency/stages/flow.h"
#include "patency/stages/lumen_of_case.h"
#include "patency/verify/profile_fit.h"
#include "patency/verify/verify_case.h"

namespace patency {

/// The scene's straight axis. @throws GeometryError if it has none.
StraightAxis axis_of(const Scene& scene);

/// Steps to `until` [s], calling observe after every step.
void run_until(Scene& scene, const RunContext& context, double until,
               const std::function<void(const Scene&, double dt)>& observe = {});

/// Calls visit(particle, axial - length/2, radial) for the particles within `reach` [m] of mid-length, in the domain.
template <class Visit>
void for_each_near_middle(const Scene& scene, const StraightAxis& axis, double reach, Visit visit) {
    for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
        const double along = axis.axial(scene.fluid.position[i]) - 0.5 * axis.length;
        if (std::abs(along) < reach && scene.fluid.opening[i] == 0)
            visit(i, along, axis.radial(scene.fluid.position[i]));
    }
}

/// Mean axial velocity of the particles in the middle half [m/s].
double mean_velocity_in_middle(const Scene& scene, const StraightAxis& axis);
/// Slope -dp/dx of a straight line through the pressures in the middle half [Pa/m].
double pressure_gradient_in_middle(const Scene& scene, const StraightAxis& axis);

/// Velocity along x over y between plates, at the stations (k + 1/2) dp, from particles within `columns` spacings of
/// mid-length.
void add_plane_profile(const Scene& scene, double columns, double weight, ProfileFit& fit);
ProfileFit make_plane_fit(const Scene& scene);

/// Axial velocity over the radius of a tube, at stations every half spacing from a quarter on, from the middle half.
ProfileFit make_pipe_fit(const Scene& scene, const StraightAxis& axis);
void add_pipe_profile(const Scene& scene, const StraightAxis& axis, double weight, ProfileFit& fit);
/// Flow [m^3/s] of such a profile that is zero at the wall: pi times the integral over r^2, by the trapezoidal rule, so
/// exact for parabolas. A plain mean over particles would be too large, by 0.6 % at D/12, since the centres of particles
/// keep half a spacing off the wall.
double flow_through(const ProfileFit& fit, double radius);

/// Mean in time of numbers that come with a duration.
class TimeMean {
public:
    void add(double value, double dt) { sum_ += value * dt, time_ += dt; }
    double value() const { return sum_ / time_; }

private:
    double sum_ = 0, time_ = 0;
};

void put_number(RunData& data, const std::string& name, double value);

}   // namespace patency
