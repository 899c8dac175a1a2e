// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/developed_flow.h"

#include <algorithm>
#include <cmath>

namespace patency {

namespace {

// Rings of a section: its parabola is off by 1 / rings^2, and Stokes' layer at a Womersley number of 10 is ten rings wide.
constexpr std::size_t rings = 128;
constexpr double width = 1.0 / rings;

double middle(std::size_t i) { return (double(i) + 0.5) * width; }
/// Of the edge at s, over that of the whole section's measure.
double edge(Section section, double s) { return section == Section::circular ? s : 1; }

}   // namespace

TimeRate TimeRate::of_steps(double dt, double dt_before) {
    if (dt_before == 0) return {1 / dt, -1 / dt, 0};
    const double r = dt / dt_before;
    return {(1 + 2 * r) / ((1 + r) * dt), -(1 + r) / dt, r * r / ((1 + r) * dt)};
}

DevelopedFlow::DevelopedFlow(Section section, double radius, double viscosity)
    : section_(section), diffusion_(viscosity / (radius * radius)), last_(rings, 0), before_(rings, 0) {
    begin_step({});
}

std::vector<double> DevelopedFlow::solve(double rate, std::vector<double> right) const {
    // (s u')' / s over rings; at the wall the slope of the parabola through the last two middles and zero.
    std::vector<double> upper(rings);
    for (std::size_t i = 0; i < rings; ++i) {
        const double to_rate = diffusion_ / (width * width * edge(section_, middle(i)));
        const double inner = i > 0 ? to_rate * edge(section_, double(i) * width) : 0;
        const double outer = to_rate * edge(section_, double(i + 1) * width);
        double own = rate + inner, next = -outer, last = -inner;
        if (i + 1 < rings)
            own += outer;
        else
            own += 3 * outer, last -= outer / 3, next = 0;
        if (i > 0) own -= last * upper[i - 1], right[i] -= last * right[i - 1];
        upper[i] = next / own;
        right[i] /= own;
    }
    for (std::size_t i = rings - 1; i-- > 0;) right[i] -= upper[i] * right[i + 1];
    return right;
}

double DevelopedFlow::mean(const std::vector<double>& values) const {
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < rings; ++i)
        sum += edge(section_, middle(i)) * values[i], all += edge(section_, middle(i));
    return sum / all;
}

void DevelopedFlow::begin_step(const TimeRate& rate) {
    unit_ = solve(rate.now, std::vector<double>(rings, 1));
    const double of_unit = mean(unit_);
    for (double& u : unit_) u /= of_unit;
    std::vector<double> pushed(rings);
    for (std::size_t i = 0; i < rings; ++i) pushed[i] = -(rate.last * last_[i] + rate.before * before_[i]);
    rest_ = solve(rate.now, std::move(pushed));
    const double carried = mean(rest_);
    for (std::size_t i = 0; i < rings; ++i) rest_[i] -= carried * unit_[i];
}

void DevelopedFlow::end_step(double mean_speed) {
    before_ = last_;
    for (std::size_t i = 0; i < rings; ++i) last_[i] = rest_[i] + mean_speed * unit_[i];
}

void DevelopedFlow::start_from(std::span<const double> places, std::span<const double> speeds, double reach) {
    // The distance from the wall times a smooth field, which a mean over places on one side of it finds.
    for (std::size_t i = 0; i < rings; ++i) {
        const double s = middle(i);
        double sum = 0, weights = 0, nearest = INFINITY, there = 0;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double q = std::abs(places[k] - s) / reach,
                         field = speeds[k] / std::max(1 - places[k] * places[k], 1e-3);
            if (q < 1) sum += (1 - q) * (1 - q) * field, weights += (1 - q) * (1 - q);
            if (q < nearest) nearest = q, there = field;
        }
        last_[i] = (1 - s * s) * (weights > 0 ? sum / weights : there);
    }
    before_ = last_;
}

std::vector<double> DevelopedFlow::state() const {
    std::vector<double> state = last_;
    state.insert(state.end(), before_.begin(), before_.end());
    return state;
}

void DevelopedFlow::restore(std::span<const double> state) {
    std::copy_n(state.begin(), rings, last_.begin());
    std::copy_n(state.begin() + std::ptrdiff_t(rings), rings, before_.begin());
}

double DevelopedFlow::at(const std::vector<double>& values, double s) const {
    if (s >= 1) return 0;
    const double place = s / width - 0.5;
    if (place <= 0) return values.front();
    const auto i = std::min(std::size_t(place), rings - 1);
    const double share = place - double(i);
    if (i + 1 < rings) return values[i] + share * (values[i + 1] - values[i]);
    return values[i] * (1 - 2 * share);   // half a ring to the wall
}

}   // namespace patency
