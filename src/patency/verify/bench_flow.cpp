// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/bench_flow.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/base/median.h"
#include "patency/stages/build.h"
#include "patency/stages/flow.h"
#include "patency/stages/initial_state.h"
#include "patency/verify/cpu_time.h"

namespace patency {

namespace {

struct Setup {
    int across;      // particles over the diameter
    double length;   // in diameters
    deck::Precision precision;
    LoopKind loop = LoopKind::packed;
};

constexpr double diameter = 4e-3;   // m, a coronary artery

deck::Case make_case(const Setup& setup) {
    deck::Case c;
    c.about.name = "bench";
    deck::Shape shape;
    shape.type = deck::ShapeType::tube;
    shape.diameter = diameter;
    shape.length = setup.length * diameter;
    c.geometry.shape = shape;
    c.blood.density = 1060;
    c.blood.viscosity = 3.5e-3;
    const double mean = 100 * c.blood.viscosity / (c.blood.density * diameter);   // Re 100
    deck::Opening inlet, outlet;
    inlet.type = deck::OpeningType::velocity;
    inlet.profile = deck::VelocityProfile::parabola;
    inlet.velocity = mean;
    outlet.type = deck::OpeningType::pressure;
    outlet.pressure = 0;
    c.openings = {{"inlet", inlet}, {"outlet", outlet}};
    c.initial = {deck::InitialVelocity::parabola, mean, deck::InitialPressure::linear};
    c.numerics.spacing = diameter / setup.across;
    c.numerics.sound_speed_factor = 10;
    c.numerics.reference_speed = 2 * mean;
    c.numerics.precision = setup.precision;
    c.numerics.duration = 1;
    return c;
}

/// Particles on rings around the axis: as even as a relaxed lattice where it matters for speed, and there at once.
std::unique_ptr<Scene> make_pipe(const Setup& setup) {
    auto scene = build_frame(make_case(setup));
    scene->numerics.loop = setup.loop;
    const double dp = scene->numerics.spacing, radius = 0.5 * diameter, length = setup.length * diameter;
    const int layers = int(std::lround(length / dp)), buffer = int(buffer_spacings),
              beyond = buffer + 3;   // + the kernel's support
    const double wall_end = radius + 3.2 * dp;
    struct Point {
        Vec3 x;
        double depth;
        std::int32_t opening;
    };
    std::vector<Point> fluid, wall;
    for (int i = -beyond; i < layers + beyond; ++i)
        for (int k = 0; (k + 0.5) * dp < wall_end; ++k) {
            const double r = (k + 0.5) * dp, x = (i + 0.5) * dp;
            const int count = std::max(1, int(std::lround(2 * std::numbers::pi * r / dp)));
            const double turn = 2.399963 * (i + beyond) + 1.7 * k;   // golden angle: layers and rings do not line up
            for (int a = 0; a < count; ++a) {
                const double angle = turn + 2 * std::numbers::pi * a / count;
                const Point p{{x, r * std::cos(angle), r * std::sin(angle)},
                              r - radius,
                              i < 0         ? 1
                              : i >= layers ? 2
                                            : 0};
                if (r > radius)
                    wall.push_back(p);
                else if (i >= -buffer && i < layers + buffer)
                    fluid.push_back(p);
            }
        }
    const double volume = dp * dp * dp;
    scene->fluid.resize(fluid.size());
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        scene->fluid.position[i] = fluid[i].x;
        scene->fluid.opening[i] = fluid[i].opening;
        scene->fluid.volume[i] = volume;
    }
    scene->wall.resize(wall.size());
    for (std::size_t i = 0; i < wall.size(); ++i) {
        const Vec3& x = wall[i].x;
        const double r = std::hypot(x.y, x.z);
        scene->wall.position[i] = x;
        scene->wall.normal[i] = {0, x.y / r, x.z / r};
        scene->wall.depth[i] = wall[i].depth;
        scene->wall.curvature[i] = 1 / radius;
        scene->wall.volume[i] = volume;
    }
    for (OpenEnd& end : scene->ends) end.buffer_length = buffer * dp;
    compute_initial_state(*scene);
    start_scheme(*scene);
    return scene;
}

struct Measured {
    double particle_steps = 0, cpu_s = 0;
    std::int64_t particles = 0;
    std::vector<double> rates;   // particle-steps per second of every round

