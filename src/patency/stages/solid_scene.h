// SPDX-License-Identifier: Apache-2.0
// Solids of a deck as bodies that can be stepped.
#pragma once

#include <cstdint>
#include <memory>

#include "patency/config/case.h"
#include "patency/schemes/solid_step.h"

namespace patency {

struct SolidScene {
    deck::Case config;
    SolidSystem system;
    double time = 0;          ///< [s]
    double dt = 0;            ///< [s] that the next steps may take
    std::int64_t steps = 0;   ///< of the fastest part

    const SolidPart& part(const std::string& name) const;   ///< @throws DeckError if there is none
    SolidPart& part(const std::string& name);
    std::size_t particle_count() const;
};

/// Particles, materials, constraints and loads of a deck's solids. Throws DeckError, GeometryError.
std::unique_ptr<SolidScene> build_solids(const deck::Case& config);

/// One step (of the slowest part), no further than `until` [s]; steps before it are of even length. Throws DivergedError.
void step_solids(SolidScene& scene, double until);

}   // namespace patency
