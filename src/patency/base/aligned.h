// SPDX-License-Identifier: Apache-2.0
// A vector whose storage starts on a cache line, for records and rows that packs load. Only extend() keeps old values.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace patency {

template <class T>
class AlignedVector {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    std::size_t size() const { return size_; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }

    /// Room for count values, none of them initialised; what was there is lost when the storage must grow.
    void reset(std::size_t count) {
        if (count > capacity_) {
            capacity_ = count + count / 8;
            const std::size_t bytes = (capacity_ * sizeof(T) + 63) / 64 * 64;
            data_.reset(static_cast<T*>(std::aligned_alloc(64, bytes)));
            if (!data_) throw std::bad_alloc();
        }
        size_ = count;
    }
    void reset(std::size_t count, T value) {
        reset(count);
        for (std::size_t i = 0; i < count; ++i) data_.get()[i] = value;
    }

    /// Room for count values, the first of which are those that were there.
    void extend(std::size_t count) {
        if (count > capacity_) {
            AlignedVector larger;
            larger.reset(count);
            if (size_ > 0) std::memcpy(larger.data(), data(), size_ * sizeof(T));
            *this = std::move(larger);
        }
        size_ = count;
    }

private:
    struct Free {
        void operator()(T* p) const { std::free(p); }
    };
    std::unique_ptr<T, Free> data_;
    std::size_t size_ = 0, capacity_ = 0;
};

}   // namespace patency
