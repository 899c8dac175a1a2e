// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "patency/schemes/cell_krylov.h"
#include "tests/schemes/cell_pipe.h"

namespace patency {
namespace {

using testing_cells::Pipe;

/// As at rest, with a step as long as near the answer.
CellVectors fill_from_rest(CellBalance& balance, CellMatrix& matrix) {
    CellVectors right;
    balance.compute_residual(0.5);
    balance.fill({1000, 1e-5}, matrix, right);
    return right;
}

/// Steps of GMRES to a hundredth.
int linear_steps(const Pipe& pipe) {
    CellBalance balance = pipe.balance();
    CellMatrix matrix(pipe.mesh);
    CellVectors change;
    const CellVectors right = fill_from_rest(balance, matrix);
    const PreconditionedOperator apply = [&](const CellVectors& v, CellVectors& z, CellVectors& w) {
        matrix.precondition(v, z, w);
        balance.add_openings(z, w);
    };
    return solve_by_krylov(apply, right, change, 60, 1e-2).steps;
}

TEST(CellMatrix, knowsItsProductFromTheLastSweep) {
    const Pipe pipe(12);
    CellBalance balance = pipe.balance();
    CellMatrix matrix(pipe.mesh);
    const CellVectors right = fill_from_rest(balance, matrix);
    CellVectors x(right.size()), told(right.size()), multiplied(right.size());
    matrix.precondition(right, x, told);
    matrix.multiply(x, multiplied);
    for (int k = 0; k < 4; ++k) {
        float largest = 0, apart = 0;
        for (std::size_t i = 0; i < right.size(); ++i)
            largest = std::max(largest, std::abs(multiplied[i][k])),
            apart = std::max(apart, std::abs(told[i][k] - multiplied[i][k]));
        EXPECT_GT(largest, 0);
        EXPECT_LT(apart, 1e-4f * largest);
    }
}

// Sums of entries alone are too stiff on coarser levels, and the more of them there are the more steps it would take. THEORY.md (18.13)
TEST(CellMatrix, needsHardlyMoreStepsForManyCells) { EXPECT_LE(linear_steps(Pipe(24)), linear_steps(Pipe(8)) + 1); }

TEST(CellKrylov, solvesWhatItIsGiven) {
    // A lower triangle with a diagonal that grows, preconditioned by the diagonal.
    const std::size_t count = 40;
    const auto multiply = [](const CellVectors& x, CellVectors& y) {
        for (std::size_t i = 0; i < x.size(); ++i) y[i] = float(i + 1) * x[i] + (i > 0 ? x[i - 1] : CellVector{});
    };
    const PreconditionedOperator apply = [&](const CellVectors& v, CellVectors& z, CellVectors& w) {
        for (std::size_t i = 0; i < v.size(); ++i) z[i] = v[i] / float(i + 1);
        multiply(z, w);
    };
    CellVectors wanted(count), right(count), found;
    for (std::size_t i = 0; i < count; ++i) wanted[i] = CellVector{float(i), 1, -2, 0.5f * float(i)};
    multiply(wanted, right);
    const KrylovResult result = solve_by_krylov(apply, right, found, 60, 1e-6);
    EXPECT_LT(result.residual, 1e-6);
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < 4; ++k) ASSERT_NEAR(found[i][k], wanted[i][k], 2e-3f);
}

}   // namespace
}   // namespace patency
