// SPDX-License-Identifier: Apache-2.0
// Loops over indices on all threads, and reductions whose result does not depend on how many there are.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <vector>

namespace patency {

inline constexpr std::size_t block_size =
    1024;   // particles per task: small enough to balance, large enough to be cheap

/// Hands out the tasks 0..count-1 of a loop to the threads of a parallel region: to each of them its own part first, in every loop over
/// the same blocks the same one, so that it finds what it wrote before in its own caches; then what others have not begun.
/// In a region: for (const std::size_t task : shares.of_this_thread()) ...
class Shares {
public:
    explicit Shares(std::size_t count) : parts_(std::size_t(omp_get_max_threads())) {
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            parts_[k].next = count * k / parts_.size();
            parts_[k].end = count * (k + 1) / parts_.size();
        }
    }

    struct End {};
    class Walk {
    public:
        Walk(Shares& shares, std::size_t own) : shares_(shares), own_(own) { ++*this; }
        std::size_t operator*() const { return task_; }
        bool operator!=(End) const { return helped_ < shares_.parts_.size(); }
        Walk& operator++() {
            for (; helped_ < shares_.parts_.size(); ++helped_)
                if (shares_.parts_[(own_ + helped_) % shares_.parts_.size()].take(task_)) break;
            return *this;
        }

    private:
        Shares& shares_;
        std::size_t own_, helped_ = 0, task_ = 0;   // helped_: how many parts, the own one first, are all taken
    };
    struct Range {
        Shares& shares;
        Walk begin() const { return {shares, std::size_t(omp_get_thread_num())}; }
        End end() const { return {}; }
    };
    Range of_this_thread() { return {*this}; }

private:
    struct alignas(64) Part {
        std::atomic<std::size_t> next{0};
        std::size_t end = 0;

        bool take(std::size_t& task) {
            if (next.load(std::memory_order_relaxed) >= end) return false;
            return (task = next.fetch_add(1, std::memory_order_relaxed)) < end;
        }
    };
    std::vector<Part> parts_;
};

/// body(begin, end) for consecutive blocks of [0, count). Blocks may run in any order and on any thread.
template <class Body>
void for_each_block(std::size_t count, Body body) {
    const std::size_t blocks = (count + block_size - 1) / block_size;
    if (blocks <= 1) {
        if (count) body(std::size_t(0), count);
        return;
    }
    Shares shares(blocks);
#pragma omp parallel
    for (const std::size_t b : shares.of_this_thread()) body(b * block_size, std::min(count, (b + 1) * block_size));
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
