// SPDX-License-Identifier: Apache-2.0
// The order of blood and wall in memory, so that neighbours are near, and which row over the wall belongs to which
// particle of blood.
#pragma once

#include <cstdint>
#include <vector>

#include "patency/schemes/flow_scheme.h"
#include "patency/search/cells.h"
#include "patency/search/neighbours.h"

namespace patency {

/// Puts the particles into the order of `cells`. Those of blood are led back into a periodic box first; throws
/// DivergedError if one has left the frame.
void sort_blood(FluidParticles& fluid, Cells& cells, const Frame& frame, double spacing);
void sort_wall(WallParticles& wall, Cells& cells, const Frame& frame, double spacing);

/// wall_of[i]: which of the rows over the wall is that of particle i, counted through all blocks; no_wall: none.
inline constexpr std::uint32_t no_wall = UINT32_MAX;
void number_wall_rows(const Neighbours& wall_rows, std::size_t particles, std::vector<std::uint32_t>& wall_of);

}   // namespace patency
