// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "patency/base/parallel.h"

namespace patency {

namespace {

/// At nine a slow part costs little as it is, and a stress that is held longer sees contact too late: two blocks that collide
/// without damping gain 1 % of their energy at nine (stiffness ratio 30) and 12 % at 27 (ratio 400).
constexpr int longest_stride = 9;

void compute_loads(SolidPart& part, const Vec3& gravity, double time) {
    SolidParticles& p = part.body->particles();
    for_each_index(p.size(), [&](std::size_t i) { p.load[i] = p.mass[i] * gravity; });
    if (!part.surface) return;
    part.surface->follow(p);
    for (const SolidPressure& load : part.pressures) part.surface->add_pressure(load.face, load.pressure(time));
}

/// All parts by one step of the fastest, the k-th of their strides. A part's stress is that of the middle of its stride, which
/// its velocity tells, and acts all through it beside the contact: alone it then goes the way of (20.11).    THEORY (20.15)
void fast_step(SolidSystem& system, double time, double dt, int k) {
    const double middle = time + 0.5 * dt, end = time + dt;
    for (auto& part : system.parts) {
        SolidBody& body = *part->body;
        if (k % part->stride == 0) {   // at the middle of the stride, as far as it is known; then back
            const double stride = part->stride * dt;
            body.drift(0.5 * stride, time + 0.5 * stride);
            body.compute_force(time + 0.5 * stride);
            if (!system.is_relaxed) body.forget_motion();
            part->drag = system.is_relaxed ? 2 * body.find_present_frequency(stride) : 0;
            if (part->stride > 1) body.drift(0.5 * (dt - stride), middle);
        } else {
            body.drift(0.5 * dt, middle);
        }
        compute_loads(*part, system.gravity, middle);
    }
    for (auto& contact : system.contacts) contact->add_forces(middle, dt);
    for (auto& part : system.parts) {
        SolidBody& body = *part->body;
        if (part->surface) part->surface->push(body.particles());
        body.kick(dt, time, part->drag);
        body.drift(0.5 * dt, end);
    }
}

}   // namespace

double stable_step(const SolidSystem& system) {
    double dt = std::numeric_limits<double>::infinity();
    for (const auto& part : system.parts) dt = std::min(dt, part->body->stable_step());
    return dt;
}

double choose_strides(SolidSystem& system) {
    std::vector<double> steps;
    for (const auto& part : system.parts) steps.push_back(part->body->stable_step());
    const double fastest = *std::min_element(steps.begin(), steps.end());
    for (std::size_t k = 0; k < steps.size(); ++k) {
        int& stride = system.parts[k]->stride;
        for (stride = 1; stride < longest_stride && 3 * stride * fastest <= steps[k];) stride *= 3;
    }
    return strides_in_step(system) * fastest;
}

int strides_in_step(const SolidSystem& system) {
    int most = 1;
    for (const auto& part : system.parts) most = std::max(most, part->stride);
    return most;
}

void solid_step(SolidSystem& system, double time, double dt) {
    const int count = strides_in_step(system);
    for (int k = 0; k < count; ++k) fast_step(system, time + k * (dt / count), dt / count, k);
}

}   // namespace patency
