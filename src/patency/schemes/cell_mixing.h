// SPDX-License-Identifier: Apache-2.0
// Anderson's mixing of the steps of an iteration whose matrix is only nearly that of its residual: of what the last steps did to
// what is lacking it makes one that leaves less. Knows neither matrix nor physics.                   THEORY.md (18.18)
#pragma once

#include <cmath>
#include <deque>

#include "patency/schemes/cell_matrix.h"

namespace patency {

class CellMixing {
public:
    /// Looks back over as many steps. Takes 32 bytes a cell for each.
    explicit CellMixing(std::size_t depth) : depth_(depth) {}

    /// Turns the change that the iteration proposes into the one to make, where so much is lacking. Forgets steps that were much longer,
    /// and all of them once a number of steps in a row have gained nothing. The same bits for any number of threads.
    void mix(CellVectors& change, double lacking);
    /// The next step is the first: what went before tells nothing any more.
    void forget();

private:
    struct Pair {
        CellVectors answer, both;      // to a change: what the proposal changed by after it; the change and its answer
        std::deque<double> products;   // of the answer with those of the older pairs and itself
    };
    void learn(const CellVectors& change);
    void forget_oldest();

    std::size_t depth_;
    std::deque<Pair> pairs_;        // the oldest first
    CellVectors proposed_, made_;   // in the last step
    double least_ = INFINITY;
    int in_vain_ = 0;
};

}   // namespace patency
