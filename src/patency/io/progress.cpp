// SPDX-License-Identifier: Apache-2.0
#include "patency/io/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace patency {
namespace {

constexpr double ml_per_min = 1e-6 / 60;   // m^3/s

double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}   // namespace

std::string duration_text(double seconds) {
    const auto s = std::int64_t(std::llround(std::clamp(seconds, 0.0, 1e9)));   // thirty years are "long" enough
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
    return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

std::string progress_text(const ProgressState& state, std::optional<double> seconds_left) {
    // Rounded down: 100 % is said when it is done.
    const int percent = int(std::floor(100 * std::clamp(state.fraction, 0.0, 1.0)));
    std::string text = fmt::format("{}: {:3} %  t {:.4g} s  step {}", state.stage, percent, state.time, state.step);
    if (state.net_inflow) text += fmt::format("  in-out {:+.3g} mL/min", *state.net_inflow / ml_per_min);
    if (seconds_left) text += fmt::format("  left {}", duration_text(*seconds_left));
    return text;
}

Progress::Progress(Sink sink, ProgressOptions options) : sink_(std::move(sink)), options_(std::move(options)) {
    if (!options_.clock) options_.clock = steady_seconds;
}

void Progress::update(const ProgressState& state) {
    if (!sink_) return;
    const double now = options_.clock();
    if (!start_ || start_->stage != state.stage)
        start_ = Mark{std::string(state.stage), state.fraction, now};
    else if (now < next_)
        return;
    say(state, now);
}

void Progress::finish(const ProgressState& state) {
    if (!sink_) return;
    say(state, options_.clock());
    if (options_.style == ProgressStyle::terminal) sink_("\n");
    start_.reset();
}

void Progress::say(const ProgressState& state, double now) {
    next_ = now + options_.interval;
    std::optional<double> left;
    if (start_ && state.fraction > start_->fraction && state.fraction < 1)
        left = (now - start_->clock) * (1 - state.fraction) / (state.fraction - start_->fraction);
    std::string text = progress_text(state, left);
    if (options_.width > 0 && text.size() >= options_.width) text.resize(options_.width - 1);
    // \r: to the line's beginning; ESC [K: clear what a longer text left behind
    sink_(options_.style == ProgressStyle::terminal ? "\r" + text + "\x1b[K" : text + "\n");
}

}   // namespace patency
