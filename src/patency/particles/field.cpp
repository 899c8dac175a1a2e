// SPDX-License-Identifier: Apache-2.0
#include "patency/particles/field.h"

#include <utility>

#include "patency/particles/particle_set.h"

namespace patency {

FieldBase::FieldBase(ParticleSet& owner, std::string name, std::string unit, Keep keep)
    : name_(std::move(name)), unit_(std::move(unit)), keep_(keep) {
    owner.add(*this);
}

template <class T>
void Field<T>::take(std::span<const std::uint32_t> order) {
    spare_.resize(order.size());
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < order.size(); ++i) spare_[i] = values_[order[i]];
    values_.swap(spare_);
}

template class Field<double>;
template class Field<Vec3>;
template class Field<Mat3>;
template class Field<std::int32_t>;

}   // namespace patency
