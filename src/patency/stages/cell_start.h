// SPDX-License-Identifier: Apache-2.0
// A steady flow of moving particles starts from the same flow solved on cells, a few across: jets and flow split are there from
// the beginning, and what is left to the particles is what their spacing makes of it.                  THEORY.md (15.6)
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "patency/schemes/cell_balance.h"
#include "patency/stages/scene.h"

namespace patency {

struct CellScene;

/// The deck of the flow that a deck of moving particles starts from.
deck::Case case_on_cells(deck::Case config);

/// From a particle to the six points around it whose mean is that of a quadratic profile over its cell.   THEORY.md (15.6)
inline std::array<Vec3, 6> ways_around(double spacing) {
    const double half = 0.5 * spacing;
    return {Vec3{half, 0, 0},  Vec3{-half, 0, 0}, Vec3{0, half, 0},
            Vec3{0, -half, 0}, Vec3{0, 0, half},  Vec3{0, 0, -half}};
}

class CellStart {
public:
    /// Of a scene whose frame is there. Solves the flow: seconds. Throws DeckError, GeometryError, DivergedError.
    explicit CellStart(const Scene& scene);
    ~CellStart();
    CellStart(const CellStart&) = delete;

    /// Velocities [m/s] of particles there: means over their cells.
    std::vector<Vec3> velocities(std::span<const Vec3> places) const;
    /// Pressures [Pa] as the scene's deck counts them.
    std::vector<double> pressures(std::span<const Vec3> places) const;
    const std::vector<CellEndState>& ends() const { return ends_; }   ///< as the scene's
    std::size_t cells() const;

private:
    // Beside an opening cells lie on one side of a place only, and what they say there carries up to 5 % too little: the flow a cell
    // within goes on as it is.
    Vec3 within(const Vec3& place) const;

    const Scene& scene_;
    std::unique_ptr<const CellScene> solved_;
    std::vector<CellEndState> ends_;
};

}   // namespace patency
