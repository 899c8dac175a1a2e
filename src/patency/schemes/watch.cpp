// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/watch.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

// The speed of sound is at least ten times the largest expected speed, THEORY.md (2.4): a particle this many
// times faster than sound has diverged.
constexpr double largest_mach_number = 20;

[[noreturn]] void report_divergence(const FluidParticles& fluid, double sound_speed) {
    std::size_t worst = 0;   // the first that is no number, or else the fastest
    double largest = -1;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double v2 = dot(fluid.velocity[i], fluid.velocity[i]);
        if (v2 <= largest) continue;
        worst = i, largest = v2;
        if (v2 != v2) break;
    }
    const Vec3 &x = fluid.position[worst], &v = fluid.velocity[worst];
    throw DivergedError(
        fmt::format("the flow diverged: particle at ({:.4g}, {:.4g}, {:.4g}) m has velocity "
                    "({:.3g}, {:.3g}, {:.3g}) m/s and pressure {:.3g} Pa; the sound speed is {:.3g} m/s",
                    x.x, x.y, x.z, v.x, v.y, v.z, fluid.pressure[worst], sound_speed));
}

}   // namespace

void check_precision(Precision precision, const Frame& frame) {
    if (precision == Precision::double_precision && frame.any_periodic())
        throw DeckError("numerics.precision: double is not available in a periodic box; use mixed");
}

void check_inside(const FluidParticles& fluid, const Frame& frame) {
    const double outside =
        sum_of(fluid.size(), [&](std::size_t i) { return frame.contains(fluid.position[i]) ? 0.0 : 1.0; });
    if (outside == 0) return;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vec3 &x = fluid.position[i], &v = fluid.velocity[i];
        if (!frame.contains(x))
            throw DivergedError(
                fmt::format("{} particles left the domain; the first is at ({:.4g}, {:.4g}, {:.4g}) m with "
                            "velocity ({:.3g}, {:.3g}, {:.3g}) m/s and pressure {:.3g} Pa",
                            outside, x.x, x.y, x.z, v.x, v.y, v.z, fluid.pressure[i]));
    }
}

double find_fastest(const FluidParticles& fluid, double sound_speed) {
    const double fastest = std::sqrt(largest_of(fluid.size(), [&](std::size_t i) {
        const double v2 = dot(fluid.velocity[i], fluid.velocity[i]);
        return v2 == v2 ? v2 : std::numeric_limits<double>::infinity();   // a NaN must not vanish in a comparison
    }));
    if (!(fastest < largest_mach_number * sound_speed)) report_divergence(fluid, sound_speed);
    return fastest;
}

}   // namespace patency
