// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/ends.h"

#include <algorithm>

#include "patency/base/parallel.h"

namespace patency {

void measure_flows(const FlowDomain& domain, const FlowNumerics& numerics, double time, double dt) {
    // Learnt while blood passes the slab: long for sound, short for a pulse.
    const double share = std::min(1.0, dt * numerics.reference_speed / (4 * numerics.spacing));
    for (OpenEnd& end : domain.ends) measure_flow(end, domain.fluid, time, share);
}

template <class T>
void impose_pressure(const FlowDomain& domain, const FluidMaterial& material, AlignedVector<Quad<T>>& records) {
    FluidParticles& fluid = domain.fluid;
    for (OpenEnd& end : domain.ends) {
        fit_pressure(end, material.density * material.sound_speed,
                     [&](std::uint32_t i) { return double(records[i].d); });
        for_each_index(end.buffer.size(), [&](std::size_t k) {
            const OpenEnd::Member& m = end.buffer[k];
            double& p = fluid.pressure[m.index];
            const double wanted = end.mean_pressure + end.slope * m.s, predicted = double(records[m.index].d);
            records[m.index].d = T(predicted + m.weight * (wanted - predicted));
            p += m.weight * (wanted - p);
            fluid.pressure_rate[m.index] *= 1 - m.weight;
        });
    }
}

template <class T>
void impose_velocity(const FlowDomain& domain, double time, AlignedVector<Quad<T>>& records) {
    FluidParticles& fluid = domain.fluid;
    for (OpenEnd& end : domain.ends) {
        const bool is_imposed = end.kind == OpenEnd::Kind::velocity;
        const double share = is_imposed ? end.share(time) : 1;
        const SectionVelocity imposed = is_imposed ? end.velocity(time) : SectionVelocity();
        for_each_index(end.buffer.size(), [&](std::size_t k) {
            const std::uint32_t i = end.buffer[k].index;
            Vec3& v = fluid.velocity[i];
            if (is_imposed)
                v = share * imposed(fluid.position[i]);
            else if (end.undisturbed || dot(v, end.normal) < 0)
                v = dot(v, end.normal) * end.normal;
            records[i] = vector_record(v, records[i].d);
        });
    }
}

template void impose_pressure<float>(const FlowDomain&, const FluidMaterial&, AlignedVector<Quad<float>>&);
template void impose_pressure<double>(const FlowDomain&, const FluidMaterial&, AlignedVector<Quad<double>>&);
template void impose_velocity<float>(const FlowDomain&, double, AlignedVector<Quad<float>>&);
template void impose_velocity<double>(const FlowDomain&, double, AlignedVector<Quad<double>>&);

}   // namespace patency