    double per_cpu_s() const { return particle_steps / cpu_s; }
};

/// A pipe that steps when it is its turn.
struct Runner {
    std::unique_ptr<Scene> scene;
    int threads, steps;   // in all rounds together
    Measured measured{};
};

std::int64_t step(Scene& scene) {
    const FlowStep done = scene.scheme->step(scene.time, 1);
    scene.time += done.dt;
    return done.acoustic_steps;
}

void advance(Runner& runner, int steps) {
    omp_set_num_threads(runner.threads);
    const double cpu = cpu_seconds();
    const auto start = std::chrono::steady_clock::now();
    double done = 0;
    for (int k = 0; k < steps; ++k) {
        const double count = double(runner.scene->fluid.size());
        done += count * double(step(*runner.scene));
    }
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Measured& all = runner.measured;
    all.particle_steps += done, all.cpu_s += cpu_seconds() - cpu;
    all.rates.push_back(done / wall);
}

/// Both under the clock for all their steps, in rounds by turns: a machine that others slow down for a while slows both.
/// Two steps before fill caches and arrays.
void measure_by_turns(Runner& a, Runner& b) {
    for (Runner* runner : {&a, &b}) {
        omp_set_num_threads(runner->threads);
        step(*runner->scene), step(*runner->scene);
        runner->measured.particles = std::int64_t(runner->scene->fluid.size());
    }
    const int rounds = std::min({a.steps, b.steps, 15});   // odd: one of them is the median
    for (int k = 0; k < rounds; ++k)
        for (Runner* runner : {&a, &b}) advance(*runner, runner->steps * (k + 1) / rounds - runner->steps * k / rounds);
}

double answer_error(const Scene& a, const Scene& b) {
    if (a.fluid.size() != b.fluid.size()) return 1;
    double velocity = 0, position = 0, speed = 0, extent = 0;
    for (std::size_t i = 0; i < a.fluid.size(); ++i) {
        velocity = std::max(velocity, norm(a.fluid.velocity[i] - b.fluid.velocity[i]));
        position = std::max(position, norm(a.fluid.position[i] - b.fluid.position[i]));
        speed = std::max(speed, norm(b.fluid.velocity[i]));
        extent = std::max(extent, norm(b.fluid.position[i]));
    }
    return std::max(velocity / speed, position / extent);
}

/// About ten million particle-steps, six acoustic in each advection step.
Runner make_runner(const Setup& setup, int threads, const BenchRequest& request) {
    auto scene = make_pipe(setup);
    const int steps = std::max(2, int(std::lround(request.effort * 1e7 / (6 * double(scene->fluid.size())))));
    return {std::move(scene), threads, steps};
}

constexpr const char* rate_unit = "particle-steps per CPU-second";

BenchResult bench_against_reference(const std::string& name, Setup setup, const BenchRequest& request) {
    Runner packed = make_runner(setup, request.threads, request);
    setup.loop = LoopKind::reference;
    Runner slow = make_runner(setup, request.threads, request);
    measure_by_turns(packed, slow);
    const Measured &fast = packed.measured, &reference = slow.measured;
    return {name,
            fast.particles,
            request.threads,
            fast.per_cpu_s(),
            rate_unit,
            reference.per_cpu_s(),
            fast.per_cpu_s() / reference.per_cpu_s(),
            answer_error(*packed.scene, *slow.scene)};
}

/// The median of what neighbouring turns give: for a while others may take one core of two, and that halves what two
/// threads do together but not what one does alone.
BenchResult bench_two_threads(const std::string& name, const Setup& setup, BenchRequest request) {
    request.effort *= 2;   // rounds of one step each, enough of them for a median
    Runner alone = make_runner(setup, 1, request), together = make_runner(setup, 2, request);
    measure_by_turns(alone, together);
    const std::vector<double>&one = alone.measured.rates, &two = together.measured.rates;
    std::vector<double> ratios;
    for (std::size_t k = 0; k < one.size(); ++k) ratios.push_back(two[k] / one[k]);
    return {name,
            together.measured.particles,
            2,
            median(two),
            "particle-steps per second",
            median(one),
            median(ratios),
            answer_error(*together.scene, *alone.scene)};
}

/// Of CPU time per particle-step, large over small: 1.1 is 10 % more.
BenchResult bench_growth(const std::string& name, const Setup& large, const Setup& small, const BenchRequest& request) {
    Runner of_small = make_runner(small, request.threads, request),
           of_large = make_runner(large, request.threads, request);
    measure_by_turns(of_small, of_large);
    const double cost = 1e9 / of_large.measured.per_cpu_s(), before = 1e9 / of_small.measured.per_cpu_s();
    return {name, of_large.measured.particles, request.threads, cost, "CPU-ns per particle-step", before, cost / before,
            0};
}

}   // namespace

std::vector<BenchResult> run_flow_bench(const BenchRequest& request) {
    using Bench = std::function<BenchResult(const std::string&)>;
    std::vector<std::pair<std::string, Bench>> benches;
    for (const auto& [tail, precision] :
         {std::pair{"mixed", deck::Precision::mixed}, std::pair{"double", deck::Precision::double_}}) {
        const std::string end = std::string("_") + tail;
        // 7.5 diameters at D/16 are 24,000 particles; 8 at D/32 are 206,000; D/25 and D/54 make 100,000 and 1,000,000.
        const Setup small{16, 7.5, precision}, large{32, 8, precision}, larger{25, 8, precision},
            largest{54, 8, precision};
        benches.emplace_back("pipe_d16" + end, [=, &request](const std::string& name) {
            return bench_against_reference(name, small, request);
        });
        benches.emplace_back("pipe_d32" + end, [=, &request](const std::string& name) {
            return bench_against_reference(name, large, request);
        });
        benches.emplace_back("two_threads" + end, [=, &request](const std::string& name) {
            return bench_two_threads(name, large, request);
        });
        benches.emplace_back("growth" + end, [=, &request](const std::string& name) {
            return bench_growth(name, largest, larger, request);
        });
    }
    std::vector<BenchResult> results;
    for (const auto& [name, bench] : benches) {
        const bool is_wanted = request.names.empty() || std::any_of(request.names.begin(), request.names.end(),
                                                                    [&name = name](const std::string& part) {
                                                                        return name.find(part) != std::string::npos;
                                                                    });
        if (!is_wanted) continue;
        results.push_back(bench(name));
        if (request.report) request.report(results.back());
    }
    if (results.empty())
        throw UsageError(
            "no benchmark has that name; there are pipe_d16, pipe_d32, two_threads, growth, each _mixed and _double");
    return results;
}

std::string format_bench(const std::vector<BenchResult>& results) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const BenchResult& r : results)
        list.push_back({{"name", r.name},
                        {"particles", r.particles},
                        {"threads", r.threads},
                        {"value", r.value},
                        {"unit", r.unit},
                        {"reference_value", r.reference_value},
                        {"ratio", r.ratio},
                        {"answer_error", r.answer_error}});
    return list.dump(1) + "\n";
}

}   // namespace patency
