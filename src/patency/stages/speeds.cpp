// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/speeds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/stages/lumen_of_case.h"

namespace patency {

namespace {

constexpr int samples = 400;              // of a waveform: its largest value to a part in 10^4
constexpr double mach = 0.1;              // largest speed over sound speed: density within 1 %
constexpr double density_change = 0.01;   // by pressure
constexpr double pulse_number = 0.1;      // omega L / c

/// The smallest and the largest value of f over the run or a period.
template <class F>
std::pair<double, double> range_of(const deck::Case& config, F f) {
    const double span =
        config.about.period ? std::min(*config.about.period, config.numerics.duration) : config.numerics.duration;
    double low = f(0.0), high = low;
    for (int k = 1; k <= samples; ++k) {
        const double value = f(span * k / samples);
        low = std::min(low, value), high = std::max(high, value);
    }
    return {low, high};
}

/// The speed on the axis that a gradient G [Pa/m] drives in the steady state, through the narrowest width.
double poiseuille_peak(const Lumen& lumen, double gradient, double viscosity) {
    const double a = 0.5 * lumen.narrowest;
    return gradient * a * a / ((lumen.planar ? 2 : 4) * viscosity);
}

double length_of(const Lumen& lumen) {
    double length = 0;
    for (const Opening& a : lumen.openings)
        for (const Opening& b : lumen.openings) length = std::max(length, norm(a.centre - b.centre));
    return length > 0 ? length : norm(lumen.bounds.high - lumen.bounds.low);
}

/// Poiseuille's loss of a flow [Pa] that is so fast on the axis at the narrowest place.
double viscous_loss(const Lumen& lumen, double flow, double speed, double viscosity) {
    if (lumen.passage.drag > 0) return 8 * std::numbers::pi * viscosity * flow * lumen.passage.drag;
    const double a = 0.5 * lumen.narrowest;   // as narrow all along
    return speed * (lumen.planar ? 2 : 4) * viscosity / (a * a) * length_of(lumen);
}

/// What resistances let out at most of a vessel at one pressure [m^3/s]: infinite if blood can go past them.
double flow_through_resistances(std::span<const EndLaw> laws, double pressure) {
    double flow = 0;
    for (const EndLaw& law : laws) {
        if (!law.outlet) continue;
        const auto* r = std::get_if<Resistance>(&*law.outlet);
        if (!r || !(r->resistance > 0)) return Bounds::infinity;
        flow += std::max(0.0, pressure - r->distal_pressure) / r->resistance;
    }
    return flow;
}

}   // namespace

Expected estimate_expected(const deck::Case& config, const Lumen& lumen, std::span<const EndLaw> laws,
                           const FluidMaterial& material) {
    const double rho = material.density, mu = material.viscosity, length = length_of(lumen);
    const Passage& passage = lumen.passage;
    Expected expected;

    double inflow = 0, largest_peak = 0, resistance = 0;
    bool is_driven_by_flow = false;
    for (std::size_t k = 0; k < laws.size(); ++k) {
        if (!laws[k].prescribes_flow()) continue;
        const auto [low, high] = range_of(config, laws[k].signal);
        const double flow = std::max(-low, high);
        is_driven_by_flow |= flow > 0;
        inflow += flow;
        largest_peak = std::max(largest_peak, std::abs(laws[k].peak_to_mean));
        expected.speed = std::max(expected.speed, flow / lumen.openings[k].area * std::abs(laws[k].peak_to_mean));
    }
    expected.outflow = inflow;
    // A developed profile behind a plug, and continuity through the narrowest place.
    const double developed = parabola_profile(lumen.planar ? Section::planar : Section::circular, 0);
    if (is_branching(config.geometry)) expected.speed *= developed / std::max(1.0, std::min(developed, largest_peak));
    const auto speed_of = [&](double flow) {
        return passage.tightest_area > 0 ? flow / passage.tightest_area * std::max(largest_peak, developed) : 0;
    };
    expected.speed = std::max(expected.speed, speed_of(inflow));

    double lowest = Bounds::infinity, highest = -Bounds::infinity, offset = 0, lowest_held = Bounds::infinity;
    for (const EndLaw& law : laws) {
        if (law.prescribes_flow()) continue;
        const auto pressure = [&](double time) {
            if (!law.outlet) return law.signal(time);
            resistance = impedance(*law.outlet, 0).real();
            return law.state[0];
        };
        const auto [low, high] = range_of(config, pressure);
        lowest = std::min(lowest, low), highest = std::max(highest, high);
        if (!law.outlet) lowest_held = std::min(lowest_held, high);
        offset = std::max({offset, std::abs(low), std::abs(high)});
    }
    double driving = highest > lowest ? highest - lowest : 0, flow = inflow;
    // Behind a vessel whose pressures are all alike the beds limit the flow, and it loses little. THEORY.md (15.7)
    bool is_throttled = false;
    if (!is_driven_by_flow) {
        const double gradient = driving / length + rho * norm(config.body_force);
        const double bernoulli = std::sqrt(2 * gradient * length / rho);
        if (passage.drag > 0) {
            const double let_out = lowest_held < highest ? Bounds::infinity : flow_through_resistances(laws, highest);
            flow = std::min(let_out, gradient * length / (8 * std::numbers::pi * mu * passage.drag));
            is_throttled = flow == let_out;
            expected.speed = std::max(expected.speed, std::min(speed_of(flow), bernoulli));
        } else {
            expected.speed = std::max(expected.speed, std::min(poiseuille_peak(lumen, gradient, mu), bernoulli));
        }
    }
    for (const auto& [name, velocity] : config.wall.velocity) expected.speed = std::max(expected.speed, norm(velocity));
    if (config.initial.speed) {
        const bool is_parabola = config.initial_velocity() == deck::InitialVelocity::parabola;
        expected.speed = std::max(expected.speed, std::abs(*config.initial.speed) * (is_parabola ? developed : 1.0));
    }
    if (config.numerics.reference_speed) expected.speed = *config.numerics.reference_speed;
    if (!(expected.speed > 0))
        throw DeckError(
            "numerics.reference_speed: nothing in the deck moves the blood, so no speed can be estimated; give one");

    // What flows loses pressure: the dynamic one and Poiseuille's.
    const double dynamic = 0.5 * rho * expected.speed * expected.speed;
    double loss = dynamic + (is_driven_by_flow || is_throttled ? viscous_loss(lumen, flow, expected.speed, mu) : 0);
    if (is_throttled) loss = std::min(loss, driving + dynamic), driving = 0;
    const bool is_fixed = config.numerics.pressure_reference == deck::PressureReference::fixed;
    expected.pressure_range = std::max(driving, is_fixed ? offset + resistance * inflow : 0.0) + loss;
    return expected;
}

void expect_estimate(Expected& expected, const deck::Case& config, const EstimatedField& field,
                     std::span<const EndLaw> laws, const FluidMaterial& material) {
    double pulse = 1;   // largest over mean of what drives
    for (const EndLaw& law : laws) {
        const double mean = law.signal.waveform.mean();
        if (law.outlet || !(std::abs(mean) > 0)) continue;
        const auto [low, high] = range_of(config, law.signal);
        pulse = std::max(pulse, std::max(-low, high) / std::abs(mean));
    }
    if (!config.numerics.reference_speed) expected.speed = pulse * field.largest_speed();
    expected.pressure_range =
        pulse * pulse * field.pressure_range() + 0.5 * material.density * expected.speed * expected.speed;
}

double choose_sound_speed(const deck::Case& config, const Lumen& lumen, const Expected& expected,
                          const FluidMaterial& material) {
    const deck::Numerics& numerics = config.numerics;
    if (numerics.sound_speed) return *numerics.sound_speed;
    if (numerics.sound_speed_factor) return *numerics.sound_speed_factor * expected.speed;
    double c =
        std::max(expected.speed / mach, std::sqrt(expected.pressure_range / (density_change * material.density)));
    if (config.about.period)
        c = std::max(c, 2 * std::numbers::pi / *config.about.period * length_of(lumen) / pulse_number);
    return c;
}

}   // namespace patency
