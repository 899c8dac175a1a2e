// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_pace.h"

#include <algorithm>
#include <cmath>

#include "patency/analysis/stent_metrics.h"

namespace patency {

namespace {

constexpr double wanted_ratio = 0.9 * most_kinetic_to_internal;
constexpr double most_change = 1.1;   // at a time: hardly more than a ramp's own speed changes where it sets out

}   // namespace

DeployPace::DeployPace(double change, double slowing) : change_(change), slowest_(1 / slowing) {}

double DeployPace::rate(double time) const {
    return from_ + (to_ - from_) * std::clamp((time - since_) / change_, 0.0, 1.0);
}

double DeployPace::lag(double time) const {
    const double passed = time - since_, changing = std::clamp(passed, 0.0, change_), changed = passed - changing;
    const double mean = from_ + (to_ - from_) * changing / (2 * change_);
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

void DeployPace::heed(double time, double ratio) {
    // An energy of motion goes with the square of the speed.
    change_to(time, ratio > 0 ? rate(time) * std::sqrt(wanted_ratio / ratio) : 1.0);
}

void DeployPace::change_to(double time, double wanted) {
    const double now = rate(time);
    lag_ = lag(time);
    since_ = time;
    from_ = now;
    to_ = std::clamp(std::clamp(wanted, now / most_change, now * most_change), slowest_, 1.0);
    least_ = std::min(least_, to_);
}

}   // namespace patency
