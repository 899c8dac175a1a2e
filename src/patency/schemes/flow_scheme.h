// SPDX-License-Identifier: Apache-2.0
// The scheme of moving blood particles: weakly compressible, first-order consistent, in difference form. One call of
// step() is one advection step; it reads like the algorithm in THEORY.md (7).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "patency/bodies/fluid.h"
#include "patency/bodies/open_end.h"
#include "patency/bodies/wall.h"
#include "patency/kernel/kernel.h"
#include "patency/pairs/sum_over_neighbours.h"
#include "patency/schemes/precision.h"

namespace patency {

/// Numbers of the scheme. Their reasons stand where they are used.
struct FlowNumerics {
    double spacing = 0;             ///< dp [m]
    double smoothing_ratio = 1.3;   ///< h / dp
    bool planar = false;
    double advection_cfl = 0.25;
    double acoustic_cfl = 0.6;
    double reference_speed = 0;   ///< a speed that will be reached, so that the first steps are not too long [m/s]
    double pressure_dissipation = 0.3;   ///< as a share of the Riemann solver's                  THEORY.md (4.6)
    double velocity_dissipation = 0.5;   ///< as a share of the upwind flux                      THEORY.md (4.9)
    double shift = 0.4;                  ///< to where there are fewer; from 0.5 on it overshoots      THEORY.md (6.2)
    bool free_slip = false;
    Vec3 body_force{};   ///< acceleration [m/s^2]
    LoopKind loop = LoopKind::packed;

    WendlandC2 kernel() const { return {smoothing_ratio * spacing, planar}; }
    /// A particle's own space [m^d].
    double cell() const { return planar ? spacing * spacing : spacing * spacing * spacing; }
};

/// What one advection step did.
struct FlowStep {
    double dt = 0;   ///< [s]
    int acoustic_steps = 0;
    double fastest = 0;   ///< largest speed [m/s]
};

class FlowScheme {
public:
    virtual ~FlowScheme() = default;
    /// One advection step from `time`, no longer than `longest` [s]. Throws DivergedError.
    virtual FlowStep step(double time, double longest) = 0;
    /// Calls the law of the open ends' pressures once per acoustic step, from time over dt: end.flow is measured, end.pressure is wanted.
    std::function<void(std::span<OpenEnd>, double time, double dt)> update_ends;
    /// Between two steps: brings the ends' integrals up to date.
    std::function<void()> settle_ends;
    /// What the next step depends on beside particles and ends, by name, for checkpoints.
    virtual std::map<std::string, std::vector<double>> state() const { return {}; }
    virtual void restore(const std::map<std::string, std::vector<double>>&) {}

protected:
    void update_wanted_pressures(std::span<OpenEnd> ends, double time, double dt) const {
        if (update_ends && !ends.empty()) update_ends(ends, time, dt);
    }
};

/// Everything a scheme works on; it must outlive the scheme.
struct FlowDomain {
    FluidParticles& fluid;
    WallParticles& wall;
    std::vector<OpenEnd>& ends;
    const Frame& frame;
    /// Distance to the nearest wall surface, negative inside the blood [m].
    std::function<double(const Vec3&)> distance;
};

std::unique_ptr<FlowScheme> make_flow_scheme(Precision precision, const FlowDomain& domain,
                                             const FluidMaterial& material, const FlowNumerics& numerics);

}   // namespace patency
