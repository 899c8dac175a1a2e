// SPDX-License-Identifier: Apache-2.0
// Pack<T>: a register full of T that behaves like one T. With select.h the only file that names vector instructions.
// Every operation is done lane by lane in IEEE arithmetic, so that a sum has the same bits for every width.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace patency {

#if defined(__AVX512F__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX2__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

#define PATENCY_INLINE [[gnu::always_inline]] inline

template <class T>
inline constexpr int native_lanes = register_bytes / int(sizeof(T));

namespace detail {
// Explicit types: a vector_size typedef that depends on template arguments is a scalar to g++ 12's overloading.
template <class T, int lanes>
struct Register;
template <>
struct Register<float, 4> {
    typedef float type __attribute__((vector_size(16)));
};
template <>
struct Register<float, 8> {
    typedef float type __attribute__((vector_size(32)));
};
template <>
struct Register<float, 16> {
    typedef float type __attribute__((vector_size(64)));
};
template <>
struct Register<double, 2> {
    typedef double type __attribute__((vector_size(16)));
};
template <>
struct Register<double, 4> {
    typedef double type __attribute__((vector_size(32)));
};
template <>
struct Register<double, 8> {
    typedef double type __attribute__((vector_size(64)));
};
template <>
struct Register<std::uint32_t, 4> {
    typedef std::uint32_t type __attribute__((vector_size(16)));
};
template <>
struct Register<std::uint32_t, 8> {
    typedef std::uint32_t type __attribute__((vector_size(32)));
};
template <>
struct Register<std::uint32_t, 16> {
    typedef std::uint32_t type __attribute__((vector_size(64)));
};
template <int lanes>
struct IntRegister;
template <>
struct IntRegister<4> {
    typedef std::int32_t type __attribute__((vector_size(16)));
};
template <>
struct IntRegister<8> {
    typedef std::int32_t type __attribute__((vector_size(32)));
};
template <>
struct IntRegister<16> {
    typedef std::int32_t type __attribute__((vector_size(64)));
};

// Roots and fused products have no operator, and a loop over lanes would be left as single steps: by hand for every register.
// Registers that the processor lacks go lane by lane. In place, for they are no values that a function may return.
template <class R>
PATENCY_INLINE void take_root(R& a) {
    for (unsigned l = 0; l < sizeof(R) / sizeof(a[0]); ++l) a[l] = std::sqrt(a[l]);
}
template <class R>
PATENCY_INLINE void fuse(R& a, const R& b, const R& c) {
    for (unsigned l = 0; l < sizeof(R) / sizeof(a[0]); ++l) a[l] = std::fma(a[l], b[l], c[l]);
}
// a > b ? a : b, which is also what the processors' instructions mean by it: g++ 12 finds those of narrower registers by itself,
// and leaves a comparison and a masked move of the widest.
template <class R>
PATENCY_INLINE void take_larger(R& a, const R& b) {
    a = a > b ? a : b;
}
template <class R>
PATENCY_INLINE void take_smaller(R& a, const R& b) {
    a = a < b ? a : b;
}
#if defined(__SSE2__)
PATENCY_INLINE void take_root(__m128& a) { a = _mm_sqrt_ps(a); }
PATENCY_INLINE void take_root(__m128d& a) { a = _mm_sqrt_pd(a); }
#endif
#if defined(__AVX2__) && defined(__FMA__)
PATENCY_INLINE void take_root(__m256& a) { a = _mm256_sqrt_ps(a); }
PATENCY_INLINE void take_root(__m256d& a) { a = _mm256_sqrt_pd(a); }
PATENCY_INLINE void fuse(__m128& a, const __m128& b, const __m128& c) { a = _mm_fmadd_ps(a, b, c); }
PATENCY_INLINE void fuse(__m128d& a, const __m128d& b, const __m128d& c) { a = _mm_fmadd_pd(a, b, c); }
PATENCY_INLINE void fuse(__m256& a, const __m256& b, const __m256& c) { a = _mm256_fmadd_ps(a, b, c); }
PATENCY_INLINE void fuse(__m256d& a, const __m256d& b, const __m256d& c) { a = _mm256_fmadd_pd(a, b, c); }
#endif
#if defined(__AVX512F__)
PATENCY_INLINE void take_root(__m512& a) { a = _mm512_sqrt_ps(a); }
PATENCY_INLINE void take_root(__m512d& a) { a = _mm512_sqrt_pd(a); }
// Of all lanes by their mask: what has none starts, in some compilers' headers, from a register that they then warn of.
constexpr std::uint16_t every_float = 0xffff;
constexpr std::uint8_t every_double = 0xff;
PATENCY_INLINE void take_larger(__m512& a, const __m512& b) { a = _mm512_maskz_max_ps(every_float, a, b); }
PATENCY_INLINE void take_larger(__m512d& a, const __m512d& b) { a = _mm512_maskz_max_pd(every_double, a, b); }
PATENCY_INLINE void take_smaller(__m512& a, const __m512& b) { a = _mm512_maskz_min_ps(every_float, a, b); }
PATENCY_INLINE void take_smaller(__m512d& a, const __m512d& b) { a = _mm512_maskz_min_pd(every_double, a, b); }
PATENCY_INLINE void fuse(__m512& a, const __m512& b, const __m512& c) { a = _mm512_fmadd_ps(a, b, c); }
PATENCY_INLINE void fuse(__m512d& a, const __m512d& b, const __m512d& c) { a = _mm512_fmadd_pd(a, b, c); }
#endif
}   // namespace detail

