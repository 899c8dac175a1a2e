// SPDX-License-Identifier: Apache-2.0
// Anderson's mixing of the steps of an iteration whose matrix is only nearly that of its residual: of what the last steps did to
// what is lacking it makes one that leaves less. Knows neither matrix nor physics.                   THEORY.md (18.18)
#pragma once

#include <deque>

#include "patency/schemes/cell_matrix.h"

namespace patency {

class CellMixing {
public:
    /// Looks back over as many steps.
    explicit CellMixing(std::size_t depth) : depth_(depth) {}

    /// Turns the change that the iteration proposes into the one to make. The same bits for any number of threads.
    void mix(CellVectors& change);
    /// The next step is the first: what went before tells nothing any more.
    void forget() { pairs_.clear(), proposed_.clear(); }

private:
    struct Pair {
        CellVectors made, answer;   // a change of the fields, and of what was proposed after it
    };
    std::size_t depth_;
    std::deque<Pair> pairs_;
    CellVectors proposed_, made_;   // in the last step
};

}   // namespace patency
