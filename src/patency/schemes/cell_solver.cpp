// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/schemes/cell_krylov.h"

namespace patency {

namespace {

// A linear solve that leaves more than this of the residual gets nowhere: the step is too long for it.
constexpr double stagnant = 0.5;
constexpr int most_cures = 6;
constexpr double runaway = 1e4;   // growth of the residual over the least so far that is no detour any more

}   // namespace

CellSolution solve_steady(CellBalance& balance, CellMatrix& matrix, const CellSolverSettings& settings) {
    CellSolution solution;
    double courant = settings.first_courant, limit = settings.courant, kappa = settings.kappa;
    double least = INFINITY;
    int cures = 0;
    CellVectors right, change;
    const auto precondition = [&](const CellVectors& x, CellVectors& y) { matrix.precondition(x, y); };
    const auto multiply = [&](const CellVectors& x, CellVectors& y) {
        matrix.multiply(x, y);
        balance.add_openings(x, y);
    };
    const auto fail = [&](const std::string& why) {
        return DivergedError(fmt::format(
            "the steady flow on cells {} after {} steps: the cells lack {:.2g} of the flow and {:.2g} of the forces, "
            "where {:.2g} is asked for",
            why, solution.history.size(), balance.volume_residual(), balance.momentum_residual(), settings.tolerance));
    };
    for (int step = 0; step <= settings.most_iterations; ++step) {
        balance.compute_residual(kappa);
        const double volume = balance.volume_residual(), momentum = balance.momentum_residual(),
                     worst = std::max(volume, momentum);
        if (!std::isfinite(worst)) throw fail("lost its numbers");
        if (volume < settings.tolerance && momentum < settings.tolerance) {
            solution.is_converged = true;
            solution.history.push_back({volume, momentum, 0, 0, courant});
            return solution;
        }
        if (settings.interrupted && settings.interrupted()) return solution;
        if (step > 0) least = std::min(least, worst);
        if (worst > runaway * least) throw fail("ran away");
        balance.fill({courant}, matrix, right);
        const KrylovResult linear =
            solve_by_krylov(multiply, precondition, right, change, settings.krylov_steps, settings.krylov_tolerance);
        solution.history.push_back({volume, momentum, linear.residual, linear.steps, courant});
        solution.linear_steps += linear.steps;
        if (!(linear.residual < stagnant)) {
            if (++cures > most_cures) throw fail("has a matrix that cannot be solved");
            limit = std::max(1.0, 0.5 * courant);
            courant = limit;
            kappa *= 0.7;
            continue;
        }
        balance.apply(change);
        courant = std::min(limit, settings.growth * courant);
    }
    throw fail("has not converged");
}

}   // namespace patency
