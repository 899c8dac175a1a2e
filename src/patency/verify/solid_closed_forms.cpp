// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/solid_closed_forms.h"

#include <array>
#include <cmath>
#include <numbers>

namespace patency {

namespace {

using std::numbers::pi;

/// One Runge-Kutta step of y' = f(x, y).
template <std::size_t n, class Slope>
std::array<double, n> runge_kutta(const std::array<double, n>& y, double x, double h, const Slope& f) {
    const auto moved = [&](const std::array<double, n>& k, double by) {
        std::array<double, n> z = y;
        for (std::size_t i = 0; i < n; ++i) z[i] += by * k[i];
        return z;
    };
    const auto k1 = f(x, y), k2 = f(x + h / 2, moved(k1, h / 2)), k3 = f(x + h / 2, moved(k2, h / 2)),
               k4 = f(x + h, moved(k3, h));
    std::array<double, n> z = y;
    for (std::size_t i = 0; i < n; ++i) z[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return z;
}

/// The root of a function with a sign change between low and high.
template <class F>
double bisect(double low, double high, const F& f) {
    const bool is_rising = f(high) > 0;
    for (int k = 0; k < 200 && high - low > 1e-15 * std::abs(high); ++k) {
        const double middle = 0.5 * (low + high);
        ((f(middle) > 0) == is_rising ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

constexpr int steps = 400;

struct Beam {
    double EI, kGA, rhoA, rhoI;   // per metre of depth
};
Beam beam_of(const Cantilever& c) {
    const double E = c.moduli.young() / (1 - c.moduli.poisson() * c.moduli.poisson());
    const double nu = c.moduli.poisson() / (1 - c.moduli.poisson());   // of plane strain told as plane stress
    const double shear_share = 10 * (1 + nu) / (12 + 11 * nu);         // Cowper 1966, rectangle
    const double I = c.height * c.height * c.height / 12;
    return {E * I, shear_share * c.moduli.shear * c.height, c.density * c.height, c.density * I};
}

/// Deflection, turn, moment, shear force from the clamp to the tip, for a moment and a force there.
using State = std::array<double, 4>;
State march(const Beam& b, double length, double omega, double moment, double force, double until) {
    State y{0, 0, moment, force};
    const double w2 = omega * omega, h = length / steps;
    const auto slope = [&](double, const State& s) {
        return State{s[3] / b.kGA + s[1], s[2] / b.EI, -s[3] - b.rhoI * w2 * s[1], -b.rhoA * w2 * s[0]};
    };
    for (int k = 0; k < steps && k * h < until * (1 - 1e-12); ++k)
        y = runge_kutta(y, 0, std::min(h, until - k * h), slope);
    return y;
}

double end_determinant(const Beam& b, double length, double omega) {
    const State m = march(b, length, omega, 1, 0, length), f = march(b, length, omega, 0, 1, length);
    return m[2] * f[3] - m[3] * f[2];
}

struct Pull {
    double radial, around;   // first Piola-Kirchhoff, per stretch pair
};
Pull pull(const NeoHookean& law, double lr, double lt) {
    const double J = lr * lt, v = 0.5 * law.lame * (J * J - 1);
    return {law.shear * (lr - 1 / lr) + v / lr, law.shear * (lt - 1 / lt) + v / lt};
}

/// r and r' at the outer radius, from those at the inner.
std::array<double, 2> integrate_tube(const RubberTube& tube, double a, double slope_a) {
    std::array<double, 2> y{a, slope_a};
    const double h = (tube.outer - tube.inner) / steps;
    const auto slope = [&](double R, const std::array<double, 2>& s) {
        const double lt = s[0] / R, lr = s[1], G = tube.law.shear, L = tube.law.lame;
        const Pull p = pull(tube.law, lr, lt);
        const double by_lr = G * (1 + 1 / (lr * lr)) + 0.5 * L * (lt * lt + 1 / (lr * lr)), by_lt = L * lr * lt;
        return std::array<double, 2>{lr, ((p.around - p.radial) / R - by_lt * (lr - lt) / R) / by_lr};
    };
    for (int k = 0; k < steps; ++k) y = runge_kutta(y, tube.inner + k * h, h, slope);
    return y;
}

}   // namespace

double cantilever_frequency(const Cantilever& beam) {
    const Beam b = beam_of(beam);
    const double slender = 3.5160 / (beam.length * beam.length) * std::sqrt(b.EI / b.rhoA);   // Euler and Bernoulli's
    return bisect(0.3 * slender, 1.05 * slender, [&](double w) { return end_determinant(b, beam.length, w); });
}

double cantilever_shape(const Cantilever& beam, double x) {
    const Beam b = beam_of(beam);
    const double w = cantilever_frequency(beam);
    const State m = march(b, beam.length, w, 1, 0, beam.length), f = march(b, beam.length, w, 0, 1, beam.length);
    const double force = -m[2] / f[2];
    return march(b, beam.length, w, 1, force, x)[0] / march(b, beam.length, w, 1, force, beam.length)[0];
}

double tube_pressure(const RubberTube& tube, double a) {
    const double lt = a / tube.inner;
    const auto outer_stress = [&](double lr) {
        const auto y = integrate_tube(tube, a, lr);
        return pull(tube.law, y[1], y[0] / tube.outer).radial;
    };
    const double lr = bisect(0.5 / lt, 1.2 / lt, outer_stress);
    return -pull(tube.law, lr, lt).radial / lt;
}

double tube_radius(const RubberTube& tube, double pressure) {
    return bisect(tube.inner, 2 * tube.inner, [&](double a) { return tube_pressure(tube, a) - pressure; });
}

TubeStress lame_stress(double inner, double outer, double pressure, double r) {
    const double scale = pressure * inner * inner / (outer * outer - inner * inner), q = outer * outer / (r * r);
    return {scale * (1 - q), scale * (1 + q)};
}

double collapse_pressure(double inner, double outer, double yield) {
    return 2 / std::sqrt(3.0) * yield * std::log(outer / inner);
}

double plastic_radius(double inner, double outer, double yield, double pressure) {
    const double k = 2 / std::sqrt(3.0) * yield;
    return bisect(inner, outer,
                  [&](double c) { return k * (std::log(c / inner) + 0.5 * (1 - c * c / (outer * outer))) - pressure; });
}

TubeStress residual_stress(double inner, double outer, double yield, double pressure, double r) {
    const double k = 2 / std::sqrt(3.0) * yield, c = plastic_radius(inner, outer, yield, pressure);
    TubeStress loaded;
    if (r < c) {
        const double s = std::log(c / r) + 0.5 * (1 - c * c / (outer * outer));
        loaded = {-k * s, k * (1 - s)};
    } else {
        const double q = 0.5 * k * c * c / (outer * outer);
        loaded = {q * (1 - outer * outer / (r * r)), q * (1 + outer * outer / (r * r))};
    }
    const TubeStress back = lame_stress(inner, outer, pressure, r);
    return {loaded.radial - back.radial, loaded.hoop - back.hoop};
}

double contact_modulus(const ElasticModuli& a, const ElasticModuli& b) {
    const auto softness = [](const ElasticModuli& m) { return (1 - m.poisson() * m.poisson()) / m.young(); };
    return 1 / (softness(a) + softness(b));
}
double HertzLine::half_width(double load) const { return std::sqrt(4 * load * radius / (pi * modulus)); }
double HertzLine::peak_pressure(double load) const { return std::sqrt(load * modulus / (pi * radius)); }
double hertz_force(double radius, double modulus, double approach) {
    return 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(approach, 1.5);
}

double hertz_sinking(double radius, double modulus, double force, double young, double poisson, double depth) {
    const double a = std::cbrt(0.75 * force * radius / modulus), p0 = 1.5 * force / (pi * a * a);
    constexpr int parts = 1000;   // over the angle whose sine is t: smooth at depth 0 too
    double sum = 0;
    for (int k = 0; k < parts; ++k) {
        const double angle = (k + 0.5) / parts * pi / 2, t = std::sin(angle), r = a * std::cos(angle),
                     square = r * r + depth * depth;
        sum += pi / (2 * parts) * std::cos(angle) * t * t * (2 * (1 - poisson) + depth * depth / square) /
               std::sqrt(square);
    }
    return (1 + poisson) / young * p0 * a * a * sum;
}

}   // namespace patency
