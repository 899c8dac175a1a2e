// SPDX-License-Identifier: Apache-2.0
// J2Plastic::stress for a pack of particles at once: the logarithm and the exponential by series, which converge fast where
// the elastic strain is small, as it is in metals.                                              THEORY (19.15)
#pragma once

#include <utility>

#include "patency/base/pack.h"
#include "patency/base/symmetric_matrix.h"
#include "patency/physics/solid/plastic.h"

namespace patency {

template <class P>
struct PlasticLanes {
    Sym<P> kirchhoff;         ///< tau [Pa]
    Sym<P> inverse_plastic;   ///< C_p^-1 after the step
    P strain;                 ///< a after the step: larger than before where a lane flows
    Mat<P> inverse;           ///< F^-1
    P determinant;            ///< of F
    P distance;               ///< |b_e - 1| before the flow: a lane above furthest_series counts for nothing
};

/// Up to this distance the series are exact to 1e-13 of the strain.
inline constexpr double furthest_series = 0.1;

/// F, C_p^-1 and a before, lane by lane; det F > 0.
template <class P>
PATENCY_INLINE PlasticLanes<P> stress_by_series(const J2Plastic& law, const Mat<P>& F, const Sym<P>& inverse_plastic,
                                                const P& strain) {
    const P one = number<P>(1), bulk = number<P>(law.elastic.bulk), shear = number<P>(law.elastic.shear);
    const Sym<P> b = congruent(F, inverse_plastic), X = plus_unit(b, -one);
    // ln(1 + X)/2 = artanh Z, Z = X (2 + X)^-1
    const Sym<P> Z = commuting_product(X, inverse(plus_unit(X, number<P>(2)))), ZZ = commuting_product(Z, Z);
    const Sym<P> fifth = plus_unit(number<P>(1.0 / 7) * ZZ, number<P>(1.0 / 5)),
                 third = plus_unit(commuting_product(ZZ, fifth), number<P>(1.0 / 3));
    const Sym<P> e = commuting_product(Z, plus_unit(commuting_product(ZZ, third), one));
    const P volume = trace(e);
    const Sym<P> distortion = plus_unit(e, number<P>(-1.0 / 3) * volume);
    const P trial = number<P>(2) * shear * sqrt(number<P>(1.5) * double_dot(distortion, distortion));
    const Mat<P> cofactors{cross(F.y, F.z), cross(F.z, F.x), cross(F.x, F.y)};
    PlasticLanes<P> result{{}, inverse_plastic, strain, {}, dot(F.x, cofactors.x), sqrt(double_dot(X, X))};
    const P per_volume = one / result.determinant;
    result.inverse = transpose(Mat<P>{per_volume * cofactors.x, per_volume * cofactors.y, per_volume * cofactors.z});
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
        const Sym<P> N = (number<P>(-2) * (one - kept)) * distortion;
        Sym<P> exponential{one, one, one, number<P>(0), number<P>(0), number<P>(0)};
        for (int k = 7; k > 0; --k)
            exponential = plus_unit(number<P>(1.0 / k) * commuting_product(N, exponential), one);
        const Sym<P> after = congruent(result.inverse, commuting_product(b, exponential));
        Sym<P>& now = result.inverse_plastic;
        for (const auto& [to, from] : {std::pair{&now.xx, &after.xx},
                                       {&now.yy, &after.yy},
                                       {&now.zz, &after.zz},
                                       {&now.xy, &after.xy},
                                       {&now.xz, &after.xz},
                                       {&now.yz, &after.yz}})
            for (int l = 0; l < P::lanes; ++l)
                if (kept[l] != 1) to->v[l] = (*from)[l];   // the others keep theirs, to the bit
    }
    result.kirchhoff = plus_unit((number<P>(2) * shear * kept) * distortion, bulk * volume);
    return result;
}

}   // namespace patency
