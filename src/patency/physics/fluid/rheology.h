// SPDX-License-Identifier: Apache-2.0
// Dynamic viscosity [Pa s] of blood as a function of the shear rate [1/s]: Newtonian and shear-thinning laws. The shear
// rate is sqrt(2 D:D), THEORY (10.1), not negative, zero allowed. Knows no yield surface: a yield stress is regularised.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace patency {

/// mu = constant.
struct Newtonian {
    double viscosity;   // Pa s
};

/// mu = mu_inf + (mu_0 - mu_inf) [1 + (lambda g)^a]^((n - 1) / a)   (THEORY (10.2)).
struct CarreauYasuda {
    double zero_shear_viscosity;       // mu_0, Pa s
    double infinite_shear_viscosity;   // mu_inf, Pa s
    double relaxation_time;            // lambda, s
    double index;                      // n, < 1 thins
    double transition = 2;             // a; 2 is Carreau's law
};

/// sqrt(mu) = sqrt(mu_c) + sqrt(tau_y / g) [1 - exp(-sqrt(m g))]: Casson's law sqrt(tau) = sqrt(tau_y) + sqrt(mu_c g)
/// with the exponent of Papanastasiou (THEORY (10.3)). At g = 0 sqrt(mu) = sqrt(mu_c) + sqrt(tau_y m).
struct Casson {
    double yield_stress;                // tau_y, Pa
    double plastic_viscosity;           // mu_c, Pa s
    double regularisation_time = 100;   // m, s: with 1/m well below the shear rates of interest the law is Casson's
};

/// mu = K g^(n - 1) (THEORY (10.4)), kept between two viscosities (the law itself goes to infinity at rest, to zero at high shear).
struct PowerLaw {
    double consistency;         // K, Pa s^n
    double index;               // n
    double minimum_viscosity;   // Pa s
    double maximum_viscosity;   // Pa s
};

using Rheology = std::variant<Newtonian, CarreauYasuda, Casson, PowerLaw>;

// Human blood at 37 degrees C. Carreau and power law as collected by Cho and Kensey, Biorheology 28 (1991), and by
// Shibeshi and Collins, Appl Rheol 15 (2005), the latter also for Casson: tau_y = (0.1937 Pa^(1/2))^2,
// mu_c = (0.055 (Pa s)^(1/2))^2. The power law's limits are the two plateaus of the Carreau law.
inline constexpr Newtonian blood_newtonian{0.0035};
inline constexpr CarreauYasuda blood_carreau{0.056, 0.00345, 3.313, 0.3568, 2};
inline constexpr CarreauYasuda blood_carreau_yasuda{0.056, 0.00345, 1.902, 0.22, 1.25};
inline constexpr Casson blood_casson{0.1937 * 0.1937, 0.055 * 0.055};
inline constexpr PowerLaw blood_power_law{0.017, 0.708, 0.00345, 0.056};

// T is double, float, or a pack with pow, sqrt, expm1, min and max found beside its type.

template <class T>
T viscosity(const Newtonian& law, T) {
    return T(law.viscosity);
}

template <class T>
T viscosity(const CarreauYasuda& law, T shear_rate) {
    using std::pow;
    const T bracket = T(1) + pow(T(law.relaxation_time) * shear_rate, T(law.transition));
    return T(law.infinite_shear_viscosity) + T(law.zero_shear_viscosity - law.infinite_shear_viscosity) *
                                                 pow(bracket, T((law.index - 1) / law.transition));
}

template <class T>
T viscosity(const Casson& law, T shear_rate) {
    using std::expm1, std::max, std::sqrt;
    // sqrt(tau_y / g) (1 - e^(-x)) = sqrt(tau_y m) (1 - e^(-x)) / x with x = sqrt(m g): no division by zero.
    const T x = max(sqrt(T(law.regularisation_time) * shear_rate), T(1e-18));
    const T root =
        T(std::sqrt(law.plastic_viscosity)) - T(std::sqrt(law.yield_stress * law.regularisation_time)) * expm1(-x) / x;
    return root * root;
}

template <class T>
T viscosity(const PowerLaw& law, T shear_rate) {
    using std::max, std::min, std::pow;
    const T g = max(shear_rate, T(1e-18));   // 0^(n-1) is infinite; the limit below gives the answer
    return min(max(T(law.consistency) * pow(g, T(law.index - 1)), T(law.minimum_viscosity)), T(law.maximum_viscosity));
}

/// Of whichever law it is.
inline double viscosity(const Rheology& law, double shear_rate) {
    return std::visit([&](const auto& l) { return viscosity(l, shear_rate); }, law);
}

/// The largest viscosity the law can give [Pa s]: it limits the viscous time step.
inline double largest_viscosity(const Rheology& law) {
    return std::max(viscosity(law, 0.0), viscosity(law, 1e6));   // at rest, unless the index makes it thicken
}

/// Shear rate at the wall of a tube [1/s] for the flow Q [m3/s] of a power-law liquid (Rabinowitsch):
/// g_w = (3n + 1) / (4n) 4 Q / (pi R^3). n = 1: the parabola's 4 Q / (pi R^3). The stress there is mu(g_w) g_w.
inline double wall_shear_rate(const PowerLaw& law, double radius, double flow) {
    const double n = law.index;
    return (3 * n + 1) / (4 * n) * 4 * flow / (std::numbers::pi * radius * radius * radius);
}

}   // namespace patency
