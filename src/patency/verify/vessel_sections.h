// SPDX-License-Identifier: Apache-2.0
// Sections of a vessel at which another program's solution is known, and what ours says there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "patency/analysis/section_flow.h"
#include "patency/analysis/wall_shear.h"
#include "patency/stages/scene.h"
#include "patency/verify/run_data.h"

namespace patency {

/// What finite volumes say of a section.
struct VesselSection {
    std::string branch;
    double arc;   ///< along the network's curve [m]
    SectionPlane plane;
    double area, flow, pressure, peak, wss;   ///< [m^2], [m^3/s], [Pa], [m/s], [Pa]; wss 0 where it is not told
};

/// Of the reference paper's bifurcation. Throws FileError.
std::vector<VesselSection> read_bifurcation_sections(const std::filesystem::path& reference);
/// Through the lesion of the left coronary tree. Throws FileError.
std::vector<VesselSection> read_tree_sections(const std::filesystem::path& reference);

/// A ring of places around each section, where rays from its middle meet the wall.
struct WallRing {
    WallPlaces places;
    std::vector<double> weight;   ///< how much of the outline each stands for [m]
};

/// Means over instants at sections.
class SectionsMeasure {
public:
    SectionsMeasure(const Scene& scene, std::vector<VesselSection> sections);

    void sample(const Scene& scene);
    std::size_t count() const { return flows_.instants(); }
    /// Lists area, flow, pressure, peak and wss, as the sections.
    void write(RunData& data) const;

private:
    std::vector<VesselSection> sections_;
    WallHint hint_;
    std::vector<SectionGrid> grids_;
    std::vector<WallRing> rings_;
    WallPlaces all_;
    SectionFlowMeans flows_;
    WallShearMeans shear_;
};

}   // namespace patency
