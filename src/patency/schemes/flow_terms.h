// SPDX-License-Identifier: Apache-2.0
// The sums over neighbours of the flow scheme. All are of differences, so that a constant field gives exactly zero; with
// w = t^3 and the correction matrix B = [sum w d d]^-1 a linear field gives its exact gradient.  THEORY.md (3)
#pragma once

#include <array>

#include "patency/pairs/sum_over_neighbours.h"

namespace patency::terms {

/// sum w (p_i - p_j) d: the pressure gradient before correction.                              THEORY.md (3.3)
struct PressureGradient {
    static constexpr int own_extras = 0, extras = 0, sums = 3;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>& i, const Sample<P, 0>& j,
                                   std::array<P, 3>& sum) const {
        const P w = pair.t * pair.t * pair.t * (i.value - j.value);
        sum[0] = fma(w, pair.d.x, sum[0]);
        sum[1] = fma(w, pair.d.y, sum[1]);
        sum[2] = fma(w, pair.d.z, sum[2]);
    }
};

/// The symmetric part of sum w (v_i - v_j) d (xx, yy, zz, xy, xz, yz), for the divergence, and sum w r (p_i - p_j), for
/// the dissipation of pressure. Extra quad: (v, p).                                            THEORY.md (3.4), (4.6)
struct Compression {
    static constexpr int own_extras = 1, extras = 1, sums = 7;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 1>& i, const Sample<P, 1>& j,
                                   std::array<P, 7>& sum) const {
        const P w = pair.t * pair.t * pair.t;
        const P wx = w * pair.d.x, wy = w * pair.d.y, wz = w * pair.d.z;
        const P u = i.extra[0].a - j.extra[0].a, v = i.extra[0].b - j.extra[0].b, q = i.extra[0].c - j.extra[0].c;
        sum[0] = fma(u, wx, sum[0]);
        sum[1] = fma(v, wy, sum[1]);
        sum[2] = fma(q, wz, sum[2]);
        sum[3] = fma(u, wy, fma(v, wx, sum[3]));
        sum[4] = fma(u, wz, fma(q, wx, sum[4]));
        sum[5] = fma(v, wz, fma(q, wy, sum[5]));
        sum[6] = fma(w * pair.r, i.extra[0].d - j.extra[0].d, sum[6]);
    }
};

/// sum w d: towards where there are fewer particles.                                              THEORY.md (6.1)
struct Crowding {
    static constexpr int own_extras = 0, extras = 0, sums = 3;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>&,
                                   std::array<P, 3>& sum) const {
        const P w = pair.t * pair.t * pair.t;
        sum[0] = fma(w, pair.d.x, sum[0]);
        sum[1] = fma(w, pair.d.y, sum[1]);
        sum[2] = fma(w, pair.d.z, sum[2]);
    }
};

/// The moments of the arrangement, once per advection step, over blood or wall:
///   0-5 M = sum w d d      6-8 sum w d      9-11 sum w r d
///   12-26 sum w d d d d / r^2: xxxx yyyy zzzz xxyy xxzz yyzz xxxy xxxz xyyy yyyz xzzz yzzz xxyz xyyz xyzz
template <class P, std::size_t n>
PATENCY_INLINE void add_moments(const Pair<P>& pair, const P& w, std::array<P, n>& sum) {
    const Vec<P>& d = pair.d;
    const P wx = w * d.x, wy = w * d.y, wz = w * d.z;
    const P xx = wx * d.x, yy = wy * d.y, zz = wz * d.z, xy = wx * d.y, xz = wx * d.z, yz = wy * d.z;
    sum[0] += xx, sum[1] += yy, sum[2] += zz, sum[3] += xy, sum[4] += xz, sum[5] += yz;
    sum[6] += wx, sum[7] += wy, sum[8] += wz;
    sum[9] = fma(pair.r, wx, sum[9]), sum[10] = fma(pair.r, wy, sum[10]), sum[11] = fma(pair.r, wz, sum[11]);
    // r is never 0 between two particles; the padding pair, of a particle with itself, must give 0 and not 0/0.
    const P inverse = P(1) / max(pair.r * pair.r, P(1e-30f));
    const P ex = d.x * inverse, ey = d.y * inverse, ez = d.z * inverse;
    const P exx = ex * d.x, eyy = ey * d.y, ezz = ez * d.z;
    sum[12] = fma(exx, xx, sum[12]), sum[13] = fma(eyy, yy, sum[13]), sum[14] = fma(ezz, zz, sum[14]);
    sum[15] = fma(exx, yy, sum[15]), sum[16] = fma(exx, zz, sum[16]), sum[17] = fma(eyy, zz, sum[17]);
    sum[18] = fma(exx, xy, sum[18]), sum[19] = fma(exx, xz, sum[19]), sum[20] = fma(eyy, xy, sum[20]);
    sum[21] = fma(eyy, yz, sum[21]), sum[22] = fma(ezz, xz, sum[22]), sum[23] = fma(ezz, yz, sum[23]);
    sum[24] = fma(exx, yz, sum[24]), sum[25] = fma(eyy, xz, sum[25]), sum[26] = fma(ezz, xy, sum[26]);
}
inline constexpr int moments = 27;

