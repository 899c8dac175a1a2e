// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow_window.h"

#include <algorithm>
#include <cmath>

namespace patency {

namespace {

// Windows of a steady flow, per time that the blood needs to pass the lumen: longer than sound needs to swing to and fro, shorter
// than a start from the estimate. With particles they slide on by halves, and the two that agree are those of the results' means.
constexpr double windows_per_passage = 8;
constexpr int averaged_windows = 2;
constexpr int parts_of_window = FlowWindow::parts_of_block * FlowWindow::blocks / averaged_windows;
constexpr double most_uncertain = 4;   // in tolerances
// A flow that swings stands still where it turns: two comparisons that share no part must be quiet, unless an end lets sound out.
constexpr int quiet_in_a_row = 2, quiet_while_sliding = 3;

bool is_steady(const Scene& scene) { return scene.config.about.mode == deck::Mode::steady; }
/// Parts of a period differ by its form and tell nothing.
int parts_of(const Scene& scene) { return is_steady(scene) ? parts_of_window : 1; }

/// Whether the means are those of the windows that agreed. A pulse has its form and a jet on cells its swings: what they are averaged
/// over begins when they have settled.
bool does_slide(const Scene& scene) {
    return scene.config.numerics.convergence && is_steady(scene) && scene.config.scheme() != deck::SchemeName::cells;
}

int quiet_needed(const Scene& scene) {
    if (is_driven_by_pulse(scene.config))
        return 1;   // beds begin in the beat that they repeat: nothing slow is left in them
    if (!does_slide(scene)) return quiet_in_a_row;
    const bool is_sound_let_out =
        std::any_of(scene.ends.begin(), scene.ends.end(), [](const OpenEnd& end) { return end.absorber.is_there(); });
    return is_sound_let_out ? 1 : quiet_while_sliding;
}

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
    add(std::abs(mean_between(marks[count], marks[2 * count], 0, 1).pressure - datum),
        [&](std::size_t p) { return part(p, 0).pressure; });
    return result;
}

double probable_end(const Scene& scene) {
    const deck::Case& config = scene.config;
    if (!does_slide(scene)) return config.numerics.duration;
    // Windows until two agreed, of eight flows: 2.5 to 3.5 from the flow on cells, 2.5 from the estimate, 7.5 and 8 from rest.
    const auto start = config.initial_velocity();
    const double windows = start == deck::InitialVelocity::cells || start == deck::InitialVelocity::estimate ? 3 : 8;
    return std::min(windows * window_length(scene), config.numerics.duration);
}

FlowWindow::FlowWindow(const Scene& scene) : length_(window_length(scene)), slides_(does_slide(scene)) {
    const double duration = scene.config.numerics.duration;
    state_.end = duration;
    averaging_ = (is_steady(scene) ? averaged_windows : 1) * length_;
    start_ = slides_ ? duration : is_watched() ? duration - averaging_ : window_start(scene.config);
    exact_times_.push_back(start_);
    if (is_watched()) {
        state_.marks.push_back(mark_flow(scene));
        const double part = length_ / parts_of(scene);
        for (double n = 1; n * part < duration; ++n) exact_times_.push_back(n * part);
    }
    if (start_ <= 0) state_.begin = mark_flow(scene);
    std::sort(exact_times_.begin(), exact_times_.end());
}

bool FlowWindow::observe(const Scene& scene) {
    if (state_.begin) return false;
    const std::size_t parts = std::size_t(parts_of(scene)), step = slides_ ? parts_of_block : parts;
    const bool is_part = is_watched() && scene.time >= state_.marks.back().time + length_ / double(parts) * (1 - 1e-9);
    if (is_part) state_.marks.push_back(mark_flow(scene));
    const bool is_full = state_.marks.size() == 2 * parts + 1;
    if (is_part && is_full) compare_windows(scene);
    if (!state_.begin && scene.time >= start_)
        state_.begin = slides_ ? state_.marks.front() : mark_flow(scene);   // the last chance
    if (state_.begin) return false;
    if (is_full) state_.marks.erase(state_.marks.begin(), state_.marks.begin() + std::ptrdiff_t(step));
    return is_part && slides_ && (state_.marks.size() - 1) % step == 0;
}

void FlowWindow::compare_windows(const Scene& scene) {
    const WindowChange change = change_of_windows(state_.marks, parts_of(scene),
                                                  scene.config.numerics.convergence->tolerance_percent, scene.datum);
    state_.change_percent = change.change;
    state_.quiet_windows = change.excess <= 0 ? state_.quiet_windows + 1 : 0;
    state_.is_settled = state_.quiet_windows >= quiet_needed(scene);
    if (state_.is_settled) {
        state_.begin = slides_ ? state_.marks.front() : state_.marks.back();
        state_.end = slides_ ? scene.time : std::min(scene.time + averaging_, scene.config.numerics.duration);
    }
}

}   // namespace patency