template <class T, int W = native_lanes<T>>
struct Pack {
    using Scalar = T;
    using Register = typename detail::Register<T, W>::type;
    static constexpr int lanes = W;
    Register v;

    Pack() = default;
    PATENCY_INLINE Pack(T s) : v(s - Register{}) {}   // x - 0 is x, also for -0
    PATENCY_INLINE explicit Pack(Register r) : v(r) {}
    PATENCY_INLINE static Pack load(const T* p) {
        Pack r;
        std::memcpy(&r.v, p, sizeof r.v);
        return r;
    }
    PATENCY_INLINE void store(T* p) const { std::memcpy(p, &v, sizeof v); }
    PATENCY_INLINE T operator[](int lane) const { return v[lane]; }

    PATENCY_INLINE friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
    PATENCY_INLINE friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
    PATENCY_INLINE friend Pack operator-(Pack a) { return Pack(-a.v); }
    PATENCY_INLINE friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
    PATENCY_INLINE friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
    PATENCY_INLINE Pack& operator+=(Pack b) {
        v += b.v;
        return *this;
    }
    PATENCY_INLINE Pack& operator-=(Pack b) {
        v -= b.v;
        return *this;
    }
    PATENCY_INLINE Pack& operator*=(Pack b) {
        v *= b.v;
        return *this;
    }
    PATENCY_INLINE friend Pack max(Pack a, Pack b) {
        detail::take_larger(a.v, b.v);
        return a;
    }
    PATENCY_INLINE friend Pack min(Pack a, Pack b) {
        detail::take_smaller(a.v, b.v);
        return a;
    }
    PATENCY_INLINE friend Pack sqrt(Pack a) {
        detail::take_root(a.v);
        return a;
    }
    /// a b + c with one rounding.
    PATENCY_INLINE friend Pack fma(Pack a, Pack b, Pack c) {
        detail::fuse(a.v, b.v, c.v);
        return a;
    }
};

// The same words for scalars, so that a law reads the same for both.
PATENCY_INLINE double max(double a, double b) { return a > b ? a : b; }
PATENCY_INLINE double min(double a, double b) { return a < b ? a : b; }
PATENCY_INLINE float max(float a, float b) { return a > b ? a : b; }
PATENCY_INLINE float min(float a, float b) { return a < b ? a : b; }
using std::fma;
using std::sqrt;

