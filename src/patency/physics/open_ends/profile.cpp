// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "patency/physics/open_ends/bessel.h"

namespace patency {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

// Below this Womersley number the quotients are sums of their difference, term by term: the closed forms lose
// eps/alpha^2 there, the sums e^(0.29 alpha).
constexpr double series_limit = 6.0;
// And below this one the parabola is exact to round-off: it differs by alpha^2 / 6 and less.
constexpr double parabola_limit = 1e-8;
// Terms of the sums at the limit fall as (alpha/2)^(2k) / (k!)^2 (circular), alpha^(2k) / (2k)! (planar): below 1e-24
// of the largest at k = 40.
constexpr int series_terms = 40;

Complex sum_modes(const std::vector<WomersleyMode>& modes, const FourierSeries& series, double time, auto factor) {
    const double turns = time / series.period - std::floor(time / series.period);
    Complex sum{};
    for (std::size_t k = 1; k <= modes.size(); ++k)
        sum += series.amplitude(k) * factor(modes[k - 1]) * std::polar(1.0, 2 * pi * double(k) * turns);
    return sum;
}

/// Calls visit(k, t_k) for k = 1..: t_k = (z^2/4)^k / (k!)^2 (circular) or z^(2k) / (2k)! (planar).
void for_each_term(Section section, Complex z, auto visit) {
    const Complex w = z * z;
    Complex term{1};
    for (int k = 1; k <= series_terms; ++k) {
        term *= w / (section == Section::circular ? 4.0 * k * k : 2.0 * k * (2.0 * k - 1));
        visit(k, term);
    }
}

}   // namespace

double section_area(Section section, double radius) {
    return section == Section::circular ? pi * radius * radius : 2 * radius;
}

double parabola_profile(Section section, double s) {
    if (s > 1) return 0;
    return (section == Section::circular ? 2.0 : 1.5) * (1 - s * s);
}

double womersley_number(double radius, double angular_frequency, double density, double viscosity) {
    return radius * std::sqrt(angular_frequency * density / viscosity);
}

WomersleyMode::WomersleyMode(Section section, double alpha)
    : section_(section), alpha_(alpha), z_(alpha * std::polar(1.0, pi / 4)) {
    assert(alpha >= 0);
    if (alpha_ < parabola_limit) {
        wall_shear_ = section_ == Section::circular ? 4.0 : 3.0;
        mobility_ = section_ == Section::circular ? 1.0 / 8 : 1.0 / 3;
        return;
    }
    if (alpha_ < series_limit) {
        // I_0(z) - 2 I_1(z)/z = sum t_k k/(k+1); cosh z - sinh(z)/z = sum t_k 2k/(2k+1); z d/dz = sum 2k t_k.
        Complex all{1}, slope{};
        for_each_term(section_, z_, [&](int k, Complex t) {
            all += t;
            slope += 2.0 * k * t;
            mean_ += t * (section_ == Section::circular ? k / (k + 1.0) : 2 * k / (2 * k + 1.0));
        });
        wall_shear_ = slope / mean_;
        mobility_ = mean_ / (all * z_ * z_);
        return;
    }
    Complex tangent;   // I_1(z)/I_0(z) or tanh z
    if (section_ == Section::circular) {
        scale_ = scaled_bessel_i(0, z_);
        tangent = scaled_bessel_i(1, z_) / scale_;
        mean_ = 1.0 - 2.0 * tangent / z_;
    } else {
        const Complex e = std::exp(-2.0 * z_);
        scale_ = 0.5 * (1.0 + e);
        tangent = (1.0 - e) / (1.0 + e);
        mean_ = 1.0 - tangent / z_;
    }
    wall_shear_ = z_ * tangent / mean_;
    mobility_ = mean_ / (z_ * z_);
}

Complex WomersleyMode::from_series(double s) const {
    Complex sum{};
    double power = 1;   // s^(2k)
    for_each_term(section_, z_, [&](int, Complex t) {
        power *= s * s;
        sum += t * (1 - power);
    });
    return sum;
}

Complex WomersleyMode::shape(double s) const {
    if (s > 1) return 0;
    if (alpha_ < parabola_limit) return parabola_profile(section_, s);
    if (alpha_ < series_limit) return from_series(s) / mean_;
    const Complex at =
        section_ == Section::circular ? scaled_bessel_i(0, s * z_) : 0.5 * (1.0 + std::exp(-2.0 * s * z_));
    return (1.0 - at / scale_ * std::exp((s - 1) * z_)) / mean_;
}

