// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_pace.h"

#include <algorithm>
#include <cmath>

#include "patency/analysis/stent_metrics.h"

namespace patency {

namespace {

constexpr double wanted_ratio = 0.8 * most_kinetic_to_internal;   // on average: it swings
constexpr double feared_ratio = 2 * most_kinetic_to_internal;     // at full rate, of what is not known yet
constexpr double looks_remembered = 20;                           // longer than a swing takes
constexpr double most_change = 1.03;   // from look to look: a tool that brakes harder is left

}   // namespace

DeployPace::DeployPace(double between_looks, double slowing)
    : between_(between_looks), slowest_(1 / slowing), at_full_rate_(feared_ratio) {}

double DeployPace::rate(double time) const {
    return from_ + (to_ - from_) * std::clamp((time - since_) / between_, 0.0, 1.0);
}

double DeployPace::lag(double time) const {
    const double passed = time - since_, changing = std::clamp(passed, 0.0, between_), changed = passed - changing;
    const double mean = from_ + (to_ - from_) * changing / (2 * between_);
    return lag_ + (1 - mean) * changing + (1 - (passed < 0 ? from_ : to_)) * changed;
}

double DeployPace::time_of(double program) const {
    double time = program + lag_;
    constexpr int most_steps = 50;   // of Newton's method, on what is a parabola between two straight lines
    for (int k = 0; k < most_steps; ++k) {
        const double missing = program - this->program(time);
        if (std::abs(missing) <= 1e-15 * std::abs(program)) break;
        time += missing / rate(time);
    }
    return time;
}

double DeployPace::allowed() const {
    // An energy of motion goes with the square of the speed.
    return at_full_rate_ > 0 ? std::clamp(std::sqrt(wanted_ratio / at_full_rate_), slowest_, 1.0) : 1.0;
}

void DeployPace::set_out(double time) { change(time, allowed(), allowed()); }

void DeployPace::heed(double time, double ratio) {
    const double now = rate(time);
    at_full_rate_ += (ratio / (now * now) - at_full_rate_) / looks_remembered;
    change(time, now, std::clamp(allowed(), now / most_change, now * most_change));
}

void DeployPace::skip_to(double time, double program) {
    const double now = rate(time);
    change(time, now, now);
    lag_ = time - program;
}

void DeployPace::rest(double time) { change(time, 1, 1); }

void DeployPace::change(double time, double from, double to) {
    lag_ = lag(time);
    since_ = time;
    from_ = from;
    to_ = to;
    least_ = std::min({least_, from, to});
}

}   // namespace patency