/// Four numbers of one particle that are read together: what a pair loop fetches per neighbour.
template <class T>
struct alignas(4 * sizeof(T)) Quad {
    T a, b, c, d;
};
/// The quads of W particles, by component.
template <class P>
struct Quads {
    P a, b, c, d;
};

namespace detail {

#if defined(__AVX512F__)
PATENCY_INLINE Quads<Pack<float, 16>> load_quads(const Quad<float>* base, const std::uint32_t* index) {
    const auto at = [&](int k) { return _mm_load_ps(&base[index[k]].a); };
    // Joined from halves: where a register is worked on in two goes, a quarter put into all of it costs twice one put into a half.
    const auto half = [&](int k) {
        return _mm256_castps_pd(_mm256_insertf128_ps(_mm256_castps128_ps256(at(k)), at(k + 4), 1));
    };
    __m512 z[4];
    for (int k = 0; k < 4; ++k)
        z[k] = _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(half(k)), half(k + 8), 1));
    const __m512 lo01 = _mm512_unpacklo_ps(z[0], z[1]), hi01 = _mm512_unpackhi_ps(z[0], z[1]);
    const __m512 lo23 = _mm512_unpacklo_ps(z[2], z[3]), hi23 = _mm512_unpackhi_ps(z[2], z[3]);
    const auto low = [](__m512 p, __m512 q) {
        return _mm512_castpd_ps(_mm512_unpacklo_pd(_mm512_castps_pd(p), _mm512_castps_pd(q)));
    };
    const auto high = [](__m512 p, __m512 q) {
        return _mm512_castpd_ps(_mm512_unpackhi_pd(_mm512_castps_pd(p), _mm512_castps_pd(q)));
    };
    using P = Pack<float, 16>;
    return {P(low(lo01, lo23)), P(high(lo01, lo23)), P(low(hi01, hi23)), P(high(hi01, hi23))};
}
PATENCY_INLINE Quads<Pack<double, 8>> load_quads(const Quad<double>* base, const std::uint32_t* index) {
    // Lanes k and k + 2 in one register, so that whole halves of registers, exchanged, bring the lanes back into order. The second
    // half comes by a masked load: it needs no unit that exchanges lanes, and of those this loop has too few.
    const auto pair = [&](int k) {
        const __m512d first = _mm512_castpd256_pd512(_mm256_load_pd(&base[index[k]].a));
        return _mm512_mask_broadcast_f64x4(first, 0xf0, _mm256_load_pd(&base[index[k + 2]].a));
    };
    const __m512d z0 = pair(0), z1 = pair(1), z4 = pair(4), z5 = pair(5);
    const __m512d ac0 = _mm512_unpacklo_pd(z0, z1), bd0 = _mm512_unpackhi_pd(z0, z1);
    const __m512d ac4 = _mm512_unpacklo_pd(z4, z5), bd4 = _mm512_unpackhi_pd(z4, z5);
    using P = Pack<double, 8>;
    return {P(_mm512_shuffle_f64x2(ac0, ac4, 0x88)), P(_mm512_shuffle_f64x2(bd0, bd4, 0x88)),
            P(_mm512_shuffle_f64x2(ac0, ac4, 0xdd)), P(_mm512_shuffle_f64x2(bd0, bd4, 0xdd))};
}
#elif defined(__AVX2__)
PATENCY_INLINE Quads<Pack<float, 8>> load_quads(const Quad<float>* base, const std::uint32_t* index) {
    const auto at = [&](int k) { return _mm_load_ps(&base[index[k]].a); };
    __m256 z[4];
    for (int k = 0; k < 4; ++k) z[k] = _mm256_insertf128_ps(_mm256_castps128_ps256(at(k)), at(k + 4), 1);
    const __m256 lo01 = _mm256_unpacklo_ps(z[0], z[1]), hi01 = _mm256_unpackhi_ps(z[0], z[1]);
    const __m256 lo23 = _mm256_unpacklo_ps(z[2], z[3]), hi23 = _mm256_unpackhi_ps(z[2], z[3]);
    using P = Pack<float, 8>;
    return {P(_mm256_shuffle_ps(lo01, lo23, 0x44)), P(_mm256_shuffle_ps(lo01, lo23, 0xee)),
            P(_mm256_shuffle_ps(hi01, hi23, 0x44)), P(_mm256_shuffle_ps(hi01, hi23, 0xee))};
}
PATENCY_INLINE Quads<Pack<double, 4>> load_quads(const Quad<double>* base, const std::uint32_t* index) {
    const auto at = [&](int k) { return _mm256_load_pd(&base[index[k]].a); };
    const __m256d ac01 = _mm256_unpacklo_pd(at(0), at(1)), bd01 = _mm256_unpackhi_pd(at(0), at(1));
    const __m256d ac23 = _mm256_unpacklo_pd(at(2), at(3)), bd23 = _mm256_unpackhi_pd(at(2), at(3));
    using P = Pack<double, 4>;
    return {P(_mm256_permute2f128_pd(ac01, ac23, 0x20)), P(_mm256_permute2f128_pd(bd01, bd23, 0x20)),
            P(_mm256_permute2f128_pd(ac01, ac23, 0x31)), P(_mm256_permute2f128_pd(bd01, bd23, 0x31))};
}
#endif
}   // namespace detail

