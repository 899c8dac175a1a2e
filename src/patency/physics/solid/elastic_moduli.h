// SPDX-License-Identifier: Apache-2.0
// The moduli of an isotropic elastic solid at small strain. Any two tell the others.               THEORY (19.3)
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "patency/base/errors.h"

namespace patency {

struct ElasticModuli {
    double shear = 0, bulk = 0;   ///< G, K [Pa]

    double young() const { return 9 * bulk * shear / (3 * bulk + shear); }                 ///< E [Pa]
    double poisson() const { return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)); }   ///< nu
    double lame() const { return bulk - 2 * shear / 3; }                                   ///< lambda [Pa]
    double p_wave() const { return bulk + 4 * shear / 3; }                                 ///< M [Pa]
    double p_wave_speed(double density) const { return std::sqrt(p_wave() / density); }    ///< [m/s]
};

/// What a user gave; the rest follows.
struct GivenModuli {
    std::optional<double> young, poisson, shear, bulk;   ///< Pa, 1, Pa, Pa
};

/// @throws DeckError unless exactly two are given and they are those of a stable solid: G > 0, K > 0.
inline ElasticModuli elastic_moduli(const GivenModuli& given) {
    const auto &E = given.young, &nu = given.poisson, &G = given.shear, &K = given.bulk;
    if (int(E.has_value()) + int(nu.has_value()) + int(G.has_value()) + int(K.has_value()) != 2)
        throw DeckError("exactly two of young, poisson, shear and bulk are needed; the others follow from them");
    ElasticModuli m;
    if (G && K)
        m = {*G, *K};
    else if (E && nu)
        m = {*E / (2 * (1 + *nu)), *E / (3 * (1 - 2 * *nu))};
    else if (E && G)
        m = {*G, *E * *G / (3 * (3 * *G - *E))};
    else if (E && K)
        m = {3 * *K * *E / (9 * *K - *E), *K};
    else if (nu && G)
        m = {*G, 2 * *G * (1 + *nu) / (3 * (1 - 2 * *nu))};
    else
        m = {3 * *K * (1 - 2 * *nu) / (2 * (1 + *nu)), *K};
    if (!(m.shear > 0 && m.bulk > 0 && std::isfinite(m.shear) && std::isfinite(m.bulk)))
        throw DeckError(
            "these two moduli belong to no stable solid: shear and bulk modulus must come out above zero, "
            "poisson between -1 and 0.5");
    return m;
}

}   // namespace patency
