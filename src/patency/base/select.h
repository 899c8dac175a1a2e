// SPDX-License-Identifier: Apache-2.0
// Choosing among the lanes of packs, and turning rows into lanes: what a search needs beside the arithmetic of pack.h.
// Every width chooses the same.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "patency/base/pack.h"

namespace patency {

namespace detail {
#if defined(__AVX2__) && !defined(__AVX512F__)
/// For every choice among eight lanes, the chosen ones in rising order.
inline constexpr auto chosen_of_eight = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (unsigned chosen = 0; chosen < 256; ++chosen)
        for (unsigned lane = 0, n = 0; lane < 8; ++lane)
            if (chosen >> lane & 1) table[chosen][n++] = std::uint8_t(lane);
    return table;
}();
#endif
}   // namespace detail

/// The lanes in which a < b, as bits.
template <int W>
PATENCY_INLINE std::uint32_t lanes_below(Pack<float, W> a, Pack<float, W> b) {
#if defined(__AVX512F__)
    if constexpr (W == 16) return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ);
#elif defined(__AVX2__)
    if constexpr (W == 8) return std::uint32_t(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
#endif
    std::uint32_t below = 0;
    for (int l = 0; l < W; ++l) below |= std::uint32_t(a.v[l] < b.v[l]) << l;
    return below;
}

/// The lanes before the n-th, as bits.
PATENCY_INLINE std::uint32_t first_lanes(std::size_t n) { return n < 32 ? (1u << n) - 1 : UINT32_MAX; }

/// first, first + 1, ...
template <int W>
PATENCY_INLINE Pack<std::uint32_t, W> count_from(std::uint32_t first) {
    static constexpr std::uint32_t ramp[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return Pack<std::uint32_t, W>::load(ramp) + Pack<std::uint32_t, W>(first);
}

/// Writes the chosen lanes side by side and returns how many they are. The whole of out[0 .. W) is overwritten.
template <class T, int W>
PATENCY_INLINE std::size_t store_chosen(Pack<T, W> a, std::uint32_t chosen, T* out) {
    static_assert(sizeof(T) == 4);
#if defined(__AVX512F__)
    if constexpr (W == 16) {
        // Compressed in a register: compressing into memory is slow on some processors.
        _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(__mmask16(chosen), (__m512i)a.v));
        return std::size_t(std::popcount(chosen));
    }
#elif defined(__AVX2__)
    if constexpr (W == 8) {
        const __m256i order = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i*)&detail::chosen_of_eight[chosen]));
        _mm256_storeu_si256((__m256i*)out, _mm256_permutevar8x32_epi32((__m256i)a.v, order));
        return std::size_t(std::popcount(chosen));
    }
#endif
    std::size_t n = 0;
    for (int l = 0; l < W; ++l) {   // without a branch: overwritten unless chosen
        out[n] = a.v[l];
        n += chosen >> l & 1;
    }
    return n;
}

/// a[0 .. W) - b as floats; the integers wrap around.
template <int W>
PATENCY_INLINE Pack<float, W> load_difference(const std::int32_t* a, std::int32_t b) {
    using I = typename detail::IntRegister<W>::type;
    typedef std::uint32_t U __attribute__((vector_size(sizeof(I))));
    U d;
    std::memcpy(&d, a, sizeof d);
    d -= U{} + std::uint32_t(b);
    return Pack<float, W>(__builtin_convertvector((I)d, typename Pack<float, W>::Register));
}

/// Puts rows side by side: out[k lanes + l] = rows[l][k] for k < count, where lanes is the number of rows. Goes four k at
/// a time: rows and out have room up to the next multiple of four.
inline void store_side_by_side(std::span<const std::vector<std::uint32_t>> rows, std::size_t count,
                               std::uint32_t* out) {
    typedef std::uint32_t Four __attribute__((vector_size(16)));
    const auto low = [](Four a, Four b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); };
    const auto high = [](Four a, Four b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); };
    const auto load = [](const std::uint32_t* from) {
        Four v;
        std::memcpy(&v, from, sizeof v);
        return v;
    };
    const auto store = [](std::uint32_t* to, Four v) { std::memcpy(to, &v, sizeof v); };
    const std::size_t lanes = rows.size();
    std::size_t l = 0;
    for (; l + 4 <= lanes; l += 4) {   // squares of four by four, turned in registers
        const std::uint32_t *a = rows[l].data(), *b = rows[l + 1].data(), *c = rows[l + 2].data(),
                            *d = rows[l + 3].data();
        std::uint32_t* to = out + l;
        for (std::size_t k = 0; k < count; k += 4, to += 4 * lanes) {
            const Four ac_low = low(load(a + k), load(c + k)), ac_high = high(load(a + k), load(c + k));
            const Four bd_low = low(load(b + k), load(d + k)), bd_high = high(load(b + k), load(d + k));
            store(to, low(ac_low, bd_low));
            store(to + lanes, high(ac_low, bd_low));
            store(to + 2 * lanes, low(ac_high, bd_high));
            store(to + 3 * lanes, high(ac_high, bd_high));
        }
    }
    for (; l < lanes; ++l)
        for (std::size_t k = 0; k < count; ++k) out[k * lanes + l] = rows[l][k];
}

}   // namespace patency
