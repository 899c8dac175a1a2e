// SPDX-License-Identifier: Apache-2.0
// Means over time along a vessel's branches and on its wall, taken while a flow goes on: what FFR, pullbacks and wall shear
// are made of. Knows no files.
#pragma once

#include <vector>

#include "patency/analysis/section_flow.h"
#include "patency/analysis/wall_shear.h"
#include "patency/stages/scene.h"
#include "patency/stages/vessel_cut.h"

namespace patency {

/// A section across a branch at which the flow is measured.
struct VesselStation {
    std::size_t branch, line;   ///< as the vessel's; `line` is the branch's own
    double arc;                 ///< along the line from the inlet [m]
    SectionPlane plane;
    double area;   ///< of the surface's section [m^2]
};

/// The part of a vessel's surface that is wall: no caps.
struct LumenWall {
    Surface surface;
    WallPlaces places;   ///< its points
};

class VesselRecorder {
public:
    /// Of a scene with a vessel.
    explicit VesselRecorder(const Scene& scene);

    /// What there is now, as one instant of the means.
    void sample(const Scene& scene);

    /// What was sampled since the last call becomes a block of its own; of the finished ones the last `kept` stay.
    void end_block(std::size_t kept);
    /// Adds the finished blocks to what was sampled since.
    void join_blocks();

    std::size_t instants() const { return flows_.instants(); }   ///< since the last block ended
    const std::vector<VesselStation>& stations() const { return stations_; }
    const SectionFlowMeans& flows() const { return flows_; }   ///< as the stations; pressures as the deck counts them
    const LumenWall& wall() const { return wall_; }
    const WallShearMeans& shear() const { return shear_; }   ///< as the wall's points; each instant counts 1 s
    std::vector<double> wall_pressure() const;               ///< mean, as the deck counts it [Pa]
    const VesselCut& cut() const { return cut_; }

    /// For checkpoints.
    struct State {
        std::vector<double> flows, shear, pressure, cut;
    };
    State state() const { return {flows_.state(), shear_.state(), wall_pressure_, cut_.state()}; }
    const std::vector<State>& finished() const { return finished_; }
    void restore(const State& state, std::vector<State> finished = {});

private:
    std::vector<VesselStation> stations_;
    std::vector<SectionGrid> grids_;
    LumenWall wall_;
    VesselCut cut_;
    SectionFlowMeans flows_;
    WallShearMeans shear_;
    std::vector<double> wall_pressure_;   // sums
    std::vector<State> finished_;         // blocks, oldest first
};

/// The sections at which branches are measured: those of the vessel that belong to their branch alone, one every half
/// millimetre, or two spacings if that is more.
std::vector<VesselStation> make_stations(const Vessel& vessel, const LocalLength& spacing);
LumenWall make_lumen_wall(const Vessel& vessel);

}   // namespace patency
