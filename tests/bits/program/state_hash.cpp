// SPDX-License-Identifier: Apache-2.0
// Runs a few steps of blood in a short pipe and prints a hash of the state after each. Compiled for several instruction
// sets by tests/CMakeLists.txt; bits_test.py compares what they print. Uses no function whose bits are the library's
// choice (sin, pow): only + - * / and square roots.
//
// usage: bits_ISA mixed|double STEPS       exit code 77: the processor lacks the instructions
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "patency/schemes/flow_scheme.h"
#include "patency/search/cells.h"

using namespace patency;

namespace {

bool processor_fits() {
#if defined(__AVX512F__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq");
#elif defined(__AVX2__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

/// FNV-1a, 64 bits.
std::uint64_t hash(std::uint64_t h, std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) h = (h ^ std::uint64_t(b)) * 0x100000001b3u;
    return h;
}

std::uint64_t hash_of(const ParticleSet& particles) {
    std::uint64_t h = 0xcbf29ce484222325u;
    for (const FieldBase* field : particles.fields())
        if (field->keep() == Keep::state) h = hash(h, field->bytes());
    return h;
}

constexpr double dp = 5e-4, radius = 2.5e-3, length = 6e-3, buffer_length = 4 * dp;

struct Points {
    std::vector<Vec3> blood, wall;
};

/// A lattice that the wall cuts, somewhat disordered by small whole numbers so that nothing cancels.
Points make_points() {
    Points points;
    std::uint32_t state = 1;
    const auto jitter = [&] {
        return 0.1 * dp * (double((state = state * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5);
    };
    const int across = 9, along = 12, beyond = 4;
    for (int i = -beyond - 6; i < along + beyond + 6; ++i)
        for (int j = -across; j < across; ++j)
            for (int k = -across; k < across; ++k) {
                Vec3 x{(i + 0.5) * dp, (j + 0.5) * dp, (k + 0.5) * dp};
                const double r = std::sqrt(x.y * x.y + x.z * x.z);
                if (r > radius + 3.2 * dp) continue;
                if (r > radius)
                    points.wall.push_back(x);
                else if (i >= -beyond && i < along + beyond)
                    points.blood.push_back({x.x + jitter(), x.y + jitter(), x.z + jitter()});
            }
    return points;
}

}   // namespace

int main(int argc, char** argv) {
    if (!processor_fits()) return 77;
    if (argc != 3) return 2;
    const bool mixed = std::string_view(argv[1]) == "mixed";
    const int steps = argv[2][0] - '0';

    const Points points = make_points();
    FluidParticles fluid;
    WallParticles wall;
    const FluidMaterial blood{.density = 1060, .viscosity = 3.5e-3, .sound_speed = 3, .viscosity_at = {}};
    fluid.resize(points.blood.size());
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vec3& x = points.blood[i];
        fluid.position[i] = x;
        fluid.volume[i] = dp * dp * dp;
        fluid.viscosity[i] = blood.viscosity;
        fluid.opening[i] = x.x < 0 ? 1 : x.x > length ? 2 : 0;
        fluid.velocity[i] = {0.25 * (1 - (x.y * x.y + x.z * x.z) / (radius * radius)), 0.01 * x.z / radius, 0};
        fluid.pressure[i] = 20 * (1 - x.x / length);
    }
    wall.resize(points.wall.size());
    for (std::size_t i = 0; i < wall.size(); ++i) {
        const Vec3& x = points.wall[i];
        const double r = std::sqrt(x.y * x.y + x.z * x.z);
        wall.position[i] = x;
        wall.normal[i] = {0, x.y / r, x.z / r};
        wall.depth[i] = r - radius;
        wall.curvature[i] = 1 / radius;
        wall.volume[i] = dp * dp * dp;
    }
    std::vector<OpenEnd> ends(2);
    for (OpenEnd& end : ends)
        end.area = 3.14159265358979 * radius * radius, end.reach = 1.5 * radius, end.buffer_length = buffer_length;
    ends[0].kind = OpenEnd::Kind::velocity;
    ends[0].normal = {-1, 0, 0};
    ends[0].velocity = [](double t) {
        return [t](const Vec3& x) {
            return Vec3{(0.25 + 5 * t) * (1 - (x.y * x.y + x.z * x.z) / (radius * radius)), 0, 0};
        };
    };
    ends[1].kind = OpenEnd::Kind::pressure;
    ends[1].centre = {length, 0, 0}, ends[1].normal = {1, 0, 0};
    ends[1].resistance = 1e7;

    FlowNumerics numerics;
    numerics.spacing = dp;
    numerics.reference_speed = 0.3;
    const double beyond = buffer_length + 12 * dp, around = radius + 5 * dp;
    const Frame frame({-beyond, -around, -around}, {length + beyond, around, around},
                      2 * numerics.smoothing_ratio * dp);
    const FlowDomain domain{fluid, wall, ends, frame,
                            [](const Vec3& x) { return std::sqrt(x.y * x.y + x.z * x.z) - radius; }};
    const auto scheme =
        make_flow_scheme(mixed ? Precision::mixed : Precision::double_precision, domain, blood, numerics);

    double time = 0;
    for (int k = 0; k < steps; ++k) {
        const FlowStep step = scheme->step(time, 1);
        time += step.dt;
        std::uint64_t h = hash_of(fluid);
        for (const OpenEnd& end : ends) {
            const double measured[] = {end.flow, end.mean_pressure, end.slope, end.crossed_volume, step.dt};
            h = hash(h, std::as_bytes(std::span(measured)));
        }
        fmt::print("step {} particles {} acoustic {} flow {:.6g} hash {:016x}\n", k + 1, fluid.size(),
                   step.acoustic_steps, ends[1].flow, h);
    }
}
