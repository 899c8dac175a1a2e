// SPDX-License-Identifier: Apache-2.0
// A field: a named column with one value per particle. Declared in one line inside a ParticleSet,
//
//     Field<Vec3> velocity{*this, "velocity", "m/s", Keep::state};
//
// and from that line follow resizing, sorting, removal, checkpoint and VTK output.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "patency/base/vec.h"

namespace patency {

/// How long a field's values mean something.
enum class Keep {
    state,     ///< part of the state: sorted with the particles, written to checkpoints
    scratch,   ///< recomputed in every step: resized, but neither sorted nor kept
};

class ParticleSet;

/// What storage, sorting, checkpoints and writers need to know of any field.
class FieldBase {
public:
    FieldBase(ParticleSet& owner, std::string name, std::string unit, Keep keep);
    FieldBase(const FieldBase&) = delete;
    FieldBase& operator=(const FieldBase&) = delete;
    virtual ~FieldBase() = default;

    const std::string& name() const { return name_; }
    const std::string& unit() const { return unit_; }   ///< SI, as text; "1" for numbers
    Keep keep() const { return keep_; }

    virtual int components() const = 0;    ///< 1, 3 (vector) or 9 (matrix, by rows)
    virtual bool is_integer() const = 0;   ///< 32-bit integers, else 64-bit floating point
    virtual std::span<const std::byte> bytes() const = 0;
    virtual std::span<std::byte> bytes() = 0;
    virtual void resize(std::size_t count) = 0;
    /// The value of particle i becomes what particle order[i] had; order may be shorter or longer
    /// than the field (removal, copies).
    virtual void take(std::span<const std::uint32_t> order) = 0;

private:
    std::string name_, unit_;
    Keep keep_;
};

template <class T>
class Field final : public FieldBase {
    static_assert(std::is_same_v<T, double> || std::is_same_v<T, Vec3> || std::is_same_v<T, Mat3> ||
                  std::is_same_v<T, std::int32_t>);

public:
    using FieldBase::FieldBase;

    T& operator[](std::size_t i) { return values_[i]; }
    const T& operator[](std::size_t i) const { return values_[i]; }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    std::size_t size() const { return values_.size(); }
    auto begin() { return values_.begin(); }
    auto end() { return values_.end(); }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }

    int components() const override {
        return is_integer()
                   ? 1
                   : int(sizeof(T) / sizeof(double));   // NOLINT(bugprone-sizeof-expression): T is numbers side by side
    }
    bool is_integer() const override { return std::is_same_v<T, std::int32_t>; }
    std::span<const std::byte> bytes() const override { return std::as_bytes(std::span(values_)); }
    std::span<std::byte> bytes() override { return std::as_writable_bytes(std::span(values_)); }
    void resize(std::size_t count) override { values_.resize(count); }
    void take(std::span<const std::uint32_t> order) override;

private:
    std::vector<T> values_;
    std::vector<T> spare_;   // the other half of take(), kept to save allocations
};

}   // namespace patency
