// SPDX-License-Identifier: Apache-2.0
// From when to when a flow's results are means over time. Without `numerics.convergence` the deck's times say it; with it
// the flow is watched until it has settled, and then a while longer.
#pragma once

#include <optional>
#include <vector>

#include "patency/stages/flow_means.h"

namespace patency {

class FlowWindow {
public:
    explicit FlowWindow(const Scene& scene);

    /// To be called after every step.
    void observe(const Scene& scene);

    const std::vector<double>& exact_times() const { return exact_times_; }   ///< that steps must end at [s]
    /// Where the means begin; none while that is still ahead.
    const std::optional<FlowMark>& begin() const { return state_.begin; }
    double end() const { return state_.end; }   ///< where the run ends, by what is known now [s]

    /// With a convergence: whether flows and pressures of all openings had settled before the means began, and by how much
    /// their means changed from the last window but one to the last, of the inflow and of the range of the pressures [%].
    bool is_watched() const { return length_ > 0; }
    bool is_settled() const { return state_.is_settled; }
    double change_percent() const { return state_.change_percent; }
    double length() const { return length_; }   ///< of a window [s]

    /// For checkpoints.
    struct State {
        std::optional<FlowMark> begin, last, before;   ///< last, before: ends of the last two whole windows
        double end = 0, change_percent = 100;
        bool is_settled = false;
    };
    const State& state() const { return state_; }
    void restore(const State& state) { state_ = state; }

private:
    void close_window(const Scene& scene, const FlowMark& now);

    double length_ = 0, averaging_ = 0, start_ = 0;
    std::vector<double> exact_times_;
    State state_;
};

}   // namespace patency
