// SPDX-License-Identifier: Apache-2.0
// What every scheme does at the open ends between its kicks: measure their flows, impose pressure and velocity in their
// buffers. What is to be imposed is the ends' own (bodies/open_end.h).
#pragma once

#include <cstdlib>

#include "patency/schemes/flow_scheme.h"
#include "patency/schemes/records.h"

namespace patency {

/// The end in whose buffer particle i is.
inline const OpenEnd& end_of(const FlowDomain& domain, std::size_t i) {
    return domain.ends[std::size_t(std::abs(domain.fluid.opening[i])) - 1];
}

/// After a step of dt [s], or 0 where particles were exchanged or moved.
void measure_flows(const FlowDomain& domain, const FlowNumerics& numerics, double time, double dt);

/// Leads the pressures of buffers, and what `records` (x, p) say of them, to the straight line of their end.
template <class T>
void impose_pressure(const FlowDomain& domain, const FluidMaterial& material, AlignedVector<Quad<T>>& records);

/// The velocities of buffers, also in `records` (v, .): what is imposed, or what flows along the axis.
template <class T>
void impose_velocity(const FlowDomain& domain, double time, AlignedVector<Quad<T>>& records);

}   // namespace patency
