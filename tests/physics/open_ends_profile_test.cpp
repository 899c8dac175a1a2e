// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patency/physics/open_ends/bessel.h"

namespace patency {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;
constexpr Section sections[] = {Section::circular, Section::planar};

/// Mean over the section of f(s), Simpson's rule on a grid that is fine near the wall: s = 1 - (1 - x)^2 would need
/// f at 0; here s = sin(pi x / 2), so a boundary layer of 1/300 still has a hundred points.
Complex section_mean(Section section, auto f) {
    const int n = 4000;
    Complex sum{};
    for (int i = 0; i <= n; ++i) {
        const double x = double(i) / n, s = std::sin(pi * x / 2), ds = pi / 2 * std::cos(pi * x / 2);
        const double weight = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) / (3.0 * n);
        sum += weight * f(s) * ds * (section == Section::circular ? 2 * s : 1);
    }
    return sum;
}

TEST(Bessel, is_its_integral) {
    // I_n(z) = 1/pi int_0^pi e^(z cos t) cos(n t) dt; the trapezoidal sum of a periodic function converges
    // exponentially, so 8000 points leave round-off. Around |z| = 30 the method changes.
    for (double r : {1e-8, 0.1, 1.0, 5.0, 20.0, 29.999, 30.0, 30.001, 45.0, 300.0})
        for (double angle : {0.0, pi / 8, pi / 4, -pi / 4})
            for (int n : {0, 1}) {
                const Complex z = std::polar(r, angle);
                Complex sum{};
                const int points = 8000;
                for (int i = 0; i < points; ++i) {
                    const double t = 2 * pi * i / points;
                    sum += std::exp(z * (std::cos(t) - 1)) * std::cos(n * t) / double(points);
                }
                // The sum itself rounds to eps sqrt(points) of its terms, which are up to 1.
                EXPECT_NEAR(std::abs(scaled_bessel_i(n, z) - sum), 0, 1e-12 * std::abs(sum) + 2e-14) << z << " " << n;
            }
}

TEST(Bessel, tabulated_values) {
    // Abramowitz and Stegun, tables 9.8 and 9.12: e^(-1) I_0(1), e^(-1) I_1(1), ber 1 + i bei 1 = I_0(sqrt(i)).
    EXPECT_NEAR(scaled_bessel_i(0, 1.0).real(), 0.4657596076, 1e-10);
    EXPECT_NEAR(scaled_bessel_i(1, 1.0).real(), 0.2079104154, 1e-10);
    const Complex z = std::polar(1.0, pi / 4), value = scaled_bessel_i(0, z) * std::exp(z);
    EXPECT_NEAR(value.real(), 0.9843817812, 1e-10);
    EXPECT_NEAR(value.imag(), 0.2495660400, 1e-10);
}

TEST(Profile, plug_and_parabola_have_mean_one) {
    for (Section section : sections) {
        EXPECT_NEAR(section_mean(section, plug_profile).real(), 1, 1e-10);
        EXPECT_NEAR(section_mean(section, [&](double s) { return parabola_profile(section, s); }).real(), 1, 1e-10);
        EXPECT_EQ(parabola_profile(section, 1), 0);
        EXPECT_EQ(parabola_profile(section, 1.5), 0);
    }
    EXPECT_EQ(parabola_profile(Section::circular, 0), 2);
    EXPECT_EQ(parabola_profile(Section::planar, 0), 1.5);
    EXPECT_EQ(plug_profile(0.99), 1);
    EXPECT_EQ(plug_profile(1.01), 0);
}

TEST(Womersley, mean_is_one_and_wall_is_still) {
    for (Section section : sections)
        for (double alpha : {0.0, 1e-9, 1e-3, 0.5, 2.8, 5.999, 6.001, 15.0, 29.0, 31.0, 80.0, 300.0}) {
            const WomersleyMode mode(section, alpha);
            const Complex mean = section_mean(section, [&](double s) { return mode.shape(s); });
            EXPECT_NEAR(std::abs(mean - 1.0), 0, 1e-7) << alpha;   // Simpson on a layer of 1/300: 40 points
            EXPECT_NEAR(std::abs(mode.shape(1)), 0, 1e-12) << alpha;
            EXPECT_EQ(mode.shape(1.01), Complex(0));
        }
}

