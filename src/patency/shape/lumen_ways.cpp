// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/lumen_ways.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <queue>
#include <unordered_map>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/shape/surface.h"

namespace patency {

namespace {

constexpr double infinity = Bounds::infinity;
constexpr std::size_t most_cells = 3'000'000;   // of one size: a second or two; throats of 0.1 mm in a coronary tree
constexpr int most_levels = 14;                 // so that a cell's place and level fit 64 bits

/// A cell of the cube around the lumen, halved `level` times.
struct Cell {
    int level;
    std::array<std::int64_t, 3> at;

    std::uint64_t key() const {
        return (std::uint64_t(level) << 60) | (std::uint64_t(at[0]) << 40) | (std::uint64_t(at[1]) << 20) |
               std::uint64_t(at[2]);
    }
};

struct KeyHash {
    std::size_t operator()(std::uint64_t key) const {
        key *= 0x9E3779B97F4A7C15ull;   // a large odd factor spreads neighbours
        return std::size_t(key ^ (key >> 29));
    }
};

/// Balls on cells, and which of them overlap. The first balls are those at the openings' centres.
class BallGraph {
public:
    BallGraph(const SignedDistance& distance, const std::vector<Opening>& openings)
        : distance_(distance), openings_(openings) {
        Bounds ends{openings[0].centre, openings[0].centre};
        double reach = 0;
        for (const Opening& o : openings) {
            ends = joined(ends, {o.centre, o.centre});
            reach = std::max(reach, o.reach);
            const double radius = -distance.value(o.centre);
            if (!(radius > 0))
                throw GeometryError(fmt::format(
                    "The centre of the opening {} does not lie inside the vessel, so no centreline can end there: "
                    "cut the vessel where it is round.",
                    o.name));
            balls_.push_back({o.centre, radius});
        }
        // A lumen that goes on straight for ever is looked at between its openings.
        const Bounds box = distance.bounds(), near = grown(ends, 2 * reach);
        const auto finite_or = [](double x, double instead) { return std::isfinite(x) ? x : instead; };
        corner_ = {finite_or(box.low.x, near.low.x), finite_or(box.low.y, near.low.y),
                   finite_or(box.low.z, near.low.z)};
        const Vec3 size = Vec3{finite_or(box.high.x, near.high.x), finite_or(box.high.y, near.high.y),
                               finite_or(box.high.z, near.high.z)} -
                          corner_;
        cell_ = std::max(reach, std::max({size.x, size.y, size.z}) / 100);
        count_ = {std::int64_t(std::ceil(size.x / cell_)), std::int64_t(std::ceil(size.y / cell_)),
                  std::int64_t(std::ceil(size.z / cell_))};
    }

    /// Halves cells until all openings hang together.
    void grow() {
        std::vector<Cell> cells;
        for (std::int64_t x = 0; x < count_[0]; ++x)
            for (std::int64_t y = 0; y < count_[1]; ++y)
                for (std::int64_t z = 0; z < count_[2]; ++z) cells.push_back({0, {x, y, z}});
        for (int level = 0; level < most_levels && cells.size() < most_cells; ++level) {
            std::vector<Cell> open = take_balls(cells, cell_ / double(1 << level));
            join_new_balls();
            if (are_joined()) return;
            cells.clear();
            for (const Cell& c : open)
                for (int child = 0; child < 8; ++child)
                    cells.push_back(
                        {level + 1,
                         {2 * c.at[0] + (child >> 2), 2 * c.at[1] + (child >> 1 & 1), 2 * c.at[2] + (child & 1)}});
        }
        throw_not_joined(cells.empty() ? 0 : cell_ / double(1 << cells[0].level));
    }

    std::vector<std::vector<Ball>> ways_from(std::size_t inlet) const {
        const std::vector<std::uint32_t> previous = cheapest_from(std::uint32_t(inlet));
        std::vector<std::vector<Ball>> ways;
        for (std::uint32_t outlet = 0; outlet < openings_.size(); ++outlet) {
            if (outlet == inlet) continue;
            std::vector<Ball>& way = ways.emplace_back();
            for (std::uint32_t i = outlet; i != inlet; i = previous[i]) way.push_back(balls_[i]);
            way.push_back(balls_[inlet]);
            std::reverse(way.begin(), way.end());
        }
        return ways;
    }

private:
    const SignedDistance& distance_;
    const std::vector<Opening>& openings_;
    double cell_;   // of level 0 [m]
    Vec3 corner_;
    std::array<std::int64_t, 3> count_;
    std::vector<Ball> balls_;
    std::vector<Cell> cells_;   // of the balls after the openings'
    std::unordered_map<std::uint64_t, std::uint32_t, KeyHash> ball_of_cell_;
    std::vector<std::vector<std::uint32_t>> neighbours_;

