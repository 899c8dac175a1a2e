// SPDX-License-Identifier: Apache-2.0
// How fast a deployment goes.
#pragma once

#include <vector>

namespace patency {

/// The time that a deployment's program is at, beside that of the solids: it passes more slowly where what is driven would
/// move too fast. All times in [s].                                                                     THEORY (21.16)
class DeployPace {
public:
    /// A change of pace takes so long; it is at the most so many times slower than the solids' time (>= 1; 1: never).
    DeployPace(double change, double slowing);

    /// Of the program; while nothing was ever too fast, the time itself to the last bit.
    double program(double time) const { return time - lag(time); }
    /// When the program will be there.
    double time_of(double program) const;
    /// Of the program, per second.
    double rate(double time) const;
    double least_rate() const { return least_; }

    /// What is driven has this kinetic over internal energy now; no more often than a change takes.
    void heed(double time, double ratio);
    /// Nothing is driven any more: as fast as it may, from now on.
    void recover(double time) { change_to(time, 1); }

    /// All that it knows of the past, to be kept and put back.
    std::vector<double*> numbers() { return {&since_, &lag_, &from_, &to_, &least_}; }

private:
    double lag(double time) const;
    void change_to(double time, double rate);

    double change_, slowest_;
    double since_ = 0, lag_ = 0;   // the last change began then; what the program lagged behind
    double from_ = 1, to_ = 1;     // the rate before the change and after it
    double least_ = 1;             // ever
};

}   // namespace patency