TEST(Womersley, momentum_balance_of_the_section) {
    // i alpha^2 mean = 1 / mobility - (perimeter a / area) wall_shear: pressure drives, wall brakes, the rest
    // accelerates. Ties the two wall numbers together to round-off of the largest term.
    for (Section section : sections)
        for (double alpha : {1e-4, 0.1, 1.0, 2.8, 5.999, 6.001, 15.0, 30.0, 31.0, 100.0, 1000.0}) {
            const WomersleyMode mode(section, alpha);
            const Complex left = Complex(0, alpha * alpha), drive = 1.0 / mode.mobility();
            const Complex brake = (section == Section::circular ? 2.0 : 1.0) * mode.wall_shear();
            EXPECT_NEAR(std::abs(left - drive + brake), 0, 1e-11 * std::abs(drive)) << alpha;
        }
}

TEST(Womersley, satisfies_the_equation_of_motion) {
    // i alpha^2 u = 1/mobility + u'' + u'/s (circular), + u'' (planar); differences of step 1e-3 / alpha leave
    // (alpha d)^2 / 12 of u'' and round-off eps / d^2.
    for (Section section : sections)
        for (double alpha : {0.5, 2.8, 5.0, 7.0, 20.0})
            for (double s : {0.1, 0.5, 0.9}) {
                const WomersleyMode mode(section, alpha);
                const double d = 1e-3 / std::max(1.0, alpha);
                const Complex up = mode.shape(s + d), at = mode.shape(s), down = mode.shape(s - d);
                Complex laplacian = (up - 2.0 * at + down) / (d * d);
                if (section == Section::circular) laplacian += (up - down) / (2 * d * s);
                const Complex drive = 1.0 / mode.mobility();
                EXPECT_NEAR(std::abs(Complex(0, alpha * alpha) * at - drive - laplacian), 0, 1e-5 * std::abs(drive));
            }
}

TEST(Womersley, wall_shear_is_the_slope_at_the_wall) {
    for (Section section : sections)
        for (double alpha : {0.0, 0.5, 2.8, 7.0, 20.0}) {
            const WomersleyMode mode(section, alpha);
            const double d = 1e-4 / std::max(1.0, alpha);   // one-sided, second order: (alpha d)^2 of the slope
            const Complex slope = (4.0 * mode.shape(1 - d) - mode.shape(1 - 2 * d)) / (2 * d);
            EXPECT_NEAR(std::abs(slope - mode.wall_shear()), 0, 1e-7 * std::abs(slope)) << alpha;
        }
}

TEST(Womersley, slow_flow_is_the_parabola) {
    // The deviation is alpha^2 / 6 and less.
    for (Section section : sections)
        for (double alpha : {0.0, 1e-12, 1e-7, 1e-4, 1e-2})
            for (double s : {0.0, 0.3, 0.7, 0.999}) {
                const WomersleyMode mode(section, alpha);
                EXPECT_NEAR(std::abs(mode.shape(s) - parabola_profile(section, s)), 0, alpha * alpha / 6 + 1e-14);
                EXPECT_NEAR(std::abs(mode.mobility() - (section == Section::circular ? 1.0 / 8 : 1.0 / 3)), 0,
                            alpha * alpha / 6 + 1e-14);
            }
}

TEST(Womersley, fast_flow_is_a_plug_with_a_stokes_layer) {
    // u = U (1 - e^(-(1-s) z)) to 1/alpha.
    for (Section section : sections) {
        const double alpha = 500;
        const WomersleyMode mode(section, alpha);
        for (double s : {0.3, 0.9, 0.998, 0.999}) {
            const Complex layer = 1.0 - std::exp((s - 1) * alpha * std::polar(1.0, pi / 4));
            EXPECT_NEAR(std::abs(mode.shape(s) - layer), 0, 3 / alpha) << s;
        }
    }
}

TEST(Womersley, methods_meet) {   // sums and quotients at alpha = 6, Bessel's two expansions at alpha = 30
    for (Section section : sections)
        for (double alpha : {6.0, 30.0}) {
            const WomersleyMode below(section, alpha * (1 - 1e-13)), above(section, alpha * (1 + 1e-13));
            for (double s : {0.0, 0.2, 0.6, 0.99})
                EXPECT_NEAR(std::abs(below.shape(s) - above.shape(s)), 0, 1e-11) << alpha;
            EXPECT_NEAR(std::abs(below.mobility() / above.mobility() - 1.0), 0, 1e-11);
            EXPECT_NEAR(std::abs(below.wall_shear() / above.wall_shear() - 1.0), 0, 1e-11);
        }
}

FourierSeries pulse() { return {3e-6, {1e-6, -0.4e-6, 0.1e-6}, {2e-6, 0.5e-6, 0}, 0.9}; }