/// The quads of the particles index[0 .. lanes).
template <class T, int W>
PATENCY_INLINE Quads<Pack<T, W>> load_quads(const Quad<T>* base, const std::uint32_t* index) {
#if defined(__AVX2__)
    if constexpr (W == native_lanes<T>) return detail::load_quads(base, index);
#endif
    Quads<Pack<T, W>> q;
    for (int l = 0; l < W; ++l) {
        const Quad<T>& r = base[index[l]];
        q.a.v[l] = r.a, q.b.v[l] = r.b, q.c.v[l] = r.c, q.d.v[l] = r.d;
    }
    return q;
}

/// a - b of coordinates. Those of float records are 32-bit fixed-point integers that live in the float's bits: the
/// difference is exact and wraps around, and comes back as a number of quanta.
template <int W>
PATENCY_INLINE Pack<float, W> coordinate_difference(Pack<float, W> a, Pack<float, W> b) {
    using I = typename detail::IntRegister<W>::type;
    typedef std::uint32_t U __attribute__((vector_size(sizeof(I))));
    const I d = (I)((U)a.v - (U)b.v);
    return Pack<float, W>(__builtin_convertvector(d, typename Pack<float, W>::Register));
}
template <int W>
PATENCY_INLINE Pack<double, W> coordinate_difference(Pack<double, W> a, Pack<double, W> b) {
    return a - b;
}
PATENCY_INLINE float coordinate_difference(float a, float b) {
    std::uint32_t ia, ib;
    std::memcpy(&ia, &a, 4);
    std::memcpy(&ib, &b, 4);
    return static_cast<float>(static_cast<std::int32_t>(ia - ib));
}
PATENCY_INLINE double coordinate_difference(double a, double b) { return a - b; }

/// Whole numbers of 16 bits as floats.
template <int W>
PATENCY_INLINE void load_whole(const std::int16_t* from, Pack<float, W>& to) {
    typedef std::int16_t Short __attribute__((vector_size(2 * W)));
    Short whole;
    std::memcpy(&whole, from, sizeof whole);
    to.v = __builtin_convertvector(__builtin_convertvector(whole, typename detail::IntRegister<W>::type),
                                   typename Pack<float, W>::Register);
}
PATENCY_INLINE void load_whole(const std::int16_t* from, float& to) { to = float(*from); }

}   // namespace patency
