// SPDX-License-Identifier: Apache-2.0
// From a case to a scene whose blood flows through the cells of still particles in time. Runs the steady flow that it
// starts from, nothing else.
#pragma once

#include <memory>

#include "patency/cells/cell_mesh.h"
#include "patency/schemes/cell_balance.h"
#include "patency/stages/cell_scene.h"
#include "patency/stages/scene.h"

namespace patency {

/// Ready for its first step: with the deck's initial velocity, or else the steady flow of what the openings do at first. Throws DeckError,
/// GeometryError, FileError, DivergedError.
std::unique_ptr<Scene> build_cell_scene(const deck::Case& config);

/// The same from a solved flow of that case. A steady case's goes on in time because it has no rest: its config's duration and windows become
/// such a flow's.
std::unique_ptr<Scene> build_cell_scene(const deck::Case& config, const CellScene& solved);

/// The same with blood at rest, into which a checkpoint is read.
std::unique_ptr<Scene> build_cell_frame(const deck::Case& config);

/// The cells as particles that stand where they are, with the wall's patches as feet of the wall's: what samples read.
void place_cells(Scene& scene, const CellMesh& mesh);
void set_flow(Scene& scene, const CellFields& fields);
/// What the cells say of the flow at the wall.
WallParts wall_parts_of(const CellMesh& mesh, const CellBalance& balance);

}   // namespace patency
