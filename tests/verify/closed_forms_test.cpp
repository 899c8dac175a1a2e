// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/closed_forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patency {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// Simpson's rule.
double integral(double a, double b, auto f, int n = 2000) {
    double sum = 0;
    for (int i = 0; i <= n; ++i) sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * f(a + (b - a) * i / n);
    return sum * (b - a) / (3 * n);
}

const PlaneFlow plane{0.002, 30, 1000, 0.004};   // nu = 4e-6, d^2 / nu = 1 s, peak 3.75 mm/s

TEST(PlanePoiseuille, peak_and_mean) {
    EXPECT_NEAR(plane_poiseuille_peak(plane), 30 * 4e-6 / (8 * 0.004), 1e-15);
    const double mean = integral(0, 0.002, [](double y) { return plane_poiseuille_velocity(plane, y); }) / 0.002;
    EXPECT_NEAR(mean, 2.0 / 3 * plane_poiseuille_peak(plane), 1e-14);
    EXPECT_EQ(plane_poiseuille_velocity(plane, 0), 0);
}

TEST(PlaneStartup, centre_line_table) {   // five printed digits, computed independently
    const double times[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5};
    const double ratios[] = {0.07999, 0.15923, 0.37039, 0.61535, 0.85664, 0.94657, 0.99258};
    for (int i = 0; i < 7; ++i)
        EXPECT_NEAR(plane_startup_velocity(plane, 0.001, times[i]) / plane_poiseuille_peak(plane), ratios[i], 5.1e-6);
}

TEST(PlaneStartup, starts_at_rest_and_ends_at_the_parabola) {
    for (double y : {0.0, 0.0003, 0.001, 0.0017}) {
        EXPECT_NEAR(plane_startup_velocity(plane, y, 0), 0, 2e-9 * plane_poiseuille_peak(plane));
        EXPECT_NEAR(plane_startup_velocity(plane, y, 5), plane_poiseuille_velocity(plane, y), 1e-15);
    }
    // Far from the walls the liquid first falls freely: u = G t / rho until the walls are felt.
    EXPECT_NEAR(plane_startup_velocity(plane, 0.001, 1e-3), 30e-3 / 1000, 1e-9 * plane_poiseuille_peak(plane));
}

TEST(PlaneStartup, satisfies_the_equation_of_motion) {
    const double d = 1e-5, dt = 1e-4;   // (pi d / gap)^2 / 12 = 2e-5 and (pi^2 dt)^2 / 6 of the first mode's terms
    for (double y : {0.0004, 0.001})
        for (double t : {0.1, 0.3}) {
            const auto u = [](double yy, double tt) { return plane_startup_velocity(plane, yy, tt); };
            const double rate = (u(y, t + dt) - u(y, t - dt)) / (2 * dt);
            const double curvature = (u(y + d, t) - 2 * u(y, t) + u(y - d, t)) / (d * d);
            EXPECT_NEAR(1000 * rate, 30 + 0.004 * curvature, 1e-4 * 30);
        }
}

TEST(ThinningPlane, reduces_to_the_parabola) {
    const Rheology same = Newtonian{plane.viscosity};
    for (const double y : {0.0, 0.0003, 0.001, 0.0017})
        EXPECT_NEAR(thinning_plane_velocity(plane, same, y), plane_poiseuille_velocity(plane, y), 1e-13);
    EXPECT_NEAR(thinning_plane_flow(plane, same), 2.0 / 3 * plane_poiseuille_peak(plane) * plane.gap, 1e-15);
}

// u = n/(n+1) (G/K)^(1/n) [h^((n+1)/n) - s^((n+1)/n)] where neither limit of the law is reached.
TEST(ThinningPlane, is_the_power_laws_profile) {
    const PowerLaw law{0.017, 0.708, 0, 1e6};
    const double n = law.index, power = (n + 1) / n, half = plane.gap / 2;
    for (const double y : {0.0001, 0.0005, 0.001}) {
        const double exact = 1 / power * std::pow(plane.pressure_gradient / law.consistency, 1 / n) *
                             (std::pow(half, power) - std::pow(half - y, power));
        EXPECT_NEAR(thinning_plane_velocity(plane, law, y) / exact, 1, 1e-7);
    }
}

TEST(ThinningPlane, flow_is_the_integral_of_its_velocity) {
    for (const Rheology& law : {Rheology{blood_carreau_yasuda}, Rheology{blood_casson}, Rheology{blood_power_law}}) {
        const double flow = integral(
            0, plane.gap, [&](double y) { return thinning_plane_velocity(plane, law, y); }, 200);
        EXPECT_NEAR(thinning_plane_flow(plane, law) / flow, 1, 1e-5);
        EXPECT_NEAR(viscosity(law, shear_rate_at(law, 0.7)) * shear_rate_at(law, 0.7), 0.7, 1e-13);
    }
}

