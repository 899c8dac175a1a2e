// SPDX-License-Identifier: Apache-2.0
#include "patency/particles/particle_set.h"

#include <cassert>

namespace patency {

FieldBase* ParticleSet::find(std::string_view name) const {
    for (FieldBase* field : fields_)
        if (field->name() == name) return field;
    return nullptr;
}

void ParticleSet::resize(std::size_t count) {
    for (FieldBase* field : fields_) field->resize(count);
    size_ = count;
}

void ParticleSet::take(std::span<const std::uint32_t> order) {
    for (FieldBase* field : fields_) {
        if (field->keep() == Keep::state)
            field->take(order);
        else
            field->resize(order.size());
    }
    size_ = order.size();
}

void ParticleSet::add(FieldBase& field) {
    assert(find(field.name()) == nullptr && "two fields of one set share a name");
    fields_.push_back(&field);
}

}   // namespace patency
