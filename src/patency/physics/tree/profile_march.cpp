// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/tree/profile_march.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace patency {

namespace {

constexpr int rings = TreeProfile::rings;
using Rings = std::array<double, rings>;

/// Where rings meet, over the vessel's radius: edge i is the inner one of ring i. `spacing` is what a difference of speeds
/// across an edge (at the wall: of the last ring) is divided by for the slope there: exact for a parabola, whose rings of
/// equal area differ by as much everywhere.
struct RingEdges {
    std::array<double, rings + 1> radius, spacing;
};

const RingEdges& ring_edges() {
    static const RingEdges edges = [] {
        RingEdges e{};
        for (int i = 1; i <= rings; ++i) {
            const double radius = std::sqrt(double(i) / rings), share = i < rings ? 1 : 0.5;
            e.radius[std::size_t(i)] = radius;
            e.spacing[std::size_t(i)] = share / (2 * radius * rings);
        }
        return e;
    }();
    return edges;
}

/// What elimination leaves of an unknown: constant, times what follows it, times the pressure's change.
struct Eliminated {
    double constant = 0, next = 0, pressure = 0;
};

/// Speeds of the rings one step on, and the pressure's change [Pa], if they are found: implicit, by Newton's method.
/// Unknowns are the rings' speeds, the mass that crosses each edge outward (which follows from the speeds within) and the
/// pressure, so that a round costs two sweeps. Without the slopes of the mass the rounds are many, and behind a narrow throat
/// without end.                                                                           THEORY.md (15.2), (15.3)
std::optional<double> find_step(const TreeBlood& blood, double length, double ring_from, double ring_to, double flow,
                                Rings& speed) {
    const RingEdges& edges = ring_edges();
    const Rings before = speed;
    for (double& v : speed) v *= ring_from / ring_to;
    const double radius = std::sqrt(rings * ring_to / std::numbers::pi);
    const double ring_mass = blood.density * ring_to, push = -0.5 * (ring_from + ring_to);
    double change = 0;
    constexpr int most_rounds = 12;
    constexpr double tolerance = 1e-10;
    for (int round = 0; round < most_rounds; ++round) {
        std::array<Eliminated, rings> left;
        Eliminated inner, mass;   // changes of the speed within and of the mass through the edge to it
        double outward = 0, inner_friction = 0, escaped = 0;
        for (std::size_t i = 0; i < rings; ++i) {
            const bool at_wall = i + 1 == rings;
            const double v = speed[i], v_in = i > 0 ? speed[i - 1] : v, v_out = at_wall ? 0 : speed[i + 1];
            const double shear = std::abs(v - v_out) / (edges.spacing[i + 1] * radius);
            const double friction =
                blood.viscosity_at(shear) * 2 * std::numbers::pi * edges.radius[i + 1] * length / edges.spacing[i + 1];
            escaped = outward + blood.density * before[i] * ring_from - ring_mass * v;
            const double to_outer = at_wall ? 0 : escaped;
            // Blood at rest brings nothing from upstream. What runs back there is as hard to move as what runs on; what it
            // brings from downstream is not known, and its speed is small (Reyhner & Flugge-Lotz 1968).
            const double upstream = blood.density * std::abs(before[i]) * ring_from;
            const double from_inner = std::max(outward, 0.0) + inner_friction;
            const double from_outer = std::max(-to_outer, 0.0) + friction;
            const double force =
                upstream * (before[i] - v) + from_inner * (v_in - v) + from_outer * (v_out - v) + push * change;

            const double by_inner_mass = outward > 0 ? v_in - v : 0, by_outer_mass = to_outer < 0 ? v_out - v : 0;
            const double by_mass = by_inner_mass - by_outer_mass;
            const double by_own = -(upstream + from_inner + from_outer) + from_inner * inner.next +
                                  by_mass * mass.next + by_outer_mass * ring_mass;
            left[i].constant = -(force + from_inner * inner.constant + by_mass * mass.constant) / by_own;
            left[i].next = at_wall ? 0 : -from_outer / by_own;
            left[i].pressure = -(push + from_inner * inner.pressure + by_mass * mass.pressure) / by_own;

            const double by_speed = mass.next - ring_mass;
            mass = {mass.constant + by_speed * left[i].constant, by_speed * left[i].next,
                    mass.pressure + by_speed * left[i].pressure};
            inner = left[i];
            outward = to_outer, inner_friction = friction;
        }
        const double more = (-escaped - mass.constant) / mass.pressure;   // nothing crosses the wall
        change += more;
        double delta = 0, moved = 0;
        for (std::size_t i = rings; i-- > 0;) {
            delta = left[i].constant + left[i].next * delta + left[i].pressure * more;
            speed[i] += delta;
            moved = std::max(moved, std::abs(delta));
        }
        if (moved * rings * ring_to < tolerance * flow) return change;
    }
    return std::nullopt;
}

/// The same, in two halves where the whole is not found: behind a throat that lets next to nothing through a jet changes too much.
std::optional<double> step(const TreeBlood& blood, double length, double ring_from, double ring_to, double flow,
                           Rings& speed, int halvings = 0) {
    const Rings before = speed;
    if (const auto change = find_step(blood, length, ring_from, ring_to, flow, speed)) return change;
    constexpr int most_halvings = 8;
    if (halvings == most_halvings) return std::nullopt;
    speed = before;
    const double middle = std::sqrt(ring_from * ring_to);
    const auto first = step(blood, 0.5 * length, ring_from, middle, flow, speed, halvings + 1);
    if (!first) return std::nullopt;
    const auto second = step(blood, 0.5 * length, middle, ring_to, flow, speed, halvings + 1);
    return second ? std::optional(*first + *second) : std::nullopt;
}

}   // namespace

