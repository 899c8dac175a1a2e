// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "patency/base/parallel.h"

namespace patency {

namespace {

void compute_loads(SolidPart& part, const Vec3& gravity, double time) {
    SolidParticles& p = part.body->particles();
    for_each_index(p.size(), [&](std::size_t i) { p.load[i] = p.mass[i] * gravity; });
    if (!part.surface) return;
    part.surface->follow(p);
    for (const SolidPressure& load : part.pressures) part.surface->add_pressure(load.face, load.pressure(time));
}

}   // namespace

double stable_step(const SolidSystem& system) {
    double dt = std::numeric_limits<double>::infinity();
    for (const auto& part : system.parts) dt = std::min(dt, part->body->stable_step());
    return dt;
}

void solid_step(SolidSystem& system, double time, double dt) {
    const double middle = time + 0.5 * dt, end = time + dt;
    for (auto& part : system.parts) {
        part->body->drift(0.5 * dt, middle);
        compute_loads(*part, system.gravity, middle);
    }
    for (auto& contact : system.contacts) contact->add_forces(dt);
    for (auto& part : system.parts) {
        if (part->surface) part->surface->push(part->body->particles());
        part->body->compute_force(middle);
        const double drag = system.is_relaxed ? 2 * std::sqrt(part->body->find_present_frequency_squared(dt)) : 0.0;
        part->body->kick(dt, time, drag);
        part->body->drift(0.5 * dt, end);
    }
}

}   // namespace patency
