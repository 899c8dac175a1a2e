// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/end_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/stages/waveform_of_deck.h"

namespace patency {

namespace {

// Modes of a waveform from a table in Womersley's profile: the 20th harmonic of a heart beat carries no flow.
constexpr std::size_t womersley_modes = 20;

constexpr double least_resistance = 1;   // Pa s/m^3: a billionth of any vessel's

double mean_of_table(const deck::ProfileTable& table, Section section) {
    // Exact for the piecewise linear profile: integral of u(s) 2 s ds (disc) or u(s) ds (gap).
    double sum = 0;
    const auto add = [&](double a, double b, double ua, double ub) {
        if (section == Section::planar)
            sum += 0.5 * (b - a) * (ua + ub);
        else
            sum += (b - a) / 3 * (ua * (2 * a + b) + ub * (a + 2 * b));
    };
    add(0, table.radii.front(), table.speeds.front(), table.speeds.front());
    for (std::size_t k = 1; k < table.radii.size(); ++k)
        add(table.radii[k - 1], table.radii[k], table.speeds[k - 1], table.speeds[k]);
    return sum;
}

double value_of_table(const deck::ProfileTable& table, double s) {
    if (s > table.radii.back()) return 0;
    if (s <= table.radii.front()) return table.speeds.front();
    const std::size_t k =
        std::size_t(std::lower_bound(table.radii.begin(), table.radii.end(), s) - table.radii.begin());
    const double f = (s - table.radii[k - 1]) / (table.radii[k] - table.radii[k - 1]);
    return table.speeds[k - 1] + f * (table.speeds[k] - table.speeds[k - 1]);
}

double peak_to_mean(const deck::Opening& said, Section section) {
    switch (said.profile) {
        case deck::VelocityProfile::plug: return 1;
        case deck::VelocityProfile::table: {
            const auto& speeds = said.profile_table->speeds;
            const double mean = mean_of_table(*said.profile_table, section);
            if (!(std::abs(mean) > 0)) throw DeckError("a profile_table without a mean cannot be scaled to a flow");
            const auto largest = std::max_element(speeds.begin(), speeds.end(),
                                                  [](double a, double b) { return std::abs(a) < std::abs(b); });
            return *largest / mean;
        }
        case deck::VelocityProfile::parabola:
        case deck::VelocityProfile::developed_startup:
        case deck::VelocityProfile::womersley: break;
    }
    return parabola_profile(section, 0);
}

Waveform scaled(const deck::Opening& said, const deck::Case& config, double area, double mean_over_peak) {
    using deck::OpeningType;
    const auto per_case = [&](Dimension dimension, double factor) {
        return make_signal_waveform(*said.waveform, config, dimension, factor);
    };
    switch (said.type) {
        case OpeningType::velocity:
            if (said.waveform) return per_case(Dimension::velocity, area);
            return make_constant(area * (said.velocity ? *said.velocity : *said.peak_velocity * mean_over_peak));
        case OpeningType::flow: return said.waveform ? per_case(Dimension::flow, 1) : make_constant(*said.flow);
        case OpeningType::pressure:
            return said.waveform ? per_case(Dimension::pressure, 1) : make_constant(*said.pressure);
        default: return {};
    }
}

/// (u of the start from rest) / (final peak) in a gap, at s half gaps from the mid-plane and tau = nu t / gap^2.
///                                                                                              THEORY.md (12.2)
double startup_profile(double s, double tau) {
    constexpr double pi = std::numbers::pi, negligible = 45;   // e^-45 = 3e-20
    const double y = 0.5 * (1 - s), decay = pi * pi * tau;
    double sum = 0;
    for (int k = 1; k < 4000 && k * (k * decay) < negligible; k += 2)
        sum += std::sin(k * pi * y) * std::exp(-k * (k * decay)) / (double(k) * k * k);
    return 1 - s * s - 32 / (pi * pi * pi) * sum;
}

/// Its mean over the gap, over the final mean.                                                  THEORY.md (12.2)
double startup_flow(double tau) {
    constexpr double pi = std::numbers::pi, negligible = 45;
    const double decay = pi * pi * tau;
    double sum = 0;
    for (int k = 1; k < 4000 && k * (k * decay) < negligible; k += 2)
        sum += std::exp(-k * (k * decay)) / std::pow(k, 4);
    return 1 - 96 / (pi * pi * pi * pi) * sum;
}

/// Of the start between plates, nu t / gap^2 per second of t.
double startup_rate(const Opening& opening, const deck::Blood& blood) {
    return blood.viscosity / blood.density / (4 * opening.radius * opening.radius);
}

bool has_pulse(const deck::Opening& said) { return said.type == deck::OpeningType::pressure && !said.pressure; }

/// The state that an outlet begins with: of a flow that a pulsing pressure drives the one that repeats, as if the vessel lost nothing;
/// empty else.
OutletState start_of(const OutletModel& outlet, const deck::Case& config) {
    if (!is_driven_by_pulse(config)) return make_steady_state(outlet, 0);
    const auto driving = std::find_if(config.openings.begin(), config.openings.end(),
                                      [](const auto& named) { return has_pulse(named.second); });
    return make_periodic_state(outlet,
                               make_signal_waveform(driving->second.waveform.value(), config, Dimension::pressure, 1),
                               config.about.period.value());
}

}   // namespace

bool is_driven_by_pulse(const deck::Case& config) {
    return config.about.mode == deck::Mode::periodic &&
           std::any_of(config.openings.begin(), config.openings.end(),
                       [](const auto& named) { return has_pulse(named.second); });
}

EndLaw make_end_law(const Opening& opening, const deck::Opening& said, const deck::Case& config) {
    try {
        EndLaw law;
        law.type = said.type;
        if (law.prescribes_flow())
            law.peak_to_mean = peak_to_mean(said, opening.planar ? Section::planar : Section::circular);
        law.signal = {scaled(said, config, opening.area, 1 / law.peak_to_mean), said.ramp};
        if (said.type == deck::OpeningType::resistance)
            law.outlet = Resistance{said.resistance.value(), said.distal_pressure};
        if (said.type == deck::OpeningType::rcr)
            law.outlet = Rcr{said.proximal_resistance, said.compliance, said.distal_resistance, said.distal_pressure};
        if (said.type == deck::OpeningType::coronary)
            law.outlet = Coronary{said.proximal_resistance,
                                  said.compliance,
                                  said.microvascular_resistance,
                                  said.myocardial_compliance,
                                  said.distal_resistance,
                                  said.distal_pressure,
                                  make_signal_waveform(*said.myocardial_pressure, config, Dimension::pressure, 1)};
        if (law.outlet && !(said.type == deck::OpeningType::resistance && said.resistance == 0))
            expect_valid(*law.outlet);
        if (law.outlet) law.state = start_of(*law.outlet, config);
        if (said.initial_pressure) law.state[0] = *said.initial_pressure;
        law.level_state = law.state;
        return law;
    } catch (const DeckError& error) {
        throw DeckError(fmt::format("openings.{}: {}", opening.name, error.what()));
    }
}

std::function<SectionVelocity(double)> make_end_velocity(const Opening& opening, const deck::Opening& said,
                                                         const EndLaw& law, const deck::Blood& blood) {
    const Section section = opening.planar ? Section::planar : Section::circular;
    const double area = opening.area, radius = opening.radius;
    const Vec3 inwards = -opening.normal;
    const auto place = [opening, radius](const Vec3& x) {
        return norm(opening_coordinates(opening, x).radial) / radius;
    };
    const auto mean_speed = [signal = law.signal, area](double time) { return signal(time) / area; };
    switch (said.profile) {
        case deck::VelocityProfile::plug:
            return [=](double time) -> SectionVelocity {
                return [u = mean_speed(time) * inwards](const Vec3&) { return u; };   // beside a wall too: a plug slips
            };
        case deck::VelocityProfile::parabola:
            return [=](double time) -> SectionVelocity {
                return [=, mean = mean_speed(time)](const Vec3& x) {
                    return mean * parabola_profile(section, place(x)) * inwards;
                };
            };
        case deck::VelocityProfile::table: {
            const double mean = mean_of_table(*said.profile_table, section);
            return [=, table = *said.profile_table](double time) -> SectionVelocity {
                return [=, scale = mean_speed(time) / mean](const Vec3& x) {
                    return scale * value_of_table(table, place(x)) * inwards;
                };
            };
        }
        case deck::VelocityProfile::developed_startup: {
            if (section != Section::planar)
                throw DeckError(
                    fmt::format("openings.{}.profile: developed_startup is known between plates only", opening.name));
            const double rate = startup_rate(opening, blood), to_peak = law.peak_to_mean;
            return [=](double time) -> SectionVelocity {
                return [=, peak = mean_speed(time) * to_peak](const Vec3& x) {
                    return peak * startup_profile(std::min(place(x), 1.0), rate * time) * inwards;
                };
            };
        }
        case deck::VelocityProfile::womersley: break;
    }
    if (blood.law != deck::BloodLaw::newtonian)
        throw DeckError(fmt::format("openings.{}.profile: womersley is known for Newtonian blood only", opening.name));
    const WomersleyProfile profile(section, radius, blood.density, blood.viscosity,
                                   make_fourier_series(law.signal.waveform, womersley_modes));
    return [=, ramp = law.signal.ramp](double time) -> SectionVelocity {
        const double rise = ramp > 0 ? smooth_ramp(time, ramp) : 1.0;
        return [=, snapshot = profile.at(time)](const Vec3& x) {
            return rise * snapshot(std::min(place(x), 1.0)) * inwards;
        };
    };
}

std::function<double(double)> make_end_flow(const Opening& opening, const deck::Opening& said, const EndLaw& law,
                                            const deck::Blood& blood) {
    if (said.profile == deck::VelocityProfile::developed_startup)
        return [signal = law.signal, rate = startup_rate(opening, blood)](double time) {
            return signal(time) * startup_flow(rate * time);
        };
    if (said.profile == deck::VelocityProfile::womersley)
        return Signal{make_waveform(make_fourier_series(law.signal.waveform, womersley_modes)), law.signal.ramp};
    return law.signal;
}

OutletResponse response_of(const EndLaw& law, double time, double ahead) {
    if (!law.outlet) return {law.signal(time + ahead), 0};
    return step_response(*law.outlet, law.state, {time, ahead}, law.known_flow);
}

namespace {

/// The pressure of the point at which all outlet models meet, in the middle of a step; advances their states there.
double network_pressure(std::span<EndLaw> laws, double time, double ahead) {
    double inflow = 0, conductance = 0, current = 0;
    std::vector<OutletResponse> responses(laws.size());
    for (std::size_t k = 0; k < laws.size(); ++k) {
        EndLaw& law = laws[k];
        if (law.prescribes_flow()) inflow += law.signal(time + ahead);
        if (!law.outlet) continue;
        if (law.is_started && time > law.known_until)
            law.level_state =
                advanced(*law.outlet, law.level_state, {law.known_until, time - law.known_until}, law.level_flow);
        responses[k] = step_response(*law.outlet, law.level_state, {time, ahead});
        // An outlet without resistance sets the pressure: a very large conductance says so without a special case.
        responses[k].dp_dq = std::max(responses[k].dp_dq, least_resistance);
        conductance += 1 / responses[k].dp_dq;
        current += responses[k].p0 / responses[k].dp_dq;
    }
    if (conductance == 0) return 0;
    const double pressure = (inflow + current) / conductance;
    for (std::size_t k = 0; k < laws.size(); ++k)
        if (laws[k].outlet) laws[k].level_flow = (pressure - responses[k].p0) / responses[k].dp_dq;
    return pressure;
}

double moving_level(std::span<EndLaw> laws, double time, double ahead) {
    double sum = 0;
    int prescribed = 0;
    for (const EndLaw& law : laws)
        if (law.type == deck::OpeningType::pressure) sum += law.signal(time + ahead), ++prescribed;
    return prescribed > 0 ? sum / prescribed : network_pressure(laws, time, ahead);
}

}   // namespace

void impose_laws_ahead(std::span<EndLaw> laws, std::span<OpenEnd> ends, double time, double dt) {
    for (std::size_t k = 0; k < laws.size(); ++k) {
        if (laws[k].prescribes_flow()) continue;
        const OutletResponse wanted = response_of(laws[k], time, dt);
        ends[k].pressure = wanted.p0;
        ends[k].resistance = wanted.dp_dq;
    }
}

void advance_laws(std::span<EndLaw> laws, std::span<const OpenEnd> ends, double time) {
    for (std::size_t k = 0; k < laws.size(); ++k) {
        EndLaw& law = laws[k];
        const double dt = time - law.known_until, flow = ends[k].flow, pressure = ends[k].mean_pressure;
        law.volume_out += 0.5 * dt * (law.known_flow + flow);
        law.pressure_time += 0.5 * dt * (law.known_pressure + pressure);
        if (law.outlet) law.state = advanced(*law.outlet, law.state, {law.known_until, dt}, law.known_flow, flow);
        law.known_until = time, law.known_flow = flow, law.known_pressure = pressure;
        law.is_started = true;
    }
}

double impose_laws(std::span<EndLaw> laws, std::span<OpenEnd> ends, double time, double dt,
                   deck::PressureReference reference) {
    // The pressure of a kick stands in the middle of its step (THEORY.md (7.2)).
    const double ahead = 0.5 * dt;
    const double level = reference == deck::PressureReference::moving ? moving_level(laws, time, ahead) : 0;
    for (std::size_t k = 0; k < laws.size(); ++k) {
        EndLaw& law = laws[k];
        SoundAbsorber& absorber = ends[k].absorber;
        if (law.prescribes_flow()) {
            if (absorber.is_there()) absorber.hear(ends[k].mean_pressure + level, dt);
            continue;
        }
        const double flow = ends[k].flow;
        if (law.outlet && law.is_started && time > law.known_until)
            law.state =
                advanced(*law.outlet, law.state, {law.known_until, time - law.known_until}, law.known_flow, flow);
        law.known_until = time;
        law.known_flow = flow;
        law.is_started = true;
        const OutletResponse wanted = response_of(law, time, ahead);
        ends[k].pressure = wanted.p0 - level;
        ends[k].resistance = wanted.dp_dq;
        if (!absorber.is_there()) continue;
        absorber.follow(flow, dt);
        ends[k].pressure -= absorber.impedance * absorber.mean;
        ends[k].resistance += absorber.impedance;
    }
    return level;
}

}   // namespace patency
