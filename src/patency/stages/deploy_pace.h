// SPDX-License-Identifier: Apache-2.0
// How fast a deployment goes.
#pragma once

#include <vector>

namespace patency {

/// The time that a deployment's program is at, beside that of the solids: it passes more slowly where what is driven would
/// move too fast. All times in [s].                                                                     THEORY (21.16)
class DeployPace {
public:
    /// Looks at what is driven are so far apart in the program; it is at the most so many times slower than the solids' time
    /// (>= 1; 1: never).
    DeployPace(double between_looks, double slowing);

    /// Of the program; before it first sets out, the time itself to the last bit.
    double program(double time) const { return time - lag(time); }
    /// When the program will be there.
    double time_of(double program) const;
    /// Of the program, per second.
    double rate(double time) const;
    double least_rate() const { return least_; }

    /// Something is driven from now on: as fast as what is known of it allows. Only while tools stand still, whose speed would jump.
    void set_out(double time);
    /// At a look: what is driven has this kinetic over internal energy.
    void heed(double time, double ratio);
    /// Nothing happens until then, which is now.
    void skip_to(double time, double program);
    /// Nothing is driven any more, and tools stand still: as fast as it may.
    void rest(double time);

    /// All that it knows of the past, to be kept and put back.
    std::vector<double*> numbers() { return {&since_, &lag_, &from_, &to_, &least_, &at_full_rate_}; }

private:
    double lag(double time) const;
    double allowed() const;
    void change(double time, double from, double to);

    double between_, slowest_;
    double since_ = 0, lag_ = 0;   // the last change began then; what the program lagged behind
    double from_ = 1, to_ = 1;     // the rate before the change and after it
    double least_ = 1;             // ever
    double at_full_rate_;          // the ratio that is expected there
};

}   // namespace patency
