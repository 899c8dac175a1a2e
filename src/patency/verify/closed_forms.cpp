// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/closed_forms.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace patency {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

// e^(-45) = 3e-20: what a decaying series leaves out.
constexpr double negligible_exponent = 45;

/// Simpson's rule with as many intervals as leave 1e-9 of a profile with a kink.
template <class F>
double integral(double from, double to, F f) {
    const int n = 2000;
    double sum = 0;
    for (int i = 0; i <= n; ++i) sum += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * f(from + (to - from) * i / n);
    return sum * (to - from) / (3 * n);
}

}   // namespace

double plane_poiseuille_velocity(const PlaneFlow& flow, double y) {
    return flow.pressure_gradient / (2 * flow.viscosity) * y * (flow.gap - y);
}

double plane_poiseuille_peak(const PlaneFlow& flow) { return plane_poiseuille_velocity(flow, flow.gap / 2); }

double plane_startup_velocity(const PlaneFlow& flow, double y, double time) {
    const double d = flow.gap, nu = flow.viscosity / flow.density;
    const double decay = pi * pi * nu * time / (d * d);
    double sum = 0;
    // The terms fall as 1/k^3 by themselves: at time 0, 20,000 of them leave 1e-9 of the peak.
    for (int k = 1; k < 40000 && k * (k * decay) < negligible_exponent; k += 2)
        sum += std::sin(k * pi * y / d) * std::exp(-k * (k * decay)) / (double(k) * k * k);
    const double scale = 4 * flow.pressure_gradient * d * d / (flow.viscosity * pi * pi * pi);
    return plane_poiseuille_velocity(flow, y) - scale * sum;
}

double shear_rate_at(const Rheology& law, double stress) {
    double low = 0, high = 1;
    while (viscosity(law, high) * high < stress) low = high, high *= 2;
    for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high))
        (viscosity(law, middle) * middle < stress ? low : high) = middle;
    return high;
}

double thinning_plane_velocity(const PlaneFlow& flow, const Rheology& law, double y) {
    const double half = flow.gap / 2;
    return integral(std::abs(y - half), half, [&](double s) { return shear_rate_at(law, flow.pressure_gradient * s); });
}

double thinning_plane_flow(const PlaneFlow& flow, const Rheology& law) {   // 2 int u ds, by parts
    return 2 * integral(0, flow.gap / 2, [&](double s) { return s * shear_rate_at(law, flow.pressure_gradient * s); });
}

double plug_start_velocity(double y, double time) {
    assert(time > 0);   // the series of the plug itself does not converge at the wall
    double u = 1.5 * (1 - y * y), sign = 1;
    for (double l = pi / 2; l * l * time < negligible_exponent; l += pi, sign = -sign)
        u += sign * (2 / l - 6 / (l * l * l)) * std::cos(l * y) * std::exp(-l * l * time);
    return u;
}

double plug_start_mean(double time) {
    assert(time > 0);
    double mean = 1;
    for (double l = pi / 2; l * l * time < negligible_exponent; l += pi)
        mean += (2 - 6 / (l * l)) / (l * l) * std::exp(-l * l * time);
    return mean;
}

double plug_start_time(double peak) {
    assert(peak > 1 && peak < 1.5);
    double early = 1e-6, late = 100;   // the mid-plane accelerates at 3 and then decays to 1.5 at e^(-2.47 t)
    while (late - early > 1e-13 * late) {
        const double middle = 0.5 * (early + late);
        if (middle <= early || middle >= late) break;
        (plug_start_velocity(0, middle) < peak ? early : late) = middle;
    }
    return 0.5 * (early + late);
}

double pipe_velocity(const PipeFlow& pipe, double viscosity, double r) {
    return pipe.pressure_gradient / (4 * viscosity) * (pipe.radius * pipe.radius - r * r);
}

double pipe_flow(const PipeFlow& pipe, double viscosity) {
    return pi * std::pow(pipe.radius, 4) * pipe.pressure_gradient / (8 * viscosity);
}

double pipe_pressure_gradient(double radius, double viscosity, double flow) {
    return 8 * viscosity * flow / (pi * std::pow(radius, 4));
}

double pipe_wall_shear_stress(double radius, double viscosity, double flow) {
    return 4 * viscosity * flow / (pi * std::pow(radius, 3));
}

namespace {
WomersleyMode make_mode(const PipeFlow& pipe, const Oscillation& o) {
    return {Section::circular, womersley_number(pipe.radius, o.angular_frequency, o.density, o.viscosity)};
}
/// Amplitude of the mean velocity [m/s].
Complex mean_velocity(const PipeFlow& pipe, const Oscillation& o, const WomersleyMode& mode) {
    return pipe.pressure_gradient * pipe.radius * pipe.radius / o.viscosity * mode.mobility();
}
}   // namespace

Complex womersley_pipe_velocity(const PipeFlow& pipe, const Oscillation& o, double r) {
    const WomersleyMode mode = make_mode(pipe, o);
    return mean_velocity(pipe, o, mode) * mode.shape(r / pipe.radius);
}

Complex womersley_pipe_flow(const PipeFlow& pipe, const Oscillation& o) {
    return section_area(Section::circular, pipe.radius) * mean_velocity(pipe, o, make_mode(pipe, o));
}