struct ChannelRow {
    double peak, time, mean, u[6];
};
// Five printed digits, at y = 0, 0.2, 0.4, 0.6, 0.8, 0.9.
const ChannelRow channel_table[] = {
    {1.1, 0.033407, 0.8802, {1.10000, 1.09822, 1.07952, 0.97442, 0.63665, 0.34955}},
    {1.2, 0.072723, 0.8696, {1.20000, 1.17865, 1.09402, 0.89441, 0.53084, 0.28417}},
    {1.3, 0.153924, 0.8829, {1.30000, 1.25414, 1.11161, 0.86095, 0.49166, 0.26107}},
    {1.4, 0.409908, 0.9364, {1.40000, 1.34491, 1.17914, 0.90128, 0.50914, 0.26938}},
};

TEST(PlugStart, table) {
    for (const ChannelRow& row : channel_table) {
        const double time = plug_start_time(row.peak);
        EXPECT_NEAR(time, row.time, 5.1e-7);
        EXPECT_NEAR(plug_start_mean(time), row.mean, 5.1e-5);
        const double places[] = {0, 0.2, 0.4, 0.6, 0.8, 0.9};
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(plug_start_velocity(places[i], time), row.u[i], 5.1e-6);
    }
    EXPECT_NEAR(plug_start_time(1.49), 1.343, 5.1e-4);
    EXPECT_NEAR(plug_start_time(1.499), 2.276, 5.1e-4);
    EXPECT_NEAR(plug_start_time(1.4999), 3.209, 5.1e-4);
}

TEST(PlugStart, is_a_plug_first_and_the_parabola_last) {
    EXPECT_NEAR(plug_start_velocity(0, 1e-4), 1.0003, 1e-10);   // free fall: du/dt = 3
    EXPECT_NEAR(plug_start_velocity(0.9, 1e-6), 1 + 3e-6, 1e-10);
    for (double y : {-0.7, 0.0, 0.4, 1.0}) EXPECT_NEAR(plug_start_velocity(y, 15), 1.5 * (1 - y * y), 1e-14);
    EXPECT_NEAR(plug_start_velocity(1, 0.05), 0, 1e-13);
    EXPECT_EQ(plug_start_velocity(-0.3, 0.05), plug_start_velocity(0.3, 0.05));
}

TEST(PlugStart, mean_is_the_integral_and_falls_before_it_recovers) {
    for (double t : {0.01, 0.1, 1.0})
        EXPECT_NEAR(integral(0, 1, [t](double y) { return plug_start_velocity(y, t); }), plug_start_mean(t), 1e-9);
    EXPECT_GT(plug_start_mean(0.01), plug_start_mean(0.07));
    EXPECT_LT(plug_start_mean(0.07), plug_start_mean(0.5));
}

TEST(Pipe, flow_is_the_integral_of_velocity) {
    const PipeFlow pipe{0.002, 500};
    const auto flow_of = [&](auto velocity) {
        return integral(
            0, 0.002, [&](double r) { return 2 * pi * r * velocity(r); }, 20000);
    };
    const double q = pipe_flow(pipe, 0.0035);
    EXPECT_NEAR(flow_of([&](double r) { return pipe_velocity(pipe, 0.0035, r); }), q, 1e-12 * q);
    EXPECT_NEAR(pipe_pressure_gradient(0.002, 0.0035, q), 500, 1e-10);
    EXPECT_NEAR(pipe_wall_shear_stress(0.002, 0.0035, q), 500 * 0.002 / 2, 1e-13);   // the section's balance

    const PowerLaw law = blood_power_law;
    const double q_power = power_law_pipe_flow(pipe, law);
    EXPECT_NEAR(flow_of([&](double r) { return power_law_pipe_velocity(pipe, law, r); }), q_power, 1e-9 * q_power);

    // The plug ends in a kink of the second derivative: third-order convergence of the rule there.
    const Casson casson{0.1, 0.0035};
    const double q_casson = casson_pipe_flow(pipe, casson);
    EXPECT_NEAR(flow_of([&](double r) { return casson_pipe_velocity(pipe, casson, r); }), q_casson, 1e-9 * q_casson);
}