TEST(Womersley, profile_carries_the_flow_at_any_time) {
    for (Section section : sections) {
        const WomersleyProfile profile(section, 0.002, 1060, 0.0035, pulse());
        for (double t : {0.0, 0.2, 0.55, 7.31}) {
            const Complex mean = section_mean(section, [&](double s) { return profile.velocity(s, t); });
            EXPECT_NEAR(mean.real() * section_area(section, 0.002), pulse()(t), 1e-8 * 3e-6);
        }
    }
}

TEST(Womersley, snapshot_is_the_profile) {
    // The third mode has alpha = 5.0 and the error (alpha / 256)^4 / 40 = 4e-9 of its velocity; one-sided at the wall
    // ten times that.
    for (Section section : sections) {
        const WomersleyProfile profile(section, 0.002, 1060, 0.0035, pulse());
        for (double t : {0.0, 0.3, 5.2}) {
            const ProfileSnapshot snapshot = profile.at(t);
            for (double s : {0.0, 0.001, 0.0077, 0.3, 0.6031, 0.99, 0.9961, 0.998, 0.9999, 1.0})
                EXPECT_NEAR(snapshot(s), profile.velocity(s, t), 4e-8 * 5e-6 / section_area(section, 0.002)) << s;
            EXPECT_EQ(snapshot(1.2), 0);
        }
    }
}

TEST(Womersley, snapshot_error_is_as_stated) {
    const double alpha = 30, w = alpha * alpha * 0.0035 / (1060 * 4e-6);
    const FourierSeries flow{0, {1e-6}, {0}, 2 * pi / w};
    const WomersleyProfile profile(Section::circular, 0.002, 1060, 0.0035, flow);
    for (double phase : {0.0, 0.1, 0.2, 0.3, 0.4}) {   // centred stencils, s < 255/256: (30/256)^4 / 43 = 4.4e-6
        const ProfileSnapshot snapshot = profile.at(phase * flow.period);
        for (double s = 0; s < 0.996; s += 0.0013)
            EXPECT_NEAR(snapshot(s), profile.velocity(s, phase * flow.period), 4.6e-6 * 1e-6 / (pi * 4e-6)) << s;
    }
}

TEST(Womersley, pressure_gradient_makes_the_flow_and_the_flow_the_gradient) {
    const FourierSeries gradient{300, {200, 10}, {-100, 50}, 0.9};
    for (Section section : sections) {
        const FourierSeries flow = make_womersley_flow(section, 0.002, 1060, 0.0035, gradient);
        const WomersleyProfile profile(section, 0.002, 1060, 0.0035, flow);
        for (double t : {0.0, 0.2, 0.55}) {
            EXPECT_NEAR(profile.pressure_gradient(t), gradient(t), 1e-9);
            // The section's balance in SI: rho A dU/dt = G A - perimeter tau.
            const double d = 1e-5;   // central difference: (w d)^2 / 6 of the rate
            const double rate = (flow(t + d) - flow(t - d)) / (2 * d);
            const double perimeter = section == Section::circular ? 2 * pi * 0.002 : 2;
            const double area = section_area(section, 0.002);
            EXPECT_NEAR(1060 * rate, gradient(t) * area - perimeter * profile.wall_shear_stress(t), 1e-6 * 300 * area);
        }
    }
}

TEST(Womersley, steady_part_is_poiseuille) {
    const FourierSeries steady{2e-6, {}, {}, 1};
    const WomersleyProfile pipe(Section::circular, 0.002, 1060, 0.0035, steady);
    EXPECT_NEAR(pipe.wall_shear_stress(0), 4 * 0.0035 * 2e-6 / (pi * 8e-9), 1e-12);   // THEORY (12.4)
    EXPECT_NEAR(pipe.pressure_gradient(0), 8 * 0.0035 * 2e-6 / (pi * 16e-12), 1e-9);
    EXPECT_NEAR(pipe.velocity(0, 0), 2 * 2e-6 / (pi * 4e-6), 1e-14);
    const WomersleyProfile gap(Section::planar, 0.002, 1060, 0.0035, steady);
    EXPECT_NEAR(gap.pressure_gradient(0), 3 * 0.0035 * 2e-6 / (2 * 8e-9), 1e-9);
}

TEST(Womersley, number) {   // a coronary artery at one beat per second
    EXPECT_NEAR(womersley_number(0.002, 2 * pi, 1 / 3.3e-6, 1.0), 2.76, 0.005);
}

}   // namespace
}   // namespace patency