    Vec3 centre_of(const Cell& c) const {
        const double size = cell_ / double(1 << c.level);
        return corner_ + size * Vec3{double(c.at[0]) + 0.5, double(c.at[1]) + 0.5, double(c.at[2]) + 0.5};
    }

    bool overlap(std::uint32_t i, std::uint32_t j) const {
        return norm(balls_[i].centre - balls_[j].centre) < balls_[i].radius + balls_[j].radius;
    }

    /// Cells whose ball is no smaller than they are become balls; of the others those that may hold some of the inside
    /// are returned.
    std::vector<Cell> take_balls(const std::vector<Cell>& cells, double size) {
        std::vector<double> value(cells.size());
        for_each_index(cells.size(), [&](std::size_t i) { value[i] = distance_.value(centre_of(cells[i])); });
        std::vector<Cell> open;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (-value[i] >= size) {
                ball_of_cell_[cells[i].key()] = std::uint32_t(balls_.size());
                balls_.push_back({centre_of(cells[i]), -value[i]});
                cells_.push_back(cells[i]);
            } else if (value[i] < 0.5 * std::sqrt(3.0) * size) {
                open.push_back(cells[i]);
            }
        }
        return open;
    }

    /// A distance changes by at most the way gone, so a ball's neighbours stand on cells at most 28 times as large.
    void add_neighbours_of(std::uint32_t i, std::vector<std::uint32_t>& found) const {
        const Cell& home = cells_[i - openings_.size()];
        for (int k = 0; k < 27; ++k) {
            const std::array<std::int64_t, 3> at{home.at[0] + k / 9 - 1, home.at[1] + k / 3 % 3 - 1,
                                                 home.at[2] + k % 3 - 1};
            if (k == 13 || at[0] < 0 || at[1] < 0 || at[2] < 0) continue;
            for (int up = 0; up <= std::min(5, home.level); ++up) {
                const auto other =
                    ball_of_cell_.find(Cell{home.level - up, {at[0] >> up, at[1] >> up, at[2] >> up}}.key());
                if (other == ball_of_cell_.end()) continue;
                if (overlap(i, other->second)) found.push_back(other->second);
                break;
            }
        }
    }

    void join_new_balls() {
        const std::size_t first = std::max(neighbours_.size(), openings_.size());
        const std::size_t old = neighbours_.size();
        neighbours_.resize(balls_.size());
        for_each_index(balls_.size() - first,
                       [&](std::size_t k) { add_neighbours_of(std::uint32_t(first + k), neighbours_[first + k]); });
        for (auto i = std::uint32_t(first); i < balls_.size(); ++i) {
            const std::size_t own = neighbours_[i].size();
            for (std::size_t k = 0; k < own; ++k)   // of the same size: both find the other
                if (neighbours_[i][k] < first ||
                    cells_[neighbours_[i][k] - openings_.size()].level < cells_[i - openings_.size()].level)
                    neighbours_[neighbours_[i][k]].push_back(i);
        }
        for (std::uint32_t o = 0; o < openings_.size(); ++o)
            for (auto i = std::uint32_t(old); i < balls_.size(); ++i)
                if (i != o && overlap(o, i)) {
                    neighbours_[o].push_back(i);
                    if (i >= openings_.size()) neighbours_[i].push_back(o);
                }
    }

    Groups groups() const {
        Groups groups(balls_.size());
        for (std::uint32_t i = 0; i < balls_.size(); ++i)
            for (std::uint32_t j : neighbours_[i]) groups.join(i, j);
        return groups;
    }

    bool are_joined() const {
        Groups all = groups();
        for (std::uint32_t o = 1; o < openings_.size(); ++o)
            if (all.group_of(o) != all.group_of(0)) return false;
        return true;
    }