TEST(Pipe, thinning_laws_carry_their_own_stress) {
    // mu(g) g = G r / 2 at every radius, g = -du/dr by a central difference of 1e-7 m.
    const PipeFlow pipe{0.002, 500};
    const Casson casson{0.1, 0.0035, 1e9};   // so sharp that the regularised law is Casson's
    for (double r : {0.0007, 0.001, 0.0019}) {
        const double d = 1e-7;
        const double g_power = (power_law_pipe_velocity(pipe, blood_power_law, r - d) -
                                power_law_pipe_velocity(pipe, blood_power_law, r + d)) /
                               (2 * d);
        const PowerLaw free{blood_power_law.consistency, blood_power_law.index, 0, 1e9};
        EXPECT_NEAR(viscosity(free, g_power) * g_power, 500 * r / 2, 1e-5);
        const double g_casson =
            (casson_pipe_velocity(pipe, casson, r - d) - casson_pipe_velocity(pipe, casson, r + d)) / (2 * d);
        EXPECT_NEAR(viscosity(casson, g_casson) * g_casson, 500 * r / 2, 1e-5);
    }
}

TEST(Pipe, thinning_laws_reduce_to_poiseuille) {
    const PipeFlow pipe{0.002, 500};
    const PowerLaw one{0.0035, 1, 0, 1};
    const Casson fluid{0, 0.0035};
    const double q = pipe_flow(pipe, 0.0035);
    EXPECT_NEAR(power_law_pipe_flow(pipe, one), q, 1e-13 * q);
    EXPECT_NEAR(casson_pipe_flow(pipe, fluid), q, 1e-13 * q);
    for (double r : {0.0, 0.001, 0.002}) {
        EXPECT_NEAR(power_law_pipe_velocity(pipe, one, r), pipe_velocity(pipe, 0.0035, r), 1e-14);
        EXPECT_NEAR(casson_pipe_velocity(pipe, fluid, r), pipe_velocity(pipe, 0.0035, r), 1e-14);
    }
}

TEST(Pipe, power_law_gradient_inverts_the_flow) {
    const double q = power_law_pipe_flow({0.002, 500}, blood_power_law);
    EXPECT_NEAR(power_law_pipe_pressure_gradient(0.002, blood_power_law, q), 500, 1e-9);
}

TEST(Pipe, casson_does_not_flow_below_yield) {
    const Casson law{0.6, 0.0035};   // G R / 2 = 0.5 Pa
    EXPECT_EQ(casson_pipe_flow({0.002, 500}, law), 0);
    EXPECT_EQ(casson_pipe_velocity({0.002, 500}, law, 0.001), 0);
    // The plug is rigid: b = 0.2, so r_c = 0.4 mm.
    const Casson moving{0.1, 0.0035};
    EXPECT_EQ(casson_pipe_velocity({0.002, 500}, moving, 0), casson_pipe_velocity({0.002, 500}, moving, 0.0004));
    EXPECT_GT(casson_pipe_velocity({0.002, 500}, moving, 0), casson_pipe_velocity({0.002, 500}, moving, 0.0005));
}

TEST(WomersleyPipe, table) {
    struct Row {
        double alpha, flow, flow_lag, centre, centre_lag;
    };
    // Five printed digits, lags in degrees to three; computed independently with J_0 and J_1.
    const Row table[] = {{1, 0.98557, 9.453, 0.98493, 10.645},    {2, 0.82494, 33.262, 0.81650, 37.966},
                         {2.5, 0.68407, 45.071, 0.66745, 52.271}, {3, 0.54835, 54.303, 0.52198, 64.292},
                         {5, 0.24180, 71.353, 0.18567, 89.852},   {8, 0.10480, 78.941, 0.06173, 91.219},
                         {10, 0.06947, 81.307, 0.03975, 89.855}};
    const PipeFlow pipe{0.002, 500};
    const double rho = 1060, mu = 0.0035;
    for (const Row& row : table) {
        const Oscillation o{row.alpha * row.alpha * mu / (rho * 4e-6), rho, mu};
        const Complex q = womersley_pipe_flow(pipe, o) / pipe_flow(pipe, mu);
        const Complex u = womersley_pipe_velocity(pipe, o, 0) / pipe_velocity(pipe, mu, 0);
        EXPECT_NEAR(std::abs(q), row.flow, 5.1e-6);
        EXPECT_NEAR(-std::arg(q) * 180 / pi, row.flow_lag, 5.1e-4);
        EXPECT_NEAR(std::abs(u), row.centre, 5.1e-6);
        EXPECT_NEAR(-std::arg(u) * 180 / pi, row.centre_lag, 5.1e-4);
    }
}

