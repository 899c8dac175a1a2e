// SPDX-License-Identifier: Apache-2.0
// The sums over neighbours of the reference paper's scheme, THEORY.md (11). Pair forces are equal and opposite; no
// operator is corrected, so a linear field keeps the error of the lattice sums (1.4).
//
// Everywhere w = t^3, so that the gradient of W is -slope w d, and V is a volume over that of a lattice cell.
#pragma once

#include <array>

#include "patency/pairs/sum_over_neighbours.h"
#include "patency/physics/fluid/equation_of_state.h"
#include "patency/physics/fluid/riemann.h"

namespace patency::terms {

/// W over its factor sigma: t^4 (5 - 4t).                                                     THEORY.md (1.1)
template <class P>
PATENCY_INLINE P shape_of_kernel(const Pair<P>& pair) {
    const P t2 = pair.t * pair.t;
    return t2 * t2 * fma(pair.t, P(-4), P(5));
}

/// sum W / sigma over the others, for the density.                                              THEORY.md (7.6)
struct NumberDensity {
    static constexpr int own_extras = 0, extras = 0, sums = 1;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>&,
                                   std::array<P, 1>& sum) const {
        // A padding pair, of a particle with itself at r = 0, must not count.
        const P present = min(pair.r * P(1e30f), P(1));
        sum[0] = fma(present, shape_of_kernel(pair), sum[0]);
    }
};

/// What is done once per advection step. Value: viscosity over a reference; extra quad: (v, V).
///   0-2 sum V w d   3-8 sum V w d d (xx, yy, zz, xy, xz, yz)   9-17 sum V w (v_i - v_j) d, by rows
///   18-20 sum V w mu_ij (v_j - v_i), mu_ij the harmonic mean; over the wall the blood's own     THEORY.md (3.7), (6.1)
enum class Over { blood, wall };
template <Over over>
struct SlowSums {
    static constexpr int own_extras = 1, extras = 1, sums = 21;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 1>& i, const Sample<P, 1>& j,
                                   std::array<P, 21>& sum) const {
        const Quads<P>&vi = i.extra[0], &vj = j.extra[0];
        const Vec<P>& d = pair.d;
        const P w = vj.d * (pair.t * pair.t * pair.t);
        const P wx = w * d.x, wy = w * d.y, wz = w * d.z;
        sum[0] += wx, sum[1] += wy, sum[2] += wz;
        sum[3] = fma(wx, d.x, sum[3]), sum[4] = fma(wy, d.y, sum[4]), sum[5] = fma(wz, d.z, sum[5]);
        sum[6] = fma(wx, d.y, sum[6]), sum[7] = fma(wx, d.z, sum[7]), sum[8] = fma(wy, d.z, sum[8]);
        const P u = vi.a - vj.a, v = vi.b - vj.b, q = vi.c - vj.c;
        sum[9] = fma(u, wx, sum[9]), sum[10] = fma(u, wy, sum[10]), sum[11] = fma(u, wz, sum[11]);
        sum[12] = fma(v, wx, sum[12]), sum[13] = fma(v, wy, sum[13]), sum[14] = fma(v, wz, sum[14]);
        sum[15] = fma(q, wx, sum[15]), sum[16] = fma(q, wy, sum[16]), sum[17] = fma(q, wz, sum[17]);
        const P mu = over == Over::wall ? i.value : P(2) * i.value * j.value / max(i.value + j.value, P(1e-30f));
        const P friction = w * mu;
        sum[18] -= friction * u, sum[19] -= friction * v, sum[20] -= friction * q;
    }
};

/// The two particles of a pair as the sides of a Riemann problem. Value: p; extra quad: (v, V).  THEORY.md (4.1)
template <class T>
struct RiemannPair {
    T density, sound_speed;   // at rest [kg/m3]; [m/s]
    template <class P>
    PATENCY_INLINE RiemannSide<P> side(const Pair<P>& pair, const Sample<P, 1>& particle) const {
        // r is never 0 between two particles; the padding pair, of a particle with itself, must not divide by it.
        const P inverse = P(-1) / max(pair.r, P(1e-30f));
        const Quads<P>& v = particle.extra[0];
        const P along = inverse * fma(v.a, pair.d.x, fma(v.b, pair.d.y, v.c * pair.d.z));
        return {density_at_pressure(particle.value, P(density), P(sound_speed)), along, particle.value};
    }
};

/// sum V w 2 P* d: the pressure force, with what keeps approaching particles apart.            THEORY.md (11.2)
template <class T>
struct RiemannForce : RiemannPair<T> {
    static constexpr int own_extras = 1, extras = 1, sums = 3;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 1>& i, const Sample<P, 1>& j,
                                   std::array<P, 3>& sum) const {
        const P star = star_pressure(this->side(pair, i), this->side(pair, j), P(this->sound_speed));
        const P w = j.extra[0].d * (pair.t * pair.t * pair.t) * (star + star);
        sum[0] = fma(w, pair.d.x, sum[0]);
        sum[1] = fma(w, pair.d.y, sum[1]);
        sum[2] = fma(w, pair.d.z, sum[2]);
    }
};

/// sum V w r 2 (U* - U_L): the rate of density, with the star velocity.                         THEORY.md (11.1)
template <class T>
struct RiemannCompression : RiemannPair<T> {
    static constexpr int own_extras = 1, extras = 1, sums = 1;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 1>& i, const Sample<P, 1>& j,
                                   std::array<P, 1>& sum) const {
        const RiemannSide<P> left = this->side(pair, i), right = this->side(pair, j);
        const P jump = star_velocity(left, right, P(this->sound_speed)) - left.velocity;
        sum[0] = fma(j.extra[0].d * (pair.t * pair.t * pair.t) * pair.r, jump + jump, sum[0]);
    }
};

/// Of a wall particle over the blood: 0 sum W   1 sum W p   2-4 sum W rho d. Value of the blood: p.   THEORY.md (11.5)
template <class T>
struct WallPressure {
    T density, sound_speed;
    static constexpr int own_extras = 0, extras = 0, sums = 5;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>& j,
                                   std::array<P, 5>& sum) const {
        const P w = shape_of_kernel(pair);
        const P heavy = w * density_at_pressure(j.value, P(density), P(sound_speed));
        sum[0] += w;
        sum[1] = fma(w, j.value, sum[1]);
        sum[2] = fma(heavy, pair.d.x, sum[2]), sum[3] = fma(heavy, pair.d.y, sum[3]),
        sum[4] = fma(heavy, pair.d.z, sum[4]);
    }
};

/// Of a wall particle over the blood: 0 sum W   1-3 sum W v. Extra quad of the blood: (v, V).       THEORY.md (11.4)
struct WallVelocity {
    static constexpr int own_extras = 0, extras = 1, sums = 4;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 1>& j,
                                   std::array<P, 4>& sum) const {
        const P w = shape_of_kernel(pair);
        const Quads<P>& v = j.extra[0];
        sum[0] += w;
        sum[1] = fma(w, v.a, sum[1]), sum[2] = fma(w, v.b, sum[2]), sum[3] = fma(w, v.c, sum[3]);
    }
};

}   // namespace patency::terms
