// SPDX-License-Identifier: Apache-2.0
// Loops over indices on all threads, and reductions whose result does not depend on how many there are.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <vector>

namespace patency {

inline constexpr std::size_t block_size =
    1024;   // particles per task: small enough to balance, large enough to be cheap

/// body(begin, end) for consecutive blocks of [0, count). Blocks may run in any order and on any thread.
template <class Body>
void for_each_block(std::size_t count, Body body) {
    const std::size_t blocks = (count + block_size - 1) / block_size;
    if (blocks <= 1) {
        if (count) body(std::size_t(0), count);
        return;
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t b = 0; b < blocks; ++b) body(b * block_size, std::min(count, (b + 1) * block_size));
}

/// body(i) for every i in [0, count), each of them much work; no body may touch what another one writes, nor throw.
template <class Body>
void for_each_task(std::size_t count, Body body) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t i = 0; i < count; ++i) body(i);
}

/// body(i) for every i in [0, count); no body may touch what another one writes.
template <class Body>
void for_each_index(std::size_t count, Body body) {
    for_each_block(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// combine(... combine(combine(start, value(0)), value(1)) ...) grouped by fixed blocks: the same bits for any number of
/// threads.
template <class T, class Value, class Combine>
T reduce(std::size_t count, T start, Value value, Combine combine) {
    const std::size_t blocks = (count + block_size - 1) / block_size;
    std::vector<T> partial(blocks, start);
    for_each_block(count, [&](std::size_t begin, std::size_t end) {
        T sum = start;
        for (std::size_t i = begin; i < end; ++i) sum = combine(sum, value(i));
        partial[begin / block_size] = sum;
    });
    T total = start;
    for (const T& part : partial) total = combine(total, part);
    return total;
}

template <class Value>
double sum_of(std::size_t count, Value value) {
    return reduce(count, 0.0, value, [](double a, double b) { return a + b; });
}
template <class Value>
double largest_of(std::size_t count, Value value) {
    return reduce(count, 0.0, value, [](double a, double b) { return a > b ? a : b; });
}

}   // namespace patency