WomersleyProfile::WomersleyProfile(Section section, double radius, double density, double viscosity,
                                   const FourierSeries& flow)
    : section_(section), radius_(radius), viscosity_(viscosity), mean_velocity_(flow) {
    const double area = section_area(section, radius);
    mean_velocity_.mean /= area;
    for (double& c : mean_velocity_.cosines) c /= area;
    for (double& s : mean_velocity_.sines) s /= area;
    for (std::size_t k = 1; k <= flow.modes(); ++k)
        modes_.emplace_back(section, womersley_number(radius, flow.frequency(k), density, viscosity));
    for (const WomersleyMode& mode : modes_)
        for (int i = 0; i <= ProfileSnapshot::intervals; ++i)
            shapes_.push_back(mode.shape(double(i) / ProfileSnapshot::intervals));
}

double WomersleyProfile::velocity(double s, double time) const {
    return mean_velocity_.mean * parabola_profile(section_, s) +
           sum_modes(modes_, mean_velocity_, time, [s](const WomersleyMode& m) { return m.shape(s); }).real();
}

ProfileSnapshot WomersleyProfile::at(double time) const {
    constexpr std::size_t places = ProfileSnapshot::intervals + 1;
    ProfileSnapshot snapshot;
    for (std::size_t i = 0; i < places; ++i)
        snapshot.velocities_.push_back(mean_velocity_.mean *
                                       parabola_profile(section_, double(i) / ProfileSnapshot::intervals));
    const double turns = time / mean_velocity_.period - std::floor(time / mean_velocity_.period);
    for (std::size_t k = 1; k <= modes_.size(); ++k) {
        const Complex now = mean_velocity_.amplitude(k) * std::polar(1.0, 2 * pi * double(k) * turns);
        for (std::size_t i = 0; i < places; ++i)
            snapshot.velocities_[i] += (now * shapes_[(k - 1) * places + i]).real();
    }
    return snapshot;
}

double ProfileSnapshot::operator()(double s) const {
    if (s > 1) return 0;
    const double x = s * intervals;
    // Four places around x; beyond the axis the profile is even, at the wall the four are one-sided.
    const int first = std::min(int(x) - 1, intervals - 3);
    const auto v = [&](int k) { return velocities_[std::size_t(std::abs(first + k))]; };
    const double t = x - first;
    return v(0) * (t - 1) * (t - 2) * (t - 3) / -6 + v(1) * t * (t - 2) * (t - 3) / 2 -
           v(2) * t * (t - 1) * (t - 3) / 2 + v(3) * t * (t - 1) * (t - 2) / 6;
}

double WomersleyProfile::wall_shear_stress(double time) const {
    const Complex steady = WomersleyMode(section_, 0).wall_shear() * mean_velocity_.mean;
    const Complex waves =
        sum_modes(modes_, mean_velocity_, time, [](const WomersleyMode& m) { return m.wall_shear(); });
    return viscosity_ / radius_ * (steady + waves).real();
}

double WomersleyProfile::pressure_gradient(double time) const {
    const Complex steady = mean_velocity_.mean / WomersleyMode(section_, 0).mobility();
    const Complex waves =
        sum_modes(modes_, mean_velocity_, time, [](const WomersleyMode& m) { return 1.0 / m.mobility(); });
    return viscosity_ / (radius_ * radius_) * (steady + waves).real();
}

FourierSeries make_womersley_flow(Section section, double radius, double density, double viscosity,
                                  const FourierSeries& pressure_gradient) {
    FourierSeries flow = pressure_gradient;
    const double factor = section_area(section, radius) * radius * radius / viscosity;   // m3/s per Pa/m and mobility
    flow.mean *= factor * WomersleyMode(section, 0).mobility().real();
    for (std::size_t k = 1; k <= flow.modes(); ++k) {
        const WomersleyMode mode(section, womersley_number(radius, flow.frequency(k), density, viscosity));
        flow.set_amplitude(k, factor * mode.mobility() * pressure_gradient.amplitude(k));
    }
    return flow;
}

}   // namespace patency
