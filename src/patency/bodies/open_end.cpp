// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/open_end.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "patency/base/parallel.h"

namespace patency {

namespace {
// How far inside the pressure is fitted, and how thick the slab is in which the flow is measured, in spacings.
constexpr double fit_depth = 4;
constexpr double slab_half_width = 2;
// How thick the slab around an entrance's section is.
constexpr double further_half_width = near_end - entrance_depth;
static_assert(fit_depth <= near_end);
// Over how many spacings beyond the plane the imposed pressure takes over. A particle that crosses the plane is not
// grasped at once: that would knock on the whole column of blood with every layer that passes.
constexpr double takeover = 1;
// A particle belongs to the buffer only this far beyond the plane: one that trembles across it would leave a copy each time
// it comes back. With a quarter of a spacing one in 4000 still does, and the vessel fills by a percent in a dozen transits.
constexpr double crossing_margin = 0.5;
double imposed_share(double s_in_spacings) {
    const double q = std::clamp(s_in_spacings / takeover, 0.0, 1.0);
    return q * q * (3 - 2 * q);
}

/// The velocity of blood that is about to enter at the far end of a buffer: as inside, at the same place of the section.
/// A copy of the parent's would close a loop that only adds up the errors of the buffer. Exact for quadratic profiles,
/// with the mean of both ends' gradients.                                                           THEORY.md (8.7)
Vec3 velocity_inside(const FluidParticles& fluid, const OpenEnd& end, std::uint32_t parent, double spacing) {
    const double depth = 0.5 * fit_depth * spacing, reach = depth;
    const Vec3 x = fluid.position[parent] - (end.axial(fluid.position[parent]) + depth) * end.normal;
    double sum = 0;
    Vec3 velocity{};
    for (const auto& m : end.inside) {
        const Vec3 d = x - fluid.position[m.index];
        const double q = dot(d, d) / (reach * reach);
        if (q >= 1) continue;
        const double w = (1 - q) * (1 - q);
        const Mat3 gradient = 0.5 * (fluid.velocity_gradient[m.index] + fluid.velocity_gradient[parent]);
        sum += w;
        velocity += w * (fluid.velocity[m.index] + gradient * d);
    }
    return sum > 0 ? velocity / sum : fluid.velocity[parent];
}

/// What a straight line y(x) through weighted points is found from.
struct LineSums {
    double w = 0, x = 0, xx = 0, y = 0, xy = 0;