struct Moments {
    static constexpr int own_extras = 0, extras = 0, sums = moments;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>&,
                                   std::array<P, sums>& sum) const {
        add_moments(pair, pair.t * pair.t * pair.t, sum);
    }
};

/// The same of the wall, whose particles mirror the velocity linearly through the surface: at depth D behind it, seen
/// from a particle at distance s before it, v_wall - v_i = (v_surface - v_i) (1 + D/s).          THEORY.md (5.1)
/// value of i: s, of j: D. Extra quads of j: (normal, curvature), (velocity of the surface, .). Beyond the moments:
///   27-29 sum w (1 + D/s) d   30 sum w   31-33 sum w normal   34 sum w curvature   35-37 sum w velocity
///   38-43 sum w D d d (xx, yy, zz, xy, xz, yz)   44-46 sum w D (D + s)/2 d                          THEORY.md (5.5)
struct WallMoments {
    static constexpr int own_extras = 0, extras = 2, sums = moments + 20;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 0>& i, const Sample<P, 2>& j,
                                   std::array<P, sums>& sum) const {
        const P w = pair.t * pair.t * pair.t;
        add_moments(pair, w, sum);
        const P mirror = w * fma(j.value, P(1) / i.value, P(1));
        sum[27] = fma(mirror, pair.d.x, sum[27]), sum[28] = fma(mirror, pair.d.y, sum[28]),
        sum[29] = fma(mirror, pair.d.z, sum[29]);
        sum[30] += w;
        const Quads<P>&normal = j.extra[0], &velocity = j.extra[1];
        sum[31] = fma(w, normal.a, sum[31]), sum[32] = fma(w, normal.b, sum[32]), sum[33] = fma(w, normal.c, sum[33]);
        sum[34] = fma(w, normal.d, sum[34]);
        sum[35] = fma(w, velocity.a, sum[35]), sum[36] = fma(w, velocity.b, sum[36]),
        sum[37] = fma(w, velocity.c, sum[37]);
        const Vec<P>& d = pair.d;
        const P deep = w * j.value, x = deep * d.x, y = deep * d.y, z = deep * d.z;
        sum[38] = fma(x, d.x, sum[38]), sum[39] = fma(y, d.y, sum[39]), sum[40] = fma(z, d.z, sum[40]);
        sum[41] = fma(x, d.y, sum[41]), sum[42] = fma(x, d.z, sum[42]), sum[43] = fma(y, d.z, sum[43]);
        const P middle = P(0.5f) * (j.value + i.value);
        sum[44] = fma(middle, x, sum[44]), sum[45] = fma(middle, y, sum[45]), sum[46] = fma(middle, z, sum[46]);
    }
};

/// w e.A e, the weight of the Laplacian: A makes it exact for quadratic fields in any arrangement. THEORY.md (3.5)
template <class P>
PATENCY_INLINE P laplacian_weight(const Pair<P>& pair, const Quads<P>& diagonal, const Quads<P>& mixed) {
    const Vec<P>& d = pair.d;
    const P inverse = P(1) / max(pair.r * pair.r, P(1e-30f));
    const P square = fma(diagonal.a * d.x, d.x, fma(diagonal.b * d.y, d.y, diagonal.c * d.z * d.z));
    const P cross = fma(mixed.a * d.x, d.y, fma(mixed.b * d.x, d.z, mixed.c * d.y * d.z));
    return pair.t * pair.t * pair.t * (square + cross + cross) * inverse;
}

