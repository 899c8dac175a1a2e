// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/section_flow.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "patency/analysis/buckets.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

// A section that goes on beyond this many radii has run into another vessel.
constexpr int farthest_radii = 4;

/// Share of a square of side `side` that lies where a distance is negative, the zero line being straight across it.
double share_inside(double distance, double side) { return std::clamp(0.5 - distance / side, 0.0, 1.0); }

Vec3 in_plane(const Vec3& v, const Vec3& normal) { return v - dot(v, normal) * normal; }

}   // namespace

double SectionGrid::total_area() const {
    double sum = 0;
    for (double a : area) sum += a;
    return sum;
}

SectionGrid make_section_grid(const SectionPlane& plane, const WallHint& wall, int across) {
    const Vec3& n = plane.normal;
    const Vec3 a = unit_across(n), b = cross(n, a);
    const double side = plane.radius / across;
    const int half = farthest_radii * across, width = 2 * half + 1;
    const auto place = [&](int i, int j) {
        return plane.centre + side * (double(i - half) * a + double(j - half) * b);
    };

    SectionGrid grid;
    grid.normal = n, grid.side = side;
    // Flood from the centre over squares that have a part in the lumen.
    std::vector<std::uint8_t> seen(std::size_t(width) * std::size_t(width), 0);
    std::vector<std::pair<int, int>> next{{half, half}};
    seen[std::size_t(half) * std::size_t(width) + std::size_t(half)] = 1;
    while (!next.empty()) {
        const auto [i, j] = next.back();
        next.pop_back();
        Vec3 x = place(i, j);
        const double distance = wall.distance(x), share = share_inside(distance, side);
        if (share == 0) continue;
        if (share < 1) x -= 0.5 * (1 - share) * side * in_plane(wall.normal(x), n);   // the middle of what is inside
        grid.place.push_back(x), grid.area.push_back(share * side * side);
        for (const auto& [u, v] : {std::pair{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}}) {
            if (u < 0 || v < 0 || u >= width || v >= width) {
                grid.closed = false;
                continue;
            }
            std::uint8_t& flag = seen[std::size_t(v) * std::size_t(width) + std::size_t(u)];
            if (!flag) flag = 1, next.push_back({u, v});
        }
    }
    return grid;
}

SectionShape shape_of(const SectionGrid& grid) {
    SectionShape shape{{}, grid.normal, grid.total_area(), 0};
    for (std::size_t k = 0; k < grid.place.size(); ++k) shape.centre += grid.area[k] / shape.area * grid.place[k];
    for (std::size_t k = 0; k < grid.place.size(); ++k) {
        const Vec3 d = grid.place[k] - shape.centre;
        shape.mean_square += grid.area[k] / shape.area * dot(d, d);
    }
    return shape;
}

namespace {

constexpr double slab_share = 0.75;   // of the reach, 2.6 spacings: two layers on both sides

/// The flow through a section from the particles whose feet on its plane lie in its squares.
double flow_of_particles(const FluidParticles& fluid, const Frame& frame, const SectionGrid& grid,
                         const LocalLength& reach) {
    const SectionShape shape = shape_of(grid);
    const double slab = slab_share * reach(shape.centre), half_diagonal = std::sqrt(0.5) * grid.side;
    const Buckets buckets(std::span(fluid.position.begin(), fluid.size()), frame, grid.place, slab + half_diagonal);
    std::vector<std::uint32_t> near;
    for (std::size_t k = 0; k < grid.place.size(); ++k) {
        buckets.for_each_near(grid.place[k], [&](std::uint32_t i) {
            const Vec3 e = fluid.position[i] - grid.place[k];
            if (std::abs(dot(e, grid.normal)) < slab && norm(in_plane(e, grid.normal)) < half_diagonal)
                near.push_back(i);
        });
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<OpenEnd::Member> members;
    for (std::uint32_t i : near) {
        const double s = dot(fluid.position[i] - shape.centre, grid.normal);
        members.push_back({i, s, (1 - std::abs(s) / slab) * fluid.volume[i]});
    }
    return flow_of_section(shape, fluid, members);
}

}   // namespace

std::vector<SectionFlow> flow_through_sections(const FluidParticles& fluid, const Frame& frame,
                                               std::span<const SectionGrid> sections, const LocalLength& reach,
                                               const WallHint& wall) {
    std::vector<Vec3> places;
    for (const SectionGrid& s : sections) places.insert(places.end(), s.place.begin(), s.place.end());
    const auto samples = sample_flow(fluid, frame, places, reach, false, &wall);

    std::vector<std::size_t> first(1, 0);   // place of every section, and one more
    for (const SectionGrid& s : sections) first.push_back(first.back() + s.place.size());
    std::vector<SectionFlow> result(sections.size());
    for_each_task(sections.size(), [&](std::size_t n) {
        const SectionGrid& s = sections[n];
        SectionFlow r{s.total_area(), 0, 0, 0, 0};
        double seen = 0;
        for (std::size_t k = 0; k < s.place.size(); ++k) {
            const FlowSample& sample = samples[first[n] + k];
            if (sample.neighbours == 0) continue;
            const double along = dot(sample.velocity, s.normal);
            seen += s.area[k];
            r.pressure += s.area[k] * sample.pressure;
            r.peak_velocity = std::max(r.peak_velocity, along);
        }
        r.pressure /= seen;   // nothing over nothing, where no blood was near
        r.flow = seen > 0 ? flow_of_particles(fluid, frame, s, reach) : NAN;
        r.mean_velocity = r.flow / r.area;
        result[n] = r;
    });
    return result;
}

namespace {

/// What is averaged of a section, in the order of a state.
constexpr double SectionFlow::*averaged[] = {&SectionFlow::area, &SectionFlow::flow, &SectionFlow::pressure,
                                             &SectionFlow::mean_velocity, &SectionFlow::peak_velocity};

}   // namespace

void SectionFlowMeans::add(std::span<const SectionFlow> sections, double level) {
    sum_.resize(sections.size()), squares_.resize(sections.size());
    for (std::size_t k = 0; k < sections.size(); ++k) {
        SectionFlow now = sections[k];
        now.pressure += level;
        for (const auto member : averaged)
            sum_[k].*member += now.*member, squares_[k].*member += now.*member * now.*member;
    }
    ++instants_;
}

std::vector<SectionFlow> SectionFlowMeans::mean() const {
    std::vector<SectionFlow> means = sum_;
    for (SectionFlow& m : means)
        for (const auto member : averaged) m.*member /= double(instants_);
    return means;
}

std::vector<SectionFlow> SectionFlowMeans::deviation() const {
    std::vector<SectionFlow> result = mean();
    for (std::size_t k = 0; k < result.size(); ++k)
        for (const auto member : averaged) {
            double& value = result[k].*member;
            value = std::sqrt(std::max(0.0, squares_[k].*member / double(instants_) - value * value));
        }
    return result;
}

std::vector<double> SectionFlowMeans::state() const {
    std::vector<double> state{double(instants_)};
    for (std::size_t k = 0; k < sum_.size(); ++k)
        for (const auto member : averaged) state.push_back(sum_[k].*member), state.push_back(squares_[k].*member);
    return state;
}

void SectionFlowMeans::restore(std::span<const double> state) {
    instants_ = std::size_t(state[0]);
    sum_.assign((state.size() - 1) / (2 * std::size(averaged)), {}), squares_ = sum_;
    std::size_t n = 1;
    for (std::size_t k = 0; k < sum_.size(); ++k)
        for (const auto member : averaged) sum_[k].*member = state[n++], squares_[k].*member = state[n++];
}

}   // namespace patency
