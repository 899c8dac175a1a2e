// SPDX-License-Identifier: Apache-2.0
// A flow on cells in time: steps of second order, each solved to its end. The particles stand still; their velocity and
// pressure change.                                                                        THEORY.md (18.16), (18.17)
#pragma once

#include <memory>
#include <vector>

#include "patency/bodies/fluid.h"
#include "patency/bodies/open_end.h"
#include "patency/physics/open_ends/developed_flow.h"
#include "patency/schemes/cell_solver.h"
#include "patency/schemes/flow_scheme.h"

namespace patency {

/// An opening of a march beside its OpenEnd.
struct MarchedEnd {
    CellEnd::Kind kind;
    Section section;
    double radius;      ///< or half gap [m]
    double viscosity;   ///< kinematic, of what comes a long way to it [m^2/s]
};

/// Newton's steps of a step in time.
struct MarchedStep {
    /// They end when cells lack this of the greatest flow and forces so far. A tenth of it takes half as many again and changes flows by
    /// 0.03 %, pressures by 0.003 % of their largest (the paper's bifurcation with coronary beds at hyperaemia, 7 cells across).
    double tolerance = 1e-3;
    int least = 0;   ///< and not before so many
};

/// What a march works on; all but the mesh must outlive it.
struct CellMarchDomain {
    CellMesh mesh;   ///< of the particles, in their order
    CellFluid material;
    FluidParticles& fluid;
    std::vector<OpenEnd>& ends;
    std::vector<MarchedEnd> marched;                    ///< as the ends
    double reference_speed, first_step, longest_step;   ///< [m/s], [s]
    MarchedStep each_step = {};
};

class CellMarch : public FlowScheme {
public:
    /// From the velocities and the ends' flows that are there.
    explicit CellMarch(CellMarchDomain domain);

    FlowStep step(double time, double longest) override;
    std::map<std::string, std::vector<double>> state() const override;
    void restore(const std::map<std::string, std::vector<double>>& state) override;

    const CellMesh& mesh() const { return domain_.mesh; }
    const CellBalance& balance() const { return *balance_; }   ///< of the last step

private:
    FlowStep step_of(double time, double dt);
    std::vector<CellEnd> ends_at(double time);
    void start_feeding();
    void start_from_extrapolation(const TimeRate& rate, double dt);
    int solve();
    double hand_over();   // the largest speed [m/s]

    CellMarchDomain domain_;
    CellMatrix matrix_;
    std::vector<DevelopedFlow> feeding_;   // as the ends
    std::unique_ptr<CellBalance> balance_;
    std::vector<Vec3> velocity_before_;                           // [m/s]
    std::vector<double> pressure_before_, end_pressure_before_;   // [Pa]
    double dt_before_ = 0;
    std::vector<double>
        offset_;   // of the pressure imposed at an end, so that the mean over its cells is the one wanted [Pa]
    CellScales scales_;
};

}   // namespace patency
