// SPDX-License-Identifier: Apache-2.0
// The steady flow through a lumen at rest on the cells of its particles: implicit steps in pseudo-time with artificial
// compressibility until every cell is in balance. Never returns a flow that is not.            THEORY.md section 18
#pragma once

#include <functional>

#include "patency/schemes/cell_balance.h"

namespace patency {

struct CellSolverSettings {
    double tolerance = 1e-6;   ///< of the sums of volume and momentum that cells lack
    double imbalance_share =
        0.3;   ///< of the tolerance, for what the openings let in over all that passes: results are told by it
    int least_iterations = 0, most_iterations = 400, most_sharp_iterations = 400;   ///< these with the sharp transport
    bool starts_sharp =
        false;   ///< the fields are those that coarser cells found with the sharp transport: it is tried first
    double first_courant = 5, courant = 1000, growth = 1.4;
    double kappa = 0.5;   ///< of the artificial sound speed: steady answers hardly depend on it
    int krylov_steps = 40;
    double krylov_tolerance = 0.1;
    double mixes_below =
        0.2;   ///< of the forces that cells lack: from then on the last steps are mixed   THEORY.md (18.18)
    bool gives_up =
        false;   ///< a flow that stands without rest or takes too many steps is left as it is, for whoever follows it in time
    bool ends_may_turn = true;                ///< between a pressure and what enters, in every step
    std::function<bool()> interrupted = {};   ///< asked after every step; true ends the run
};

struct CellIteration {
    double volume_residual, momentum_residual, linear_residual;
    int linear_steps;
    double courant;
};

struct CellSolution {
    bool is_converged = false;   ///< to the tolerance
    /// Not to it: a jet that does not come to rest, while the openings' flows and pressures stand still. The fields are means
    /// over the last steps.
    bool is_settled = false;
    bool is_given_up = false;   ///< the fields are those that lacked least
    bool is_damped = false;     ///< by the damped transport: the sharp one did not come to rest
    double swing =
        0;   ///< of what stands still: largest change of a flow over all that flows, of a pressure over their range
    std::vector<CellIteration> history;
    int linear_steps = 0;
};

inline bool is_interrupted(const CellSolution& s) { return !s.is_converged && !s.is_settled && !s.is_given_up; }

/// From the fields that the balance has: with the damped transport first, unless it `starts_sharp`, then the sharp one; where that does not
/// come to rest, by the damped one. Throws DivergedError if it neither comes to the tolerance nor settles: what, and how far.
CellSolution solve_steady(CellBalance& balance, CellMatrix& matrix, const CellSolverSettings& settings);

/// With the transport and the time derivative that the balance has, to the tolerance. Throws DivergedError if it does not come there.
CellSolution solve_instant(CellBalance& balance, CellMatrix& matrix, const CellSolverSettings& settings);

}   // namespace patency
