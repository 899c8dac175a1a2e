// SPDX-License-Identifier: Apache-2.0
// What a deployment by contact leaves while it goes on: the rows of deployment.csv and the frames of stent.pvd and wall.pvd.
#pragma once

#include <memory>
#include <optional>

#include "patency/analysis/stent_metrics.h"
#include "patency/io/csv.h"
#include "patency/io/output_folder.h"
#include "patency/io/pvd.h"
#include "patency/io/vtp.h"
#include "patency/stages/deploy_program.h"
#include "patency/stages/deploy_state.h"

namespace patency {

/// An instant of a deployment.
struct DeployInstant {
    double time;   ///< [s]
    DeployPhase phase;
    double tool_radius, tool_pressure;   ///< [m], [Pa]
    BodyEnergy stent, wall;
    double deepest;   ///< of stent in wall so far [m]
    double pace;      ///< of the program's time over that of the solids
};

class DeployRecord {
public:
    /// `from` [s]: where a run goes on, behind which nothing that was written stays; none of a new one. Throws FileError.
    DeployRecord(const OutputFolder& folder, std::optional<double> from);

    void add(const DeployInstant& instant, const StentProfile& profile);
    void add_frames(double time, const PolyData& stent, const PolyData& wall);
    std::size_t frames() const { return stent_.size(); }

private:
    const OutputFolder& folder_;
    PvdWriter stent_, wall_;
    CsvWriter table_;
};

}   // namespace patency
