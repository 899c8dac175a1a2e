// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow_window.h"

#include <algorithm>
#include <cmath>

namespace patency {

namespace {

// Windows of a steady flow, per time that the blood needs to pass the lumen: longer than sound needs to swing to and fro, shorter
// than a start from the estimate. The means of its results are taken over more of them, the swings of sound being what is left.
constexpr double windows_per_passage = 8, averaged_windows = 2;
constexpr int parts_of_window = 4;
constexpr int quiet_in_a_row = 2;          // a flow that swings stands still where it turns
constexpr double most_uncertain = 4;       // in tolerances

bool is_steady(const Scene& scene) { return scene.config.about.mode == deck::Mode::steady; }
/// Parts of a period differ by its form and tell nothing.
int parts_of(const Scene& scene) { return is_steady(scene) ? parts_of_window : 1; }

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

/// Mean and its standard error of some numbers; of one number there is no error.
struct Uncertain {
    double mean = 0, error = 0;
};
Uncertain mean_of(const std::vector<double>& values) {
    Uncertain result;
    const double n = double(values.size());
    for (double v : values) result.mean += v / n;
    double squares = 0;
    for (double v : values) squares += (v - result.mean) * (v - result.mean);
    if (n > 1) result.error = std::sqrt(squares / (n - 1) / n);
    return result;
}

}   // namespace

WindowChange change_of_windows(const std::vector<FlowMark>& marks, int parts, double tolerance, double datum) {
    const std::size_t openings = marks.front().volume_out.size(), count = std::size_t(parts);
    const auto part = [&](std::size_t p, std::size_t k) { return mean_between(marks[p], marks[p + 1], k, 1); };
    WindowChange result{0, -INFINITY};
    const auto add = [&](double scale, auto value) {   // of a part
        std::vector<double> was, is;
        for (std::size_t p = 0; p < count; ++p) was.push_back(value(p)), is.push_back(value(count + p));
        const Uncertain a = mean_of(was), b = mean_of(is);
        const double change = scale > 0 ? 100 * std::abs(b.mean - a.mean) / scale : 0;
        const double error = scale > 0 ? 100 * 2 * std::hypot(a.error, b.error) / scale : 0;
        result.change = std::max(result.change, change);
        result.excess = std::max(result.excess, change - std::clamp(error, tolerance, most_uncertain * tolerance));
    };
    double inflow = 0, low = INFINITY, high = -INFINITY;
    for (std::size_t k = 0; k < openings; ++k) {
        const OpeningMean mean = mean_between(marks[count], marks[2 * count], k, 1);
        inflow += std::max(0.0, -mean.flow);
        low = std::min(low, mean.pressure), high = std::max(high, mean.pressure);
    }
    for (std::size_t k = 0; k < openings; ++k) {
        add(inflow, [&](std::size_t p) { return part(p, k).flow; });
        add(high - low, [&](std::size_t p) { return part(p, k).pressure - part(p, 0).pressure; });
    }
    add(std::abs(mean_between(marks[count], marks[2 * count], 0, 1).pressure - datum), [&](std::size_t p) { return part(p, 0).pressure; });
    return result;
}

FlowWindow::FlowWindow(const Scene& scene) : length_(window_length(scene)) {
    const double duration = scene.config.numerics.duration;
    state_.end = duration;
    averaging_ = (is_steady(scene) ? averaged_windows : 1) * length_;
    start_ = is_watched() ? duration - averaging_ : window_start(scene.config);
    exact_times_.push_back(start_);
    if (is_watched()) {
        state_.marks.push_back(mark_flow(scene));
        const double part = length_ / parts_of(scene);
        for (double n = 1; n * part < duration; ++n) exact_times_.push_back(n * part);
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
    const int parts = parts_of(scene);
    if (!is_watched() || scene.time < state_.marks.back().time + length_ / parts * (1 - 1e-9)) return;
    state_.marks.push_back(mark_flow(scene));
    if (int(state_.marks.size()) == 2 * parts + 1) compare_windows(scene);
}

void FlowWindow::compare_windows(const Scene& scene) {
    const int parts = parts_of(scene);
    const WindowChange change = change_of_windows(state_.marks, parts, scene.config.numerics.convergence->tolerance_percent, scene.datum);
    state_.change_percent = change.change;
    state_.quiet_windows = change.excess <= 0 ? state_.quiet_windows + 1 : 0;
    state_.is_settled = state_.quiet_windows >= quiet_in_a_row;
    if (state_.is_settled) {
        state_.begin = state_.marks.back();
        state_.end = std::min(scene.time + averaging_, scene.config.numerics.duration);
    }
    state_.marks.erase(state_.marks.begin(), state_.marks.begin() + parts);
}

}   // namespace patency