Complex womersley_pipe_wall_shear_stress(const PipeFlow& pipe, const Oscillation& o) {
    const WomersleyMode mode = make_mode(pipe, o);
    return o.viscosity / pipe.radius * mean_velocity(pipe, o, mode) * mode.wall_shear();
}

double power_law_pipe_velocity(const PipeFlow& pipe, const PowerLaw& law, double r) {
    const double n = law.index, power = (n + 1) / n;
    return 1 / power * std::pow(pipe.pressure_gradient / (2 * law.consistency), 1 / n) *
           (std::pow(pipe.radius, power) - std::pow(r, power));
}

double power_law_pipe_flow(const PipeFlow& pipe, const PowerLaw& law) {
    const double n = law.index;
    return pi * n / (3 * n + 1) * std::pow(pipe.pressure_gradient / (2 * law.consistency), 1 / n) *
           std::pow(pipe.radius, (3 * n + 1) / n);
}

double power_law_pipe_pressure_gradient(double radius, const PowerLaw& law, double flow) {
    return 2 * law.consistency / radius * std::pow(wall_shear_rate(law, radius, flow), law.index);
}

double casson_pipe_velocity(const PipeFlow& pipe, const Casson& law, double r) {
    const double core = 2 * law.yield_stress / pipe.pressure_gradient, R = pipe.radius;
    if (core >= R) return 0;
    const double s = std::max(r, core);
    return pipe.pressure_gradient / (4 * law.plastic_viscosity) *
           (R * R - s * s - 8.0 / 3 * std::sqrt(core) * (std::pow(R, 1.5) - std::pow(s, 1.5)) + 2 * core * (R - s));
}

double casson_pipe_flow(const PipeFlow& pipe, const Casson& law) {
    const double b = 2 * law.yield_stress / (pipe.pressure_gradient * pipe.radius);
    if (b >= 1) return 0;
    return pipe_flow(pipe, law.plastic_viscosity) * (1 - 16.0 / 7 * std::sqrt(b) + 4.0 / 3 * b - std::pow(b, 4) / 21);
}

double TaylorGreen::wave_number() const { return 2 * pi / length; }

double TaylorGreen::energy_decay_rate() const { return 4 * viscosity / density * wave_number() * wave_number(); }

Vec3 TaylorGreen::velocity(const Vec3& place, double time) const {
    const double k = wave_number(), u = speed * std::exp(-0.5 * energy_decay_rate() * time);
    return {-u * std::cos(k * place.x) * std::sin(k * place.y), u * std::sin(k * place.x) * std::cos(k * place.y), 0};
}

double TaylorGreen::pressure(const Vec3& place, double time) const {
    const double k = wave_number();
    return -0.25 * density * speed * speed * (std::cos(2 * k * place.x) + std::cos(2 * k * place.y)) *
           std::exp(-energy_decay_rate() * time);
}

Complex tube_impedance(Section section, const YNetwork::Tube& tube, double density, double viscosity,
                       double angular_frequency) {
    const double a = tube.radius;
    const WomersleyMode mode(section, womersley_number(a, angular_frequency, density, viscosity));
    return tube.length * viscosity / (section_area(section, a) * a * a * mode.mobility());
}

YNetworkFlow solve_y_network(const YNetwork& network, const FourierSeries& inflow) {
    const std::vector<double> zeros(inflow.modes());
    const FourierSeries blank{0, zeros, zeros, inflow.period};
    const std::size_t count = network.branches.size();
    YNetworkFlow result{blank, blank, {count, blank}, {count, blank}};

    for (std::size_t k = 0; k <= inflow.modes(); ++k) {   // mode 0 is the mean
        const double w = k == 0 ? 0 : inflow.frequency(k);
        const auto impedance_of = [&](const YNetwork::Tube& tube) {
            return tube_impedance(network.section, tube, network.density, network.viscosity, w);
        };
        const auto set = [k](FourierSeries& series, Complex value) {
            if (k == 0)
                series.mean = value.real();
            else
                series.set_amplitude(k, value);
        };
        const Complex flow_in = k == 0 ? Complex(inflow.mean) : inflow.amplitude(k);

        // Each branch is an impedance to its distal pressure; the junction's pressure is what makes the flows add up.
        std::vector<Complex> impedances;
        Complex admittance{}, driven = flow_in;
        for (const auto& branch : network.branches) {
            impedances.push_back(impedance_of(branch.tube) + impedance(branch.outlet, w));
            admittance += 1.0 / impedances.back();
            if (k == 0) driven += branch.outlet.distal_pressure / impedances.back();
        }
        const Complex junction = driven / admittance;
        set(result.junction_pressure, junction);
        set(result.inlet_pressure, junction + impedance_of(network.inlet) * flow_in);
        for (std::size_t b = 0; b < count; ++b) {
            const double distal = k == 0 ? network.branches[b].outlet.distal_pressure : 0;
            const Complex flow = (junction - distal) / impedances[b];
            set(result.flows[b], flow);
            set(result.outlet_pressures[b], distal + impedance(network.branches[b].outlet, w) * flow);
        }
    }
    return result;
}

}   // namespace patency
