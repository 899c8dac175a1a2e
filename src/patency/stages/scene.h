// SPDX-License-Identifier: Apache-2.0
// A scene: everything a stage works on, in memory. Made by build.h, moved on by flow.h; knows no files.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "patency/analysis/wall_shear.h"
#include "patency/bodies/fluid.h"
#include "patency/bodies/open_end.h"
#include "patency/bodies/relax.h"
#include "patency/bodies/wall.h"
#include "patency/config/case.h"
#include "patency/schemes/flow_scheme.h"
#include "patency/search/cells.h"
#include "patency/shape/lumen.h"
#include "patency/stages/end_law.h"
#include "patency/stages/estimate.h"

namespace patency {

struct Scene {
    Scene() = default;
    Scene(const Scene&) = delete;   // the scheme refers to the particles
    Scene& operator=(const Scene&) = delete;

    deck::Case config;   ///< its pressures less the datum
    Lumen lumen{.distance = everywhere(), .openings = {}, .volume = 0, .wall_area = 0, .bounds = {}};
    double nominal_narrowest = 0;     ///< lumen.narrowest before centrelines told more: cells are as fine as that [m]
    std::optional<Vessel> vessel{};   ///< followed; of surfaces and networks
    std::optional<Estimate> estimate{};   ///< of the vessel
    std::unique_ptr<Frame> frame;
    FluidParticles fluid;
    WallParticles wall;
    std::vector<OpenEnd> ends;   ///< as lumen.openings
    std::vector<EndLaw> laws;    ///< as ends: what the deck imposes there
    FluidMaterial material;
    FlowNumerics numerics;
    std::unique_ptr<FlowScheme> scheme;
    RelaxQuality relax_quality{};                    ///< of the points it started from
    std::string start_remark{};                      ///< what the flow started from, if there is something to say
    std::function<double(const Vec3&)> spacing_at;   ///< [m]; empty: numerics.spacing everywhere
    std::optional<WallParts> wall_parts;             ///< of a scheme that knows the flow at the wall itself

    double time = 0;    ///< [s]
    double datum = 0;   ///< what the deck's pressures are above in config, laws and estimate: never moves [Pa]
    double reference_pressure = 0;   ///< p_ref, above the datum: fluid.pressure and the ends' are above it [Pa]
    double last_dt = 0;              ///< of the last advection step [s]
    double unsettled = 0;            ///< length of an acoustic step that the ends' integrals lack; 0 between steps [s]
    std::int64_t acoustic_steps = 0, advection_steps = 0;

    /// Added to pressures of fluid and ends: as the deck counts them [Pa].
    double level() const { return datum + reference_pressure; }
    double pressure_of(std::size_t i) const { return fluid.pressure[i] + level(); }
};

}   // namespace patency
