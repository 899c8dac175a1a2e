// SPDX-License-Identifier: Apache-2.0
// What two particles of a solid do to each other's sums, in the reference configuration.               THEORY (20)
// value of a geometry quad: the volume of j over that of a particle's own space. Further quads: (u, c) displacement and
// hourglass modulus, (row of A, v) the stress for the force with a component of the velocity in its fourth place.
#pragma once

#include <array>

#include "patency/base/lane_math.h"
#include "patency/pairs/sum_over_neighbours.h"

namespace patency::solid_terms {

/// w: t^3, or steeper t^6.
template <bool is_steep, class P>
PATENCY_INLINE P weight(const Pair<P>& pair, const P& volume) {
    const P t3 = pair.t * pair.t * pair.t;
    return is_steep ? t3 * (t3 * volume) : t3 * volume;
}

/// sum w d d^T: xx, yy, zz, xy, xz, yz.                                                               THEORY (20.2)
template <bool is_steep>
struct Moment {
    static constexpr int own_extras = 0, extras = 0, sums = 6;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>& j, std::array<P, 6>& sum) const {
        const auto& d = pair.d;
        const P w = weight<is_steep>(pair, j.value), wx = w * d.x, wy = w * d.y;
        sum[0] = fma(wx, d.x, sum[0]), sum[1] = fma(wy, d.y, sum[1]), sum[2] = fma(w * d.z, d.z, sum[2]);
        sum[3] = fma(wx, d.y, sum[3]), sum[4] = fma(wx, d.z, sum[4]), sum[5] = fma(wy, d.z, sum[5]);
    }
};

template <class P>
PATENCY_INLINE Vec<P> difference(const Quads<P>& i, const Quads<P>& j) {
    return {coordinate_difference(i.a, j.a), coordinate_difference(i.b, j.b), coordinate_difference(i.c, j.c)};
}

/// sum w (u_i - u_j) d^T, by rows; in a metal also sum w |u_i - u_j|^2, for the energy that hourglass modes lose as it flows.
///                                                                                           THEORY (20.3), (20.16)
template <bool is_steep, bool is_metal>
struct Deformation {
    static constexpr int own_extras = 1, extras = 1, sums = is_metal ? 10 : 9;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 1>& i, const Sample<P, 1>& j, std::array<P, std::size_t(sums)>& sum) const {
        const Vec<P> u = difference(i.extra[0], j.extra[0]);
        const P w = weight<is_steep>(pair, j.value);
        const Vec<P> d = w * pair.d;
        sum[0] = fma(u.x, d.x, sum[0]), sum[1] = fma(u.x, d.y, sum[1]), sum[2] = fma(u.x, d.z, sum[2]);
        sum[3] = fma(u.y, d.x, sum[3]), sum[4] = fma(u.y, d.y, sum[4]), sum[5] = fma(u.y, d.z, sum[5]);
        sum[6] = fma(u.z, d.x, sum[6]), sum[7] = fma(u.z, d.y, sum[7]), sum[8] = fma(u.z, d.z, sum[8]);
        if constexpr (is_metal) sum[9] = fma(w, dot(u, u), sum[9]);
    }
};

/// sum w |u_i - u_j|^2, for the energy of hourglass modes.                                            THEORY (20.7)
template <bool is_steep>
struct Stretching {
    static constexpr int own_extras = 1, extras = 1, sums = 1;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 1>& i, const Sample<P, 1>& j, std::array<P, 1>& sum) const {
        const Vec<P> u = difference(i.extra[0], j.extra[0]);
        sum[0] = fma(weight<is_steep>(pair, j.value), dot(u, u), sum[0]);
    }
};

/// sum w [(A_i + A_j) d - (c_i + c_j)(u_i - u_j) - f], f the damping, and in the fourth place sum w f . (v_i - v_j).
///                                                                                   THEORY (20.8), (20.9)
template <bool is_steep, bool is_damped>
struct Force {
    static constexpr int own_extras = 4, extras = 4, sums = is_damped ? 4 : 3;
    double displacement_scale = 1;   ///< the unit of displacements in that of distances
    double damping = 0;              ///< D of the sums

    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 4>& i, const Sample<P, 4>& j,
                    std::array<P, std::size_t(sums)>& sum) const {
        const Vec<P>& d = pair.d;
        const auto& [ui, xi, yi, zi] = i.extra;
        const auto& [uj, xj, yj, zj] = j.extra;
        const P w = weight<is_steep>(pair, j.value);
        const Vec<P> u = difference(ui, uj);
        const P c = ui.d + uj.d;
        Vec<P> f{fma(xi.a + xj.a, d.x, fma(xi.b + xj.b, d.y, (xi.c + xj.c) * d.z)) - c * u.x,
                 fma(yi.a + yj.a, d.x, fma(yi.b + yj.b, d.y, (yi.c + yj.c) * d.z)) - c * u.y,
                 fma(zi.a + zj.a, d.x, fma(zi.b + zj.b, d.y, (zi.c + zj.c) * d.z)) - c * u.z};
        if constexpr (is_damped) {
            const P scale = number<P>(displacement_scale);
            const Vec<P> y{fma(scale, u.x, d.x), fma(scale, u.y, d.y), fma(scale, u.z, d.z)};   // as the pair lies now
            const P v = (xi.d - xj.d) * y.x + (yi.d - yj.d) * y.y + (zi.d - zj.d) * y.z;
            const P y2 = max(y.x * y.x + y.y * y.y + y.z * y.z, number<P>(1e-30));   // the particle itself pads its row
            const P pull = number<P>(damping) * v / y2;
            f.x = fma(-pull, y.x, f.x), f.y = fma(-pull, y.y, f.y), f.z = fma(-pull, y.z, f.z);
            sum[3] = fma(w, pull * v, sum[3]);
        }
        sum[0] = fma(w, f.x, sum[0]), sum[1] = fma(w, f.y, sum[1]), sum[2] = fma(w, f.z, sum[2]);
    }
};

}   // namespace patency::solid_terms
