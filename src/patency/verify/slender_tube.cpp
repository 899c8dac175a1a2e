// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/slender_tube.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "patency/base/errors.h"

namespace patency {

namespace {

using std::numbers::pi;
using Numbers = std::vector<double>;

constexpr int most_rounds = 200;
constexpr double enough = 1e-12;   // of the velocity, between two rounds

/// Profiles over y = (r / R)^2 at the middles of rings of equal area, w = pi R^2 u / Q; q: its integral up to each middle.
class March {
public:
    explicit March(int rings) : n_(std::size_t(rings)), h_(1.0 / rings), w_(n_), q_(n_) {
        for (std::size_t j = 0; j < n_; ++j) w_[j] = 2 * (1 - middle(j));
        integrate(w_, q_);
        before_ = w_, before_q_ = q_;
    }

    /// One step of dt on, second order from the second step on; widening: d ln R / dt at its end. Returns the pressure's slope G.
    double step(double dt, double widening) {
        const double a = steps_ == 0 ? 1 : 1.5;
        Numbers w = w_, q = q_, rest(n_), rest_q(n_);   // what the time derivative has of the last two steps
        for (std::size_t j = 0; j < n_; ++j) {
            rest[j] = steps_ == 0 ? -w_[j] : -2 * w_[j] + 0.5 * before_[j];
            rest_q[j] = steps_ == 0 ? -q_[j] : -2 * q_[j] + 0.5 * before_q_[j];
        }
        double slope = 0;
        for (int round = 0;; ++round) {
            if (round == most_rounds) throw DivergedError("the flow through the slender tube runs backwards");
            slope = solve(w, q, rest, rest_q, a, dt, widening);
            double change = 0;
            for (std::size_t j = 0; j < n_; ++j) change = std::max(change, std::abs(next_[j] - w[j]));
            w = next_;
            integrate(w, q);
            if (change < enough) break;
        }
        before_ = w_, before_q_ = q_, w_ = w, q_ = q;
        ++steps_;
        return slope;
    }

private:
    double middle(std::size_t j) const { return (double(j) + 0.5) * h_; }

    void integrate(const Numbers& w, Numbers& q) const {
        double sum = 0;
        for (std::size_t j = 0; j < n_; ++j) q[j] = sum + 0.5 * h_ * w[j], sum += h_ * w[j];
    }

    /// One round with the coefficients of the last one: w = base + G by_slope carries the flow.        THEORY (12.11)
    double solve(const Numbers& w, const Numbers& q, const Numbers& rest, const Numbers& rest_q, double a, double dt,
                 double widening) {
        Numbers lower(n_), diagonal(n_), upper(n_), base(n_), by_slope(n_, 1.0);
        for (std::size_t j = 0; j < n_; ++j) {
            const double inner = double(j) * h_, outer = inner + h_, rise = (a * q[j] + rest_q[j]) / dt;   // q_t
            const double in = inner / (h_ * h_), out = outer / (h_ * h_);
            // The last ring's outer side is the wall: a parabola through its zero there and the last two rings.
            const bool is_last = j + 1 == n_;
            lower[j] = -in, diagonal[j] = in + out, upper[j] = -out;
            if (is_last) lower[j] = -in - out / 3, diagonal[j] = in + 3 * out, upper[j] = 0;
            const double side = rise / (2 * h_);   // -q_t w_y
            if (is_last)
                lower[j] += 2.0 / 3 * side, diagonal[j] += 2 * side;
            else if (j == 0)
                upper[j] -= 2 * side, diagonal[j] += 2 * side;   // one-sided: q_t itself is small there
            else
                upper[j] -= side, lower[j] += side;
            diagonal[j] += a * w[j] / dt - 2 * widening * w[j];
            base[j] = -w[j] * rest[j] / dt;
        }
        eliminate(lower, diagonal, upper, base, by_slope);
        double carried = 0, more = 0;
        for (std::size_t j = 0; j < n_; ++j) carried += h_ * base[j], more += h_ * by_slope[j];
        const double slope = (1 - carried) / more;
        next_.resize(n_);
        for (std::size_t j = 0; j < n_; ++j) next_[j] = base[j] + slope * by_slope[j];
        return slope;
    }

    static void eliminate(const Numbers& lower, Numbers diagonal, const Numbers& upper, Numbers& x, Numbers& y) {
        const std::size_t n = x.size();
        for (std::size_t j = 1; j < n; ++j) {
            const double m = lower[j] / diagonal[j - 1];
            diagonal[j] -= m * upper[j - 1], x[j] -= m * x[j - 1], y[j] -= m * y[j - 1];
        }
        for (std::size_t j = n; j-- > 0;) {
            const double right_x = j + 1 < n ? upper[j] * x[j + 1] : 0, right_y = j + 1 < n ? upper[j] * y[j + 1] : 0;
            x[j] = (x[j] - right_x) / diagonal[j], y[j] = (y[j] - right_y) / diagonal[j];
        }
    }

    std::size_t n_;
    double h_;
    Numbers w_, q_, before_, before_q_, next_;
    int steps_ = 0;
};

}   // namespace

double slender_tube_pressure_drop(const SlenderTube& tube, double from, double to, const SlenderGrid& grid) {
    const double nu = tube.viscosity / tube.density, unit = 4 * pi * nu / tube.flow;   // t = unit x
    const double dx = tube.length / grid.steps;
    March march(grid.rings);
    const auto pressure_slope = [&](double x, double slope) {
        return 4 * tube.viscosity * tube.flow / pi * slope / std::pow(tube.radius(x), 4);
    };
    double drop = 0, last = 0;
    for (int k = 0; k <= grid.steps; ++k) {
        const double x = k * dx, small = 1e-4 * tube.length;
        const double widening = (std::log(tube.radius(std::min(x + small, tube.length))) -
                                 std::log(tube.radius(std::max(x - small, 0.0)))) /
                                (std::min(x + small, tube.length) - std::max(x - small, 0.0)) / unit;
        // At the inlet as of a profile that has settled, which counts for half a step only.
        const double now =
            k == 0 ? pressure_slope(0, 2 - 4 * widening) : pressure_slope(x, march.step(unit * dx, widening));
        if (k > 0) {   // the trapezoid's part between `from` and `to`
            const double begin = std::clamp(from, x - dx, x), end = std::clamp(to, x - dx, x),
                         s0 = (begin - x) / dx + 1, s1 = (end - x) / dx + 1;
            drop += (s1 - s0) * dx * (last + 0.5 * (s0 + s1) * (now - last));
        }
        last = now;
    }
    return drop;
}

}   // namespace patency
