// SPDX-License-Identifier: Apache-2.0
// Particles: named fields of one length. Knows nothing of physics, neighbours or files.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "patency/particles/field.h"

namespace patency {

class ParticleSet {
public:
    ParticleSet() = default;
    ParticleSet(const ParticleSet&) = delete;   // fields refer to their set
    ParticleSet& operator=(const ParticleSet&) = delete;

    std::size_t size() const { return size_; }
    /// All fields, in the order of their declaration.
    std::span<FieldBase* const> fields() const { return fields_; }
    /// The field of that name, or nullptr.
    FieldBase* find(std::string_view name) const;

    /// Grow or shrink at the end; new values are zero.
    void resize(std::size_t count);
    /// Particle i becomes what particle order[i] was. Removes and copies as well as permutes; scratch
    /// fields only change their length.
    void take(std::span<const std::uint32_t> order);

private:
    friend class FieldBase;
    void add(FieldBase& field);

    std::vector<FieldBase*> fields_;
    std::size_t size_ = 0;
};

}   // namespace patency