TEST(WomersleyPipe, balance_of_the_section_and_slow_limit) {
    const PipeFlow pipe{0.002, 500};
    for (double w : {0.01, 6.0, 60.0}) {
        const Oscillation o{w, 1060, 0.0035};
        const Complex tau = womersley_pipe_wall_shear_stress(pipe, o), q = womersley_pipe_flow(pipe, o);
        // rho dQ/dt = G A - 2 pi R tau
        const double area = pi * 4e-6;
        EXPECT_NEAR(std::abs(Complex(0, w) * 1060.0 * q - 500 * area + 2 * pi * 0.002 * tau), 0, 1e-12 * 500 * area);
    }
    const Oscillation slow{1e-6, 1060, 0.0035};
    EXPECT_NEAR(womersley_pipe_wall_shear_stress(pipe, slow).real(), 0.5, 1e-9);
    EXPECT_NEAR(womersley_pipe_velocity(pipe, slow, 0.001).real(), pipe_velocity(pipe, 0.0035, 0.001), 1e-9);
}

TEST(TaylorGreenVortices, satisfy_momentum_and_continuity) {
    const TaylorGreen flow{0.02, 0.1, 1000, 0.02};   // Re 100
    const double d = 1e-5, dt = 1e-4, t = 0.3;       // differences leave (k d)^2 / 6 = 2e-6
    for (const Vec3& x : {Vec3{0.003, 0.0041, 0}, Vec3{0.011, 0.007, 0}, Vec3{0.0179, 0.0002, 0}}) {
        const Vec3 dx{d, 0, 0}, dy{0, d, 0};
        const auto u = [&](const Vec3& at, double time) { return flow.velocity(at, time); };
        const Vec3 ux = (u(x + dx, t) - u(x - dx, t)) / (2 * d), uy = (u(x + dy, t) - u(x - dy, t)) / (2 * d);
        const Vec3 rate = (u(x, t + dt) - u(x, t - dt)) / (2 * dt);
        const Vec3 laplacian = (u(x + dx, t) + u(x - dx, t) + u(x + dy, t) + u(x - dy, t) - 4.0 * u(x, t)) / (d * d);
        const Vec3 slope{(flow.pressure(x + dx, t) - flow.pressure(x - dx, t)) / (2 * d),
                         (flow.pressure(x + dy, t) - flow.pressure(x - dy, t)) / (2 * d), 0};
        const Vec3 rest = 1000.0 * (rate + u(x, t).x * ux + u(x, t).y * uy) + slope - 0.02 * laplacian;
        const double scale = 1000 * 0.1 * 0.1 * flow.wave_number();
        EXPECT_NEAR(ux.x + uy.y, 0, 1e-5 * 0.1 * flow.wave_number());
        EXPECT_NEAR(rest.x, 0, 2e-5 * scale);
        EXPECT_NEAR(rest.y, 0, 2e-5 * scale);
    }
    const double energy_0 = std::pow(norm(flow.velocity({0.003, 0.004, 0}, 0)), 2);
    const double energy_1 = std::pow(norm(flow.velocity({0.003, 0.004, 0}, 0.5)), 2);
    EXPECT_NEAR(std::log(energy_0 / energy_1) / 0.5, flow.energy_decay_rate(), 1e-10);
    EXPECT_NEAR(flow.energy_decay_rate(), 4 * 2e-5 * std::pow(2 * pi / 0.02, 2), 1e-12);
}

YNetwork y_network(double density) {
    return {Section::circular,
            density,
            0.0035,
            {0.002, 0.01},
            {{{0.0015, 0.02}, {2e8, 4e-10, 1.5e9, 300}}, {{0.0012, 0.015}, {4e8, 1e-10, 3e9, 0}}}};
}
const FourierSeries beat{3e-6, {1e-6, -0.4e-6}, {1.5e-6, 0.5e-6}, 0.9};

TEST(YNetwork, flows_add_up_and_pressures_fall_along_the_way) {
    const YNetworkFlow result = solve_y_network(y_network(1060), beat);
    for (double t : {0.0, 0.2, 0.5, 0.8})
        EXPECT_NEAR(result.flows[0](t) + result.flows[1](t), beat(t), 1e-15 * 1e3 * 3e-6);
    EXPECT_GT(result.inlet_pressure.mean, result.junction_pressure.mean);
    for (int b : {0, 1}) EXPECT_GT(result.junction_pressure.mean, result.outlet_pressures[b].mean);
}

