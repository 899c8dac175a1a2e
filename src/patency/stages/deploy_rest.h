// SPDX-License-Identifier: Apache-2.0
// How much a stent still moves.
#pragma once

#include <vector>

#include "patency/analysis/stent_metrics.h"

namespace patency {

/// Compares a stent's mean and least diameter with those a while before.
class DeployRest {
public:
    /// From the next look on.
    void begin() { from_ = -1; }

    /// At a look, at a time of the program [s]: true where `span` [s] has passed since the look that it was compared with last.
    bool compare(double program, const StentProfile& profile, double span);

    /// Of the last comparison, a share of the diameter, of the two whichever is more.
    double shrunk() const { return shrunk_; }
    double moved() const { return moved_; }

    /// All that it knows of the past, to be kept and put back.
    std::vector<double*> numbers() { return {&from_, &mean_, &least_, &shrunk_, &moved_}; }

private:
    double from_ = -1;              // of the program [s]; negative: nothing to compare with
    double mean_ = 0, least_ = 0;   // then [m]
    double shrunk_ = 0, moved_ = 0;
};

}   // namespace patency