    [[noreturn]] void throw_not_joined(double size) const {
        Groups all = groups();
        std::string names;
        for (std::uint32_t o = 1; o < openings_.size(); ++o)
            if (all.group_of(o) != all.group_of(0)) names += (names.empty() ? "" : ", ") + openings_[o].name;
        throw GeometryError(
            fmt::format("No way that is wider than {:.2g} mm leads from {} to {}: the vessel is closed in between, or "
                        "these are parts that do not hang together.",
                        2e3 * size, openings_[0].name, names));
    }

    /// For every ball the one before it on the cheapest row from the inlet (Dijkstra), (14.1).
    std::vector<std::uint32_t> cheapest_from(std::uint32_t inlet) const {
        std::vector<double> cost(balls_.size(), infinity);
        std::vector<std::uint32_t> previous(balls_.size(), inlet);
        using Entry = std::pair<double, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        queue.push({cost[inlet] = 0, inlet});
        while (!queue.empty()) {
            const auto [reached, i] = queue.top();
            queue.pop();
            if (reached > cost[i] || (i < openings_.size() && i != inlet)) continue;   // ways end at openings
            for (std::uint32_t j : neighbours_[i]) {
                const double there =
                    reached + norm(balls_[j].centre - balls_[i].centre) / (balls_[i].radius * balls_[j].radius);
                if (there < cost[j]) queue.push({cost[j] = there, j}), previous[j] = i;
            }
        }
        return previous;
    }
};

}   // namespace

bool is_capped(const SignedDistance& distance, const Opening& opening) {
    return distance.value(opening.centre - 0.1 * opening.radius * opening.normal) > -0.5 * opening.radius;
}

double depth_of_cap(const Opening& opening) { return 1.25 * opening.radius; }

namespace {

/// The way in from an opening's centre, as long as goes one unit against its normal. At an oblique end the normal leads into
/// the wall: the way is the one that leads where the wall is farthest, which is along the vessel.
Vec3 way_in(const SignedDistance& distance, const Opening& opening) {
    const double depth = depth_of_cap(opening);
    constexpr double enough = 0.2;   // of the radius: nearer to the wall a first line would hardly find its way
    Vec3 best = -opening.normal;
    double nearest = distance.value(opening.centre + depth * best);
    if (nearest < -enough * opening.radius) return best;
    const Vec3 u = normalized(cross(opening.normal, std::abs(opening.normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
               v = cross(opening.normal, u);
    constexpr int rings = 14, around = 36;   // five degrees apart, up to 70 off the normal: beyond, no rim is round
    for (int ring = 1; ring <= rings; ++ring)
        for (int k = 0; k < around; ++k) {
            const double off = ring * std::numbers::pi / 36, turn = 2 * std::numbers::pi * k / around;
            const Vec3 way = std::sin(off) * (std::cos(turn) * u + std::sin(turn) * v) - std::cos(off) * opening.normal;
            const double value = distance.value(opening.centre + depth * way);
            if (value < nearest) nearest = value, best = way;
        }
    return best / -dot(best, opening.normal);
}

}   // namespace

SignedDistance without_caps(SignedDistance distance, const std::vector<Opening>& openings) {
    std::vector<Opening> caps;
    std::copy_if(openings.begin(), openings.end(), std::back_inserter(caps),
                 [&](const Opening& o) { return is_capped(distance, o); });
    if (caps.empty()) return distance;
    std::vector<Vec3> ways;
    for (const Opening& cap : caps) ways.push_back(way_in(distance, cap));
    const Bounds bounds = distance.bounds();
    return {[distance = std::move(distance), caps = std::move(caps), ways = std::move(ways)](const Vec3& x) {
                for (std::size_t k = 0; k < caps.size(); ++k) {
                    const Opening& cap = caps[k];
                    const auto [s, radial] = opening_coordinates(cap, x);
                    if (s > -depth_of_cap(cap) && s < 0.5 * cap.radius && norm(radial) < 1.2 * cap.reach)
                        return distance.sample(x + (s + depth_of_cap(cap)) * ways[k]);
                }
                return distance.sample(x);
            },
            bounds};
}

std::vector<std::vector<Ball>> find_ways(const SignedDistance& distance, const std::vector<Opening>& openings,
                                         std::size_t inlet) {
    if (openings.size() < 2)
        throw GeometryError("A centreline needs an inlet and an outlet; this vessel has fewer than two openings.");
    BallGraph graph(distance, openings);
    graph.grow();
    return graph.ways_from(inlet);
}

}   // namespace patency
