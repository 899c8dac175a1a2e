// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/streamlines.h"

#include <cmath>

namespace patency {

std::vector<Streamline> trace_streamlines(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> seeds,
                                          const StreamlineRule& rule, const WallHint& wall) {
    std::vector<Streamline> lines(seeds.size());
    std::vector<std::size_t> alive;
    for (std::size_t k = 0; k < seeds.size(); ++k) alive.push_back(k);
    std::vector<Vec3> here(seeds.begin(), seeds.end());
    const auto sampled = [&](const std::vector<Vec3>& places) {
        return sample_flow(fluid, frame, places, rule.reach, false, &wall);
    };
    const auto can_go_on = [&](const FlowSample& s) { return s.neighbours > 0 && norm(s.velocity) > rule.slowest; };

    std::vector<double> length(seeds.size(), 0);
    while (!alive.empty()) {
        const auto now = sampled(here);
        std::vector<std::size_t> left;
        std::vector<Vec3> start, middle;
        std::vector<double> step;
        for (std::size_t a = 0; a < alive.size(); ++a) {
            if (now[a].neighbours == 0) continue;
            Streamline& line = lines[alive[a]];
            line.points.push_back(here[a]), line.velocity.push_back(now[a].velocity),
                line.pressure.push_back(now[a].pressure);
            if (!can_go_on(now[a]) || length[alive[a]] > rule.longest) continue;
            left.push_back(alive[a]), start.push_back(here[a]), step.push_back(rule.step(here[a]));
            middle.push_back(here[a] + 0.5 * step.back() * normalized(now[a].velocity));
        }
        const auto half = sampled(middle);
        alive.clear(), here.clear();
        for (std::size_t a = 0; a < left.size(); ++a) {
            if (!can_go_on(half[a])) continue;
            const Vec3 next = start[a] + step[a] * normalized(half[a].velocity);
            if (!rule.is_inside(next)) continue;
            length[left[a]] += step[a];
            alive.push_back(left[a]), here.push_back(next);
        }
    }
    return lines;
}

}   // namespace patency
