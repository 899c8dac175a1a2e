// SPDX-License-Identifier: Apache-2.0
// Records as the loop over neighbours reads them, four numbers side by side: positions in its unit of length, in fixed
// point where they are floats, and vectors with one more number.
#pragma once

#include <bit>
#include <cstdint>

#include "patency/base/aligned.h"
#include "patency/pairs/sum_over_neighbours.h"

namespace patency {

/// Of a position [m].
template <class T>
Quad<T> position_record(const Frame& frame, const Vec3& x, T value) {
    if constexpr (sizeof(T) == 4) {
        const auto f = frame.fixed(x);
        return {std::bit_cast<float>(f[0]), std::bit_cast<float>(f[1]), std::bit_cast<float>(f[2]), value};
    } else {
        return {x.x, x.y, x.z, value};
    }
}

/// What pads rows: far from everything that may ever be there (half the fixed-point range away).
template <class T>
Quad<T> dummy_record() {
    if constexpr (sizeof(T) == 4) {
        const float far = std::bit_cast<float>(INT32_MIN);
        return {far, far, far, T(0)};
    } else {
        return {T(1e9), T(1e9), T(1e9), T(0)};
    }
}

template <class T>
Quad<T> vector_record(const Vec3& v, T value) {
    return {T(v.x), T(v.y), T(v.z), value};
}

/// And the dummy's: at rest.
template <class T>
Quad<T> zero_record() {
    return {T(0), T(0), T(0), T(0)};
}

/// The records of one body for the loop: those of its positions first.
template <class T, class... More>
Records<T, sizeof...(More)> records_of(const AlignedVector<Quad<T>>& positions, const More&... more) {
    return {positions.data(), more.data()...};
}

}   // namespace patency