/// What the slow terms need over the own body. Extra quads: (v, mu), the rows of the velocity gradient L in the loop's unit
/// of length, (L_x, the root of the speed at which it dissipates), (L_y, 1 or 0 for who sees curvature), (L_z, .); of i also A (xx, yy, zz, .) and
/// (xy, xz, yz, .), and the correction matrix C of the divergence in the same form. With b = (L_i - L_j) d / 2, what the
/// curvature of the velocity takes from v_i - v_j, where i sees it:
///   0-8   sum w (v_i - v_j + b) d, by rows      9-11  sum wA mu (v_j - v_i), mu of the pair       THEORY.md (3.8)
///   12-14 sum wA d                              15    sum w b.C d
///   16-18 sum sqrt(U_i U_j) w r (v_i - v_j - (L_i + L_j) d / 2): zero for a quadratic velocity   THEORY.md (4.9)
/// and, where the viscosity varies:              19-21 sum w (mu_i - mu_j) d
template <bool thinning>
struct Viscosity {
    static constexpr int own_extras = 8, extras = 4, sums = thinning ? 22 : 19;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 8>& i, const Sample<P, 4>& j,
                                   std::array<P, sums>& sum) const {
        const Vec<P>& d = pair.d;
        const Quads<P>&vi = i.extra[0], &vj = j.extra[0];
        const P w = pair.t * pair.t * pair.t;
        const P u = vi.a - vj.a, v = vi.b - vj.b, q = vi.c - vj.c;
        const P weight = laplacian_weight(pair, i.extra[4], i.extra[5]);
        P friction = weight;
        if constexpr (thinning)
            friction *= P(2) * vi.d * vj.d / (vi.d + vj.d);   // one behind the other, for one stress
        sum[9] = fma(-friction, u, sum[9]), sum[10] = fma(-friction, v, sum[10]), sum[11] = fma(-friction, q, sum[11]);
        sum[12] = fma(weight, d.x, sum[12]), sum[13] = fma(weight, d.y, sum[13]), sum[14] = fma(weight, d.z, sum[14]);
        const auto half_way = [&](const Quads<P>& row) {
            return P(0.5f) * fma(row.a, d.x, fma(row.b, d.y, row.c * d.z));
        };
        const P ix = half_way(i.extra[1]), iy = half_way(i.extra[2]), iz = half_way(i.extra[3]);
        const P jx = half_way(j.extra[1]), jy = half_way(j.extra[2]), jz = half_way(j.extra[3]);
        const P wr = w * pair.r * (i.extra[1].d * j.extra[1].d);
        sum[16] = fma(wr, u - (ix + jx), sum[16]);
        sum[17] = fma(wr, v - (iy + jy), sum[17]);
        sum[18] = fma(wr, q - (iz + jz), sum[18]);
        const P share = i.extra[2].d;
        const P bx = share * (ix - jx), by = share * (iy - jy), bz = share * (iz - jz);
        const Quads<P>&diagonal = i.extra[6], &mixed = i.extra[7];
        const P cx = fma(diagonal.a, d.x, fma(mixed.a, d.y, mixed.b * d.z));
        const P cy = fma(mixed.a, d.x, fma(diagonal.b, d.y, mixed.c * d.z));
        const P cz = fma(mixed.b, d.x, fma(mixed.c, d.y, diagonal.c * d.z));
        sum[15] = fma(w, fma(bx, cx, fma(by, cy, bz * cz)), sum[15]);
        const P wx = w * d.x, wy = w * d.y, wz = w * d.z;
        const P ub = u + bx, vb = v + by, qb = q + bz;
        sum[0] = fma(ub, wx, sum[0]), sum[1] = fma(ub, wy, sum[1]), sum[2] = fma(ub, wz, sum[2]);
        sum[3] = fma(vb, wx, sum[3]), sum[4] = fma(vb, wy, sum[4]), sum[5] = fma(vb, wz, sum[5]);
        sum[6] = fma(qb, wx, sum[6]), sum[7] = fma(qb, wy, sum[7]), sum[8] = fma(qb, wz, sum[8]);
        if constexpr (thinning) {
            const P less = vi.d - vj.d;
            sum[19] = fma(less, wx, sum[19]), sum[20] = fma(less, wy, sum[20]), sum[21] = fma(less, wz, sum[21]);
        }
    }
};

/// And over the wall, whose blood has the viscosity of i:
///   0 sum wA (1 + D/s)   1 sum wA D (D + s)/2   2-4 sum wA d
struct WallViscosity {
    static constexpr int own_extras = 2, extras = 0, sums = 5;
    template <class P>
    PATENCY_INLINE void operator()(const Pair<P>& pair, const Sample<P, 2>& i, const Sample<P, 0>& j,
                                   std::array<P, sums>& sum) const {
        const P w = laplacian_weight(pair, i.extra[0], i.extra[1]);
        sum[0] = fma(w, fma(j.value, P(1) / i.value, P(1)), sum[0]);
        sum[1] = fma(w * j.value, P(0.5f) * (j.value + i.value), sum[1]);
        sum[2] = fma(w, pair.d.x, sum[2]), sum[3] = fma(w, pair.d.y, sum[3]), sum[4] = fma(w, pair.d.z, sum[4]);
    }
};

}   // namespace patency::terms