TEST(YNetwork, steady_part_is_resistances) {
    const YNetwork y = y_network(1060);
    const YNetworkFlow result = solve_y_network(y, FourierSeries{3e-6, {}, {}, 1});
    const double r0 = pipe_pressure_gradient(0.0015, 0.0035, 1) * 0.02 + 1.7e9;   // per m3/s
    const double r1 = pipe_pressure_gradient(0.0012, 0.0035, 1) * 0.015 + 3.4e9;
    const double junction = (3e-6 + 300 / r0) / (1 / r0 + 1 / r1);
    EXPECT_NEAR(result.junction_pressure.mean, junction, 1e-9);
    EXPECT_NEAR(result.flows[0].mean, (junction - 300) / r0, 1e-18);
    EXPECT_NEAR(result.outlet_pressures[1].mean, result.flows[1].mean * 3.4e9, 1e-9);
    EXPECT_NEAR(result.inlet_pressure.mean - junction, pipe_pressure_gradient(0.002, 0.0035, 3e-6) * 0.01, 1e-9);
}

TEST(YNetwork, tube_impedance_has_the_limits_of_the_lumped_tube) {
    const YNetwork::Tube tube{0.002, 0.01};
    const double area = pi * 4e-6, inertance = 1060 * 0.01 / area;
    for (Section section : {Section::circular, Section::planar}) {
        const double a = section == Section::circular ? area : 0.004;
        const double steady = section == Section::circular ? pipe_pressure_gradient(0.002, 0.0035, 1) * 0.01
                                                           : 0.01 * 3 * 0.0035 / (2 * 8e-9);
        EXPECT_NEAR(tube_impedance(section, tube, 1060, 0.0035, 0).real(), steady, 1e-9 * steady);
        // Fast: all of the section accelerates together but for a Stokes layer, 2 or 1 over alpha = 2200.
        const double w = 4e6;
        EXPECT_NEAR(tube_impedance(section, tube, 1060, 0.0035, w).imag() / (w * 1060 * 0.01 / a), 1, 1.5e-3);
    }
    // Slow: the parabola carries 4/3 of the momentum flux of a plug, so 4/3 of (12.9)'s inertance.
    EXPECT_NEAR(tube_impedance(Section::circular, tube, 1060, 0.0035, 1e-3).imag() / (1e-3 * inertance), 4.0 / 3, 1e-6);
}

TEST(YNetwork, marching_in_time_finds_the_same_flow) {
    // Without inertia (density 1e-9) the tubes are resistances: each step solves junction and outlets together. The
    // march is of second order: (w dt)^2 / 12 = 4e-6 at 1/2000 of the period for the second mode; 20 periods forget
    // the start (R_d C = 0.6 s).
    const YNetwork y = y_network(1e-9);
    const YNetworkFlow exact = solve_y_network(y, beat);
    const int steps = 2000;
    const double dt = 0.9 / steps;
    double resistance[2], q[2] = {exact.flows[0].mean, exact.flows[1].mean};
    OutletState state[2];
    for (int b : {0, 1}) {
        const auto& tube = y.branches[b].tube;
        resistance[b] = pipe_pressure_gradient(tube.radius, 0.0035, 1) * tube.length;
        state[b] = make_steady_state(y.branches[b].outlet, q[b]);
    }
    for (int i = 0; i < 20 * steps; ++i) {
        const TimeStep step{i * dt, dt};
        OutletResponse r[2];
        double admittance = 0, driven = beat((i + 1) * dt);
        for (int b : {0, 1}) {
            r[b] = step_response(y.branches[b].outlet, state[b], step, q[b]);
            admittance += 1 / (resistance[b] + r[b].dp_dq);
            driven += r[b].p0 / (resistance[b] + r[b].dp_dq);
        }
        const double junction = driven / admittance;
        for (int b : {0, 1}) {
            const double next = (junction - r[b].p0) / (resistance[b] + r[b].dp_dq);
            state[b] = advanced(y.branches[b].outlet, state[b], step, q[b], next);
            q[b] = next;
        }
        if (i < 19 * steps) continue;
        const double t = (i + 1) * dt;
        ASSERT_NEAR(junction, exact.junction_pressure(t), 1e-5 * exact.junction_pressure.mean);
        for (int b : {0, 1}) {
            ASSERT_NEAR(q[b], exact.flows[b](t), 1e-5 * 3e-6);
            ASSERT_NEAR(outlet_pressure(y.branches[b].outlet, state[b], q[b]), exact.outlet_pressures[b](t),
                        1e-5 * exact.outlet_pressures[b].mean);
        }
    }
}

}   // namespace
}   // namespace patency
