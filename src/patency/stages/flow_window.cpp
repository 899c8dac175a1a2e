// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow_window.h"

#include <algorithm>
#include <cmath>

namespace patency {

namespace {

// Windows of a steady flow, per time that the blood needs to pass the lumen: longer than sound needs to swing to and fro, shorter
// than a start from the estimate. The means of its results are taken over more of them, the swings of sound being what is left.
constexpr double windows_per_passage = 8, averaged_windows = 2;

bool is_steady(const Scene& scene) { return scene.config.about.mode == deck::Mode::steady; }

double window_length(const Scene& scene) {
    const deck::Case& config = scene.config;
    if (!config.numerics.convergence) return 0;
    if (config.numerics.convergence->window) return *config.numerics.convergence->window;
    if (config.about.period) return *config.about.period;
    double inflow = 0;
    for (const EndLaw& law : scene.laws)
        if (law.prescribes_flow()) inflow += std::max(0.0, law.signal.waveform.mean());
    if (scene.estimate) inflow = std::abs(scene.estimate->opening_flows.front());
    const double passage = inflow > 0 ? scene.lumen.volume / inflow : config.numerics.duration;
    return std::min(passage / windows_per_passage, config.numerics.duration / windows_per_passage);
}

/// The largest change from one window to the next [%]: of an opening's flow, by the inflow; of its pressure beside the first one's,
/// by the range of the openings; and of the first one's own, the level, by itself.
double change_between(const Scene& scene, const FlowMark& before, const FlowMark& middle, const FlowMark& now) {
    double inflow = 0, flow_change = 0, pressure_change = 0, low = INFINITY, high = -INFINITY;
    const OpeningMean first_was = mean_between(before, middle, 0, 1), first_is = mean_between(middle, now, 0, 1);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        const OpeningMean was = mean_between(before, middle, k, scene.ends[k].area);
        const OpeningMean is = mean_between(middle, now, k, scene.ends[k].area);
        inflow += std::max(0.0, -is.flow);
        flow_change = std::max(flow_change, std::abs(is.flow - was.flow));
        pressure_change = std::max(pressure_change, std::abs(is.pressure - first_is.pressure - was.pressure + first_was.pressure));
        low = std::min(low, is.pressure), high = std::max(high, is.pressure);
    }
    const double range = high - low, level = std::abs(first_is.pressure), level_change = std::abs(first_is.pressure - first_was.pressure);
    return 100 * std::max({inflow > 0 ? flow_change / inflow : 1, range > 0 ? pressure_change / range : 0, level > 0 ? level_change / level : 0});
}

}   // namespace

FlowWindow::FlowWindow(const Scene& scene) : length_(window_length(scene)) {
    const double duration = scene.config.numerics.duration;
    state_.end = duration;
    averaging_ = (is_steady(scene) ? averaged_windows : 1) * length_;
    start_ = is_watched() ? duration - averaging_ : window_start(scene.config);
    exact_times_.push_back(start_);
    if (is_watched()) {
        state_.last = mark_flow(scene);
        for (double n = 1; n * length_ < duration; ++n) exact_times_.push_back(n * length_);
    }
    if (start_ <= 0) state_.begin = mark_flow(scene);
    std::sort(exact_times_.begin(), exact_times_.end());
}

void FlowWindow::observe(const Scene& scene) {
    if (state_.begin) return;
    if (scene.time >= start_) {   // the last chance
        state_.begin = mark_flow(scene);
        return;
    }
    if (is_watched() && scene.time >= state_.last->time + length_ * (1 - 1e-9)) close_window(scene, mark_flow(scene));
}

void FlowWindow::close_window(const Scene& scene, const FlowMark& now) {
    if (state_.before) {
        const double last_change = state_.change_percent, tolerance = scene.config.numerics.convergence->tolerance_percent;
        state_.change_percent = change_between(scene, *state_.before, *state_.last, now);
        // Twice in a row: a flow that swings stands still where it turns.
        state_.is_settled = std::max(state_.change_percent, last_change) <= tolerance;
        if (state_.is_settled) {
            state_.begin = now;
            state_.end = std::min(now.time + averaging_, scene.config.numerics.duration);
        }
    }
    state_.before = std::move(state_.last);
    state_.last = now;
}

}   // namespace patency
