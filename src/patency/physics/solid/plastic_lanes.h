// SPDX-License-Identifier: Apache-2.0
// J2Plastic::stress for a pack of particles at once: the logarithm and the exponential by series, which converge fast where
// the elastic strain is small, as it is in metals.                                              THEORY (19.15)
#pragma once

#include <array>

#include "patency/base/pack.h"
#include "patency/physics/solid/plastic.h"

namespace patency {

template <class P>
struct PlasticLanes {
    Mat<P> kirchhoff;         ///< tau [Pa]
    Mat<P> inverse_plastic;   ///< C_p^-1 after the step
    P strain;                 ///< a after the step
    Mat<P> inverse;           ///< F^-1
    P distance;               ///< |b_e - 1| before the flow: a lane above furthest_series counts for nothing
};

/// Up to this distance the series are exact to 1e-13 of the strain.
inline constexpr double furthest_series = 0.1;

/// F, C_p^-1 and a before, lane by lane; det F > 0.
template <class P>
PATENCY_INLINE PlasticLanes<P> stress_by_series(const J2Plastic& law, const Mat<P>& F, const Mat<P>& inverse_plastic, const P& strain) {
    const P one = number<P>(1), bulk = number<P>(law.elastic.bulk), shear = number<P>(law.elastic.shear);
    const Mat<P> unit = identity<P>(), b = F * inverse_plastic * transpose(F), X = b - unit, G = inverse(F);
    // ln(1 + X)/2 = artanh Z, Z = X (2 + X)^-1
    const Mat<P> Z = X * inverse(X + number<P>(2) * unit), ZZ = Z * Z;
    const Mat<P> e = Z * (unit + ZZ * (number<P>(1.0 / 3) * unit + ZZ * (number<P>(1.0 / 5) * unit + number<P>(1.0 / 7) * ZZ)));
    const P volume = trace(e);
    const Mat<P> distortion = e - (number<P>(1.0 / 3) * volume) * unit;
    const P trial = number<P>(2) * shear * sqrt(number<P>(1.5) * double_dot(distortion, distortion));
    PlasticLanes<P> result{{}, inverse_plastic, strain, G, sqrt(double_dot(X, X))};
    P kept = one;   // of the distortion
    bool flows = false;
    for (int l = 0; l < P::lanes; ++l) {
        if (!(trial[l] > law.hardening.stress(strain[l])) || !(result.distance[l] < furthest_series)) continue;
        const double increment = law.plastic_increment(trial[l], strain[l]);
        kept.v[l] = (trial[l] - 3 * law.elastic.shear * increment) / trial[l];
        result.strain.v[l] += increment;
        flows = true;
    }
    if (flows) {   // b_e = b exp(N), N = -2 (1 - kept) dev e
        const Mat<P> N = (number<P>(-2) * (one - kept)) * distortion;
        Mat<P> exponential = unit;
        for (int k = 7; k > 0; --k) exponential = unit + number<P>(1.0 / k) * (N * exponential);
        const Mat<P> after = G * (b * exponential) * transpose(G), symmetric = number<P>(0.5) * (after + transpose(after));
        const std::array<P*, 9> to = {&result.inverse_plastic.x.x, &result.inverse_plastic.x.y, &result.inverse_plastic.x.z,
                                      &result.inverse_plastic.y.x, &result.inverse_plastic.y.y, &result.inverse_plastic.y.z,
                                      &result.inverse_plastic.z.x, &result.inverse_plastic.z.y, &result.inverse_plastic.z.z};
        const std::array<const P*, 9> from = {&symmetric.x.x, &symmetric.x.y, &symmetric.x.z, &symmetric.y.x, &symmetric.y.y,
                                              &symmetric.y.z, &symmetric.z.x, &symmetric.z.y, &symmetric.z.z};
        for (std::size_t k = 0; k < 9; ++k)
            for (int l = 0; l < P::lanes; ++l)
                if (kept[l] != 1) to[k]->v[l] = (*from[k])[l];   // the others keep theirs, to the bit
    }
    result.kirchhoff = (bulk * volume) * unit + (number<P>(2) * shear * kept) * distortion;
    return result;
}

}   // namespace patency
