// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/bench_solid.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/bodies/solid_shape.h"
#include "patency/schemes/solid_step.h"
#include "patency/verify/cpu_time.h"

namespace patency {

namespace {

constexpr int across = 58;                 // 195,112 particles
constexpr double spacing = 1e-3;           // m
constexpr double smoothing_ratio = 1.35;   // 76 neighbours in a block of this size

/// A block that rings: a smooth wave of two percent along each axis.
SolidSystem make_block(const SolidLaw& law, Precision precision, LoopKind loop) {
    SolidSystem system;
    auto part = std::make_unique<SolidPart>();
    part->solid.materials = {{1000, law}};
    const double side = across * spacing;
    const SolidFill fill = fill_box({0, 0, 0}, {side, side, side}, spacing, false);
    place_particles(part->solid, fill.places, fill.volumes.front());
    SolidNumerics numerics;
    numerics.spacing = spacing, numerics.smoothing_ratio = smoothing_ratio, numerics.viscosity = 0.1;
    numerics.precision = precision, numerics.loop = loop;
    SolidParticles& p = part->solid.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 q = (2 * 3.14159265358979 / side) * p.reference[i];
        p.position[i] =
            p.reference[i] + 0.02 * spacing * across / 6 * Vec3{std::sin(q.y), std::sin(q.z), std::sin(q.x)};
    }
    part->body = make_solid_body(part->solid, numerics);
    system.parts.push_back(std::move(part));
    return system;
}

struct Measured {
    double rate;   // particle-steps per CPU-second
    std::vector<Vec3> places;
};

/// Two steps to fill caches, then the clock.
Measured measure(SolidSystem& system, int steps, double dt) {
    double time = 0;
    const auto step = [&] { solid_step(system, time, dt), time += dt; };
    step(), step();
    const double cpu = cpu_seconds();
    for (int k = 0; k < steps; ++k) step();
    const double spent = cpu_seconds() - cpu;
    const SolidParticles& p = system.parts[0]->body->particles();
    return {double(p.size()) * steps / spent, {p.position.begin(), p.position.end()}};
}

BenchResult bench_block(const std::string& name, const SolidLaw& law, Precision precision,
                        const BenchRequest& request) {
    omp_set_num_threads(request.threads);
    SolidSystem fast = make_block(law, precision, LoopKind::packed),
                slow = make_block(law, precision, LoopKind::reference);
    const double dt = stable_step(fast);
    const int steps = std::max(3, int(std::lround(20 * request.effort)));
    const Measured packed = measure(fast, steps, dt), reference = measure(slow, steps, dt);
    double error = 0;
    for (std::size_t i = 0; i < packed.places.size(); ++i)
        error = std::max(error, norm(packed.places[i] - reference.places[i]) / (across * spacing));
    return {name,
            std::int64_t(packed.places.size()),
            request.threads,
            packed.rate,
            "particle-steps per CPU-second",
            reference.rate,
            packed.rate / reference.rate,
            error};
}

}   // namespace

std::vector<BenchResult> run_solid_bench(const BenchRequest& request) {
    const ElasticModuli rubber = elastic_moduli({.young = 1e6, .poisson = 0.45, .shear = {}, .bulk = {}});
    const ElasticModuli steel = elastic_moduli({.young = 193e9, .poisson = 0.3, .shear = {}, .bulk = {}});
    const SolidLaw elastic = NeoHookean::from(rubber),
                   metal = J2Plastic{steel, {.yield = 205e6, .slope = 1.5e9, .saturation = 0, .rate = 0}};
    struct Bench {
        std::string name;
        const SolidLaw& law;
        Precision precision;
    };
    std::vector<BenchResult> results;
    for (const Bench& b :
         {Bench{"block_mixed", elastic, Precision::mixed}, Bench{"block_double", elastic, Precision::double_precision},
          Bench{"metal_mixed", metal, Precision::mixed}}) {
        const bool is_wanted = request.names.empty() ||
                               std::any_of(request.names.begin(), request.names.end(), [&](const std::string& part) {
                                   return b.name.find(part) != std::string::npos;
                               });
        if (!is_wanted) continue;
        results.push_back(bench_block(b.name, b.law, b.precision, request));
        if (request.report) request.report(results.back());
    }
    if (results.empty())
        throw UsageError("no benchmark has that name; there are block_mixed, block_double and metal_mixed");
    return results;
}

}   // namespace patency
