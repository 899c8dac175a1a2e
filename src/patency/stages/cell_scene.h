// SPDX-License-Identifier: Apache-2.0
// A steady flow of a deck on cells: from the lumen to points, cells, openings and the balanced fields. Writes no files
// (cell_flow.h).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "patency/config/case.h"
#include "patency/schemes/cell_solver.h"
#include "patency/shape/lumen.h"
#include "patency/shape/spacing_field.h"
#include "patency/stages/vessel.h"

namespace patency {

/// Points in a lumen, and the spacing of each.
struct CellPoints {
    std::vector<Vec3> point;                         ///< [m]
    std::vector<double> spacing;                     ///< [m]
    std::function<double(const Vec3&)> spacing_at;   ///< everywhere in the lumen [m]
};

struct CellScene {
    deck::Case config;   ///< with the outlets' resistances tuned
    Lumen lumen;
    CellMesh mesh;
    std::function<double(const Vec3&)> spacing_at;   ///< of its points [m]
    std::vector<CellEnd> ends;                       ///< as lumen.openings
    double reference_speed;                          ///< [m/s]
    std::unique_ptr<CellBalance> balance;            ///< refers to the mesh
    CellSolution solution;
    std::shared_ptr<const Vessel> vessel{};   ///< of a surface or a network
};

/// Throws DeckError for what a flow on cells cannot be: walls that move, a body force, a pulse in a steady flow.
void expect_possible(const deck::Case& config);

/// The lumen of a deck. Throws as expect_possible.
Lumen make_cell_lumen(const deck::Case& config, const Vessel* vessel = nullptr);

/// The spacing that `numerics.across` asks for. vessel: the deck's, followed; none of a shape.
SpacingField make_cell_spacing(const Lumen& lumen, const Vessel* vessel, const deck::Numerics& numerics);

/// Relaxed points behind the openings: as far apart as the field says, or `spacing` [m].
CellPoints make_cell_points(const Lumen& lumen, const SpacingField& field);
CellPoints make_cell_points(const Lumen& lumen, double spacing);

/// Everything but the flow, which rests.
std::unique_ptr<CellScene> make_cell_scene(const deck::Case& config, const Lumen& lumen, const CellPoints& points);

/// Solves the flow, from that of a coarser scene if one is given. Throws DivergedError.
void solve_scene(CellScene& scene, const CellScene* coarser, const CellSolverSettings& settings);

/// The scene of a deck with its flow: a coarse one first, which costs little and is a good start. `watch` is called with
/// every scene before and after every step of its solution; true ends the run. `describe_remains`, of a scene whose flow diverged, is
/// added to the DivergedError. vessel: the deck's, if it is known.
std::unique_ptr<CellScene> make_solved_scene(const deck::Case& config,
                                             const std::function<bool(const CellScene&)>& watch = {},
                                             const std::function<std::string(const CellScene&)>& describe_remains = {},
                                             std::shared_ptr<const Vessel> vessel = {});

}   // namespace patency