    LineSums operator+(const LineSums& o) const { return {w + o.w, x + o.x, xx + o.xx, y + o.y, xy + o.xy}; }
    double slope() const {
        const double det = w * xx - x * x;
        return det > 0 ? (w * xy - x * y) / det : 0;
    }
    double value_at(double place) const { return w > 0 ? y / w + slope() * (place - x / w) : 0; }
    /// Of the line that has this value at 0.
    double slope_through(double value) const { return xx > 0 ? (xy - value * x) / xx : 0; }
};

template <class X, class Y>
LineSums line_sums(std::span<const OpenEnd::Member> members, X x_of, Y y_of) {
    return reduce(
        members.size(), LineSums{},
        [&](std::size_t k) -> LineSums {
            const OpenEnd::Member& m = members[k];
            const double w = m.weight, x = x_of(m), y = y_of(m);
            return {w, w * x, w * x * x, w * y, w * x * y};
        },
        std::plus<>());
}

}   // namespace

void find_members(const FluidParticles& fluid, double spacing, std::span<OpenEnd> ends) {
    for (OpenEnd& end : ends) {
        end.buffer.clear();
        end.inside.clear();
        end.section.clear();
        end.entrance.clear();
        end.further.clear();
        end.section_depth = 0.5 * fit_depth * spacing;
    }
    if (ends.empty()) return;
    const auto& x = fluid.position;
    // The scan is parallel, the lists are filled in order.
    std::vector<std::vector<std::uint32_t>> near((fluid.size() + block_size - 1) / block_size);
    for_each_block(fluid.size(), [&](std::size_t begin, std::size_t stop) {
        auto& list = near[begin / block_size];
        for (std::size_t i = begin; i < stop; ++i)
            for (const OpenEnd& end : ends)
                if (end.axial(x[i]) > -near_end * spacing && end.in_reach(x[i])) {
                    list.push_back(std::uint32_t(i));
                    break;
                }
    });
    for (const auto& list : near)
        for (const std::uint32_t i : list)
            for (std::size_t k = 0; k < ends.size(); ++k) {
                OpenEnd& end = ends[k];
                const double s = end.axial(x[i]);
                if (end.entrance_section && fluid.opening[i] == 0 && end.in_reach(x[i])) {
                    const double depth = -s / spacing, off = std::abs(depth - entrance_depth) / further_half_width;
                    if (depth < entrance_depth) end.entrance.push_back({i, s, 1});
                    if (off < 1)
                        end.further.push_back({i, s + entrance_depth * spacing, (1 - off * off) * fluid.volume[i]});
                }
                const bool member = std::abs(fluid.opening[i]) == std::int32_t(k) + 1;
                if (!member && (fluid.opening[i] != 0 || s <= -fit_depth * spacing || !end.in_reach(x[i]))) continue;
                if (member)
                    end.buffer.push_back({i, s, imposed_share(s / spacing)});
                else {   // a weight that vanishes at both ends: nothing jumps when a particle passes
                    const double share = std::max(0.0, -s / (fit_depth * spacing));
                    end.inside.push_back({i, s, share * (1 - share) * fluid.volume[i]});
                }
                const double hat = 1 - std::abs(s) / (slab_half_width * spacing);
                if (hat > 0) end.section.push_back({i, s, hat * fluid.volume[i]});
            }
}

void fit_pressure(OpenEnd& end, double impedance, const std::function<double(std::uint32_t)>& pressure) {
    const LineSums sums = line_sums(
        end.inside, [](const OpenEnd::Member& m) { return m.s; },
        [&](const OpenEnd::Member& m) { return pressure(m.index); });
    const double free_slope = sums.slope(), free_mean = sums.value_at(0);
    if (end.kind == OpenEnd::Kind::velocity) {
        end.slope = free_slope;
        end.mean_pressure = free_mean;
        return;
    }
    // A pressure p at the plane lets the flow answer by (free_mean - p) / (rho c) times the area.
    const double answer = end.area / impedance;
    end.mean_pressure =
        (end.pressure + end.resistance * (end.flow + answer * free_mean)) / (1 + end.resistance * answer);
    end.slope = sums.slope_through(end.mean_pressure);
}

double flow_of_section(const SectionShape& section, const FluidParticles& fluid,
                       std::span<const OpenEnd::Member> members) {
    const LineSums sums = line_sums(
        members,
        [&](const OpenEnd::Member& m) {
            const Vec3 d = fluid.position[m.index] - section.centre;
            return dot(d, d) - m.s * m.s;
        },
        [&](const OpenEnd::Member& m) { return dot(fluid.velocity[m.index], section.normal); });
    return section.area * sums.value_at(section.mean_square);
}

void measure_flow(OpenEnd& end, const FluidParticles& fluid, double t, double share) {
    if (end.imposed_flow) {
        end.flow = end.share(t) * end.imposed_flow(t);
        return;
    }
    const SectionShape section{end.centre, end.normal, end.area, end.mean_square};
    const double at_plane = flow_of_section(section, fluid, end.section);
    if (share > 0)
        end.flow_excess += share * (at_plane - flow_of_section(section, fluid, end.inside) - end.flow_excess);
    end.flow = at_plane - end.flow_excess;
}

void exchange_particles(FluidParticles& fluid, double spacing, double tail, std::span<OpenEnd> ends) {
    if (ends.empty()) return;
    struct Copy {
        std::uint32_t parent;
        std::int32_t opening;
        Vec3 velocity;
    };
    std::vector<Copy> copies;
    std::vector<bool> removed(fluid.size(), false);
    for (std::size_t k = 0; k < ends.size(); ++k) {
        OpenEnd& end = ends[k];
        const std::int32_t number = std::int32_t(k) + 1;
        for (const auto& m : end.buffer) {
            const std::uint32_t i = m.index;
            const double s = end.axial(fluid.position[i]);
            removed[i] = fluid.opening[i] < 0 || s > end.buffer_length;
            if (removed[i] || s >= 0) continue;
            fluid.opening[i] = 0;
            copies.push_back(
                {i, number,
                 end.kind == OpenEnd::Kind::pressure ? velocity_inside(fluid, end, i, spacing) : fluid.velocity[i]});
            end.crossed -= 1;
            end.crossed_volume -= fluid.volume[i];
        }
        for (const auto& m : end.inside) {
            if (!(end.axial(fluid.position[m.index]) >= crossing_margin * spacing)) continue;
            fluid.opening[m.index] = number;
            end.crossed += 1;
            end.crossed_volume += fluid.volume[m.index];
        }
        // The buffer goes on as if it repeated itself, so that its last particles have neighbours on all sides.
        const auto add_tail = [&](const OpenEnd::Member& m) {
            if (fluid.opening[m.index] == number && !removed[m.index] && end.axial(fluid.position[m.index]) < tail)
                copies.push_back({m.index, -number, fluid.velocity[m.index]});
        };
        for (const auto& m : end.buffer) add_tail(m);
        for (const auto& m : end.inside) add_tail(m);
    }
    std::vector<std::uint32_t> order;
    order.reserve(fluid.size() + copies.size());
    for (std::uint32_t i = 0; i < fluid.size(); ++i)
        if (!removed[i]) order.push_back(i);
    const std::size_t first_copy = order.size();
    for (const Copy& copy : copies) order.push_back(copy.parent);
    fluid.take(order);
    for (std::size_t c = 0; c < copies.size(); ++c) {
        const OpenEnd& end = ends[std::size_t(std::abs(copies[c].opening)) - 1];
        fluid.position[first_copy + c] += end.buffer_length * end.normal;
        fluid.opening[first_copy + c] = copies[c].opening;
        fluid.velocity[first_copy + c] = copies[c].velocity;
    }
}

}   // namespace patency
