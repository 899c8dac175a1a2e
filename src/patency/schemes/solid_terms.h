// SPDX-License-Identifier: Apache-2.0
// What two particles of a solid do to each other's sums, in the reference configuration, with w and w d of the pair.  THEORY (20)
// Quads: (u, c) displacement and hourglass modulus, (row of A, v) the stress for the force with a component of the velocity in
// its fourth place.
#pragma once

#include <array>

#include "patency/base/lane_math.h"
#include "patency/pairs/fixed_pairs.h"

namespace patency::solid_terms {

template <class P>
PATENCY_INLINE Vec<P> difference(const Quads<P>& i, const Quads<P>& j) {
    return {coordinate_difference(i.a, j.a), coordinate_difference(i.b, j.b), coordinate_difference(i.c, j.c)};
}

/// sum w (u_i - u_j) d^T, by rows; in a metal also sum w |u_i - u_j|^2, for the energy that hourglass modes lose as it flows.
///                                                                                           THEORY (20.3), (20.16)
template <bool is_metal>
struct Deformation {
    static constexpr std::size_t own_quads = 1, quads = 1, sums = is_metal ? 10 : 9;
    template <class P>
    PATENCY_INLINE void operator()(const FixedPair<P>& pair, const std::array<Quads<P>, 1>& i,
                                   const std::array<Quads<P>, 1>& j, std::array<P, sums>& sum) const {
        const Vec<P> u = difference(i[0], j[0]);
        const Vec<P>& d = pair.wd;
        sum[0] = fma(u.x, d.x, sum[0]), sum[1] = fma(u.x, d.y, sum[1]), sum[2] = fma(u.x, d.z, sum[2]);
        sum[3] = fma(u.y, d.x, sum[3]), sum[4] = fma(u.y, d.y, sum[4]), sum[5] = fma(u.y, d.z, sum[5]);
        sum[6] = fma(u.z, d.x, sum[6]), sum[7] = fma(u.z, d.y, sum[7]), sum[8] = fma(u.z, d.z, sum[8]);
        if constexpr (is_metal) sum[9] = fma(pair.w, dot(u, u), sum[9]);
    }
};

/// sum w (X_j d) d^T of a matrix X that every particle has: times B its mean around i.               THEORY (20.18)
struct Surroundings {
    static constexpr std::size_t own_quads = 1, quads = 3, sums = 9;
    template <class P>
    PATENCY_INLINE void operator()(const FixedPair<P>& pair, const std::array<Quads<P>, 1>&,
                                   const std::array<Quads<P>, 3>& X, std::array<P, sums>& sum) const {
        const Vec<P>& wd = pair.wd;
        const P unweighted = number<P>(1) / max(pair.w, number<P>(1e-30));   // the particle itself pads its row
        for (std::size_t k = 0; k < 3; ++k) {
            const P along = unweighted * fma(X[k].a, wd.x, fma(X[k].b, wd.y, X[k].c * wd.z));
            sum[3 * k] = fma(along, wd.x, sum[3 * k]), sum[3 * k + 1] = fma(along, wd.y, sum[3 * k + 1]),
                    sum[3 * k + 2] = fma(along, wd.z, sum[3 * k + 2]);
        }
    }
};

/// sum w |u_i - u_j|^2, for the energy of hourglass modes.                                            THEORY (20.7)
struct Stretching {
    static constexpr std::size_t own_quads = 1, quads = 1, sums = 1;
    template <class P>
    PATENCY_INLINE void operator()(const FixedPair<P>& pair, const std::array<Quads<P>, 1>& i,
                                   const std::array<Quads<P>, 1>& j, std::array<P, 1>& sum) const {
        const Vec<P> u = difference(i[0], j[0]);
        sum[0] = fma(pair.w, dot(u, u), sum[0]);
    }
};

/// sum w [(A_i + A_j) d - (c_i + c_j)(u_i - u_j) - f], f the damping, and in the fourth place sum w f . (v_i - v_j). Both A in one
/// sum, so that a pair's two forces are opposite to the last bit but those of the sums.              THEORY (20.8), (20.9)
template <bool is_damped>
struct Force {
    static constexpr std::size_t own_quads = 4, quads = 4, sums = is_damped ? 4 : 3;
    double displacement_scale = 1;   ///< the unit of displacements in that of distances
    double damping = 0;              ///< D of the sums

    template <class P>
    PATENCY_INLINE void operator()(const FixedPair<P>& pair, const std::array<Quads<P>, 4>& i,
                                   const std::array<Quads<P>, 4>& j, std::array<P, sums>& sum) const {
        const Vec<P>& d = pair.wd;
        const auto& [ui, xi, yi, zi] = i;
        const auto& [uj, xj, yj, zj] = j;
        const Vec<P> u = pair.w * difference(ui, uj);
        const P c = ui.d + uj.d;
        const auto along = [&](const Quads<P>& a, const Quads<P>& b) __attribute__((always_inline)) {
            return fma(a.a + b.a, d.x, fma(a.b + b.b, d.y, (a.c + b.c) * d.z));
        };
        Vec<P> f{along(xi, xj) - c * u.x, along(yi, yj) - c * u.y, along(zi, zj) - c * u.z};
        if constexpr (is_damped) {
            const P scale = number<P>(displacement_scale);
            const Vec<P> y{fma(scale, u.x, d.x), fma(scale, u.y, d.y),
                           fma(scale, u.z, d.z)};   // as the pair lies now, times w
            const P v = (xi.d - xj.d) * y.x + (yi.d - yj.d) * y.y + (zi.d - zj.d) * y.z;
            const P y2 = max(y.x * y.x + y.y * y.y + y.z * y.z, number<P>(1e-30));   // the particle itself pads its row
            const P pull = number<P>(damping) * v / y2;
            const P share = pair.w * pull;
            f.x = fma(-share, y.x, f.x), f.y = fma(-share, y.y, f.y), f.z = fma(-share, y.z, f.z);
            sum[3] = fma(share, v, sum[3]);
        }
        sum[0] += f.x, sum[1] += f.y, sum[2] += f.z;
    }
};

}   // namespace patency::solid_terms
