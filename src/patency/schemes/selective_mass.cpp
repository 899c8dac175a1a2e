// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/selective_mass.h"

#include <limits>
#include <queue>
#include <unordered_map>

#include "patency/base/parallel.h"
#include "patency/base/weighted_sum.h"
#include "patency/bodies/cell_hash.h"

namespace patency {

namespace {

// In spacings. A patch holds a strut of four particles across with its corners, so that no two of them lie beside each other
// in it; what is beside a strut is not a neighbour of its particles.
constexpr double neighbours_within = 1.6, patches_apart = 5, patch_reach = 7.5;

using Graph = Ragged<std::uint32_t>;

Graph neighbours_of(const SolidParticles& particles, double within) {
    const CellHash hash{within};
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    for (std::uint32_t i = 0; i < particles.size(); ++i) cells[hash(particles.reference[i])].push_back(i);
    Graph graph;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const Vec3& x = particles.reference[i];
        const std::int64_t a = hash.index(x.x), b = hash.index(x.y), c = hash.index(x.z);
        for (std::int64_t k = c - 1; k <= c + 1; ++k)
            for (std::int64_t j = b - 1; j <= b + 1; ++j)
                for (std::int64_t l = a - 1; l <= a + 1; ++l)
                    if (const auto found = cells.find(CellHash::key(l, j, k)); found != cells.end())
                        for (const std::uint32_t n : found->second)
                            if (n != i && norm(particles.reference[n] - x) <= within) graph.items.push_back(n);
        graph.start.push_back(std::uint32_t(graph.items.size()));
    }
    return graph;
}

/// Particles on ways of less than `reach` from one, and the ways' lengths.
class WaysFrom {
public:
    WaysFrom(const SolidParticles& particles, const Graph& graph)
        : particles_(particles), graph_(graph), way_(particles.size(), unreached) {}

    const std::vector<std::pair<std::uint32_t, double>>& find(std::uint32_t seed, double reach) {
        found_.clear();
        std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>,
                            std::greater<>>
            open;
        std::vector<std::uint32_t> visited{seed};
        way_[seed] = 0, open.push({0, seed});
        while (!open.empty()) {
            const auto [length, from] = open.top();
            open.pop();
            if (length > way_[from]) continue;
            found_.push_back({from, length});
            for (const std::uint32_t* to = graph_.begin(from); to < graph_.end(from); ++to) {
                const double longer = length + norm(particles_.reference[*to] - particles_.reference[from]);
                if (longer >= reach || longer >= way_[*to]) continue;
                if (way_[*to] == unreached) visited.push_back(*to);
                way_[*to] = longer;
                open.push({longer, *to});
            }
        }
        for (const std::uint32_t v : visited) way_[v] = unreached;
        return found_;
    }

private:
    static constexpr double unreached = std::numeric_limits<double>::infinity();
    const SolidParticles& particles_;
    const Graph& graph_;
    std::vector<double> way_;
    std::vector<std::pair<std::uint32_t, double>> found_;
};

}   // namespace

SelectiveMass::SelectiveMass(const SolidParticles& particles, double spacing, const std::vector<double>& scaling) {
    const std::size_t n = particles.size();
    for (const double s : scaling) alone_.push_back(1 / s);
    const Graph graph = neighbours_of(particles, neighbours_within * spacing);
    WaysFrom ways(particles, graph);
    const double reach = patch_reach * spacing, apart = patches_apart * spacing;
    std::vector<std::uint8_t> is_near_seed(n, 0);
    std::vector<std::vector<Share>> of_particle(n);
    std::vector<double> sum(n, 0);
    std::uint32_t patch_count = 0;
    for (std::uint32_t seed = 0; seed < n; ++seed) {
        if (is_near_seed[seed]) continue;
        for (const auto& [i, way] : ways.find(seed, reach)) {
            if (way < apart) is_near_seed[i] = 1;
            of_particle[i].push_back({patch_count, 1 - way / reach});
            sum[i] += 1 - way / reach;
        }
        ++patch_count;
    }
    std::vector<std::vector<Share>> of_patch(patch_count);
    mass_.assign(patch_count, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        for (Share& s : of_particle[i]) {
            s.weight *= (1 - alone_[i]) / sum[i];
            of_patch[s.index].push_back({i, s.weight});
            mass_[s.index] += s.weight * particles.mass[i];
        }
    }
    const auto fill = [](Ragged<Share>& rows, const std::vector<std::vector<Share>>& from) {
        for (const auto& row : from) {
            rows.items.insert(rows.items.end(), row.begin(), row.end());
            rows.start.push_back(std::uint32_t(rows.items.size()));
        }
    };
    fill(patches_, of_particle), fill(members_, of_patch);
    together_.resize(patch_count);
}

void SelectiveMass::compute_velocity(const std::vector<Vec3>& momentum, SolidParticles& particles) const {
    for_each_index(mass_.size(), [&](std::size_t k) {
        WeightedSum sum;
        for (const Share* s = members_.begin(k); s < members_.end(k); ++s) sum.add(s->weight, momentum[s->index]);
        together_[k] = (1 / mass_[k]) * sum.value();
    });
    for_each_index(particles.size(), [&](std::size_t i) {
        WeightedSum sum;
        for (const Share* s = patches_.begin(i); s < patches_.end(i); ++s) sum.add(s->weight, together_[s->index]);
        particles.velocity[i] = (alone_[i] / particles.mass[i]) * momentum[i] + sum.value();
    });
}

}   // namespace patency
