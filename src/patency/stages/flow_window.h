// SPDX-License-Identifier: Apache-2.0
// From when to when a flow's results are means over time. Without `numerics.convergence` the deck's times say it; with it
// the flow is watched until it has settled: a steady flow of particles over the windows that agreed, others a while longer.
#pragma once

#include <optional>
#include <vector>

#include "patency/stages/flow_means.h"

namespace patency {

/// How far means moved from one window to the next, and how sure that is.
struct WindowChange {
    double change = 0;   ///< the largest [%]
    double excess = 0;   ///< of the largest beyond what it may be: the tolerance, or twice its own uncertainty [%]
};

class FlowWindow {
public:
    explicit FlowWindow(const Scene& scene);

    /// To be called after every step. True where a block of the means ends, of a flow whose windows slide: the next begins, and the
    /// oldest of `blocks` is none of theirs any more.
    bool observe(const Scene& scene);
    bool slides() const { return slides_; }
    double block_begin() const {
        return state_.marks[state_.marks.size() - 1 - (state_.marks.size() - 1) % parts_of_block].time;
    }
    static constexpr std::size_t parts_of_block = 2;
    static constexpr std::size_t blocks = 4;   ///< half windows that the means are made of

    const std::vector<double>& exact_times() const { return exact_times_; }   ///< that steps must end at [s]
    /// Where the means begin; none while that is not known.
    const std::optional<FlowMark>& begin() const { return state_.begin; }
    double end() const { return state_.end; }   ///< where the run ends, by what is known now [s]

    /// With a convergence: whether flows and pressures of all openings had settled, and by how much their means changed from the last
    /// window but one to the last [%].
    bool is_watched() const { return length_ > 0; }
    bool is_settled() const { return state_.is_settled; }
    double change_percent() const { return state_.change_percent; }
    double length() const { return length_; }   ///< of a window [s]

    /// For checkpoints.
    struct State {
        std::optional<FlowMark> begin;
        std::vector<FlowMark> marks;   ///< ends of the parts of the last two windows
        double end = 0, change_percent = 100;
        int quiet_windows = 0;   ///< in a row, in which nothing moved
        bool is_settled = false;
    };
    const State& state() const { return state_; }
    void restore(const State& state) { state_ = state; }

private:
    void compare_windows(const Scene& scene);

    double length_ = 0, averaging_ = 0, start_ = 0;
    bool slides_ = false;
    std::vector<double> exact_times_;
    State state_;
};

/// When the run of a scene (build_frame is enough) will probably end [s]: its duration, or sooner if it waits for rest and finds it like the
/// flows of verify coronary_bifurcation did.
double probable_end(const Scene& scene);

/// The change between two windows of `parts` each, whose ends are `marks` (2 parts + 1). Flows count by the inflow; pressures beside the
/// first opening's by the range of the openings; that one's own, the level, by what it is above the datum [Pa]. Parts that scatter tell
/// how uncertain a mean is; never is more than four times the tolerance [%] put down to that.        THEORY.md section 15
WindowChange change_of_windows(const std::vector<FlowMark>& marks, int parts, double tolerance, double datum);

}   // namespace patency
