// SPDX-License-Identifier: Apache-2.0
// The flexible generalised minimal residual method (Saad 1993) on cell vectors. Knows neither matrix nor physics.
#pragma once

#include <functional>

#include "patency/schemes/cell_matrix.h"

namespace patency {

/// z = about A^-1 v, and w = A z: preconditioners know parts of that from their last sweep.
using PreconditionedOperator = std::function<void(const CellVectors& v, CellVectors& z, CellVectors& w)>;

struct KrylovResult {
    double residual;   ///< |right - A x| over |right|
    int steps;
};

/// x = about A^-1 right, from zero, in at most `most` steps or until the residual is below tolerance. Sums are in double
/// and in fixed blocks: the same bits for any number of threads.
KrylovResult solve_by_krylov(const PreconditionedOperator& apply, const CellVectors& right, CellVectors& x, int most,
                             double tolerance);

}   // namespace patency