TreeProfile TreeProfile::between(double flat) {
    TreeProfile p;
    for (int i = 0; i < rings; ++i) p.speed[std::size_t(i)] = flat + (1 - flat) * 2 * (1 - (i + 0.5) / rings);
    return p;
}

TreeProfile TreeProfile::as_jet(double share) const {
    // Rings are sums of the flow between two shares of the area, so that the jet carries what the profile did.
    const auto flow_within = [&](double s) {
        const double x = std::min(s / share, 1.0) * rings;
        const auto whole = std::min(std::size_t(x), std::size_t(rings - 1));
        double sum = (x - double(whole)) * speed[whole];
        for (std::size_t i = 0; i < whole; ++i) sum += speed[i];
        return sum;
    };
    TreeProfile p;
    for (int i = 0; i < rings; ++i)
        p.speed[std::size_t(i)] = flow_within((i + 1.0) / rings) - flow_within(double(i) / rings);
    return p;
}

double TreeProfile::at(double share) const {
    // Middles lie at equal steps of the squared radius; the wall half a step behind the last.
    const double x = rings * share * share - 0.5;
    if (x <= 0) return speed[0];
    const auto i = std::size_t(x);
    if (i + 1 < rings) return speed[i] + (x - double(i)) * (speed[i + 1] - speed[i]);
    return speed[rings - 1] * std::clamp(2 * (rings - 0.5 - x), 0.0, 1.0);
}

ProfileAlong march_profile(const TreeBlood& blood, std::span<const double> arc, std::span<const double> area,
                           double flow, const TreeProfile& start) {
    ProfileAlong along{std::vector<double>(arc.size(), 0.0), std::vector<TreeProfile>(arc.size(), start)};
    if (!(flow > 0)) return along;
    Rings speed = start.speed;
    for (double& v : speed) v *= flow / area[0];
    // A profile changes most where it begins, and with the area.
    constexpr double first = 0.01, growth = 1.2, longest = 0.1, steepest = 0.02;   // of the diameter; of the area
    double share = first;
    for (std::size_t k = 1; k < arc.size(); ++k) {
        const double gap = arc[k] - arc[k - 1], steepness = std::log(area[k] / area[k - 1]) / gap;
        double at = 0, from = area[k - 1], pressure = along.pressure[k - 1];
        while (at < gap) {
            const double diameter = std::sqrt(4 * from / std::numbers::pi);
            double length = share * diameter;
            if (steepness != 0) length = std::min(length, steepest / std::abs(steepness));
            length = (gap - at) / std::max(1.0, std::ceil((gap - at) / length - 1e-9));   // no sliver at a station
            at = gap - at - length < 1e-9 * gap ? gap : at + length;
            const double to = at == gap ? area[k] : area[k - 1] * std::exp(steepness * at);
            const auto change = step(blood, length, from / rings, to / rings, flow, speed);
            if (!change) {   // more than any pressure drives through so narrow a place
                std::fill(along.pressure.begin() + std::ptrdiff_t(k), along.pressure.end(), NAN);
                return along;
            }
            pressure += *change;
            from = to;
            share = std::min(share * growth, longest);
        }
        along.pressure[k] = pressure;
        for (std::size_t i = 0; i < rings; ++i) along.profile[k].speed[i] = speed[i] * area[k] / flow;
    }
    return along;
}

}   // namespace patency
