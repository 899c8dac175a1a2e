// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/graded_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "patency/base/pack.h"
#include "patency/base/parallel.h"
#include "patency/base/select.h"

namespace patency {

namespace {

using Floats = Pack<float>;
using Indices = Pack<std::uint32_t>;
constexpr std::size_t width = std::size_t(Floats::lanes);

double gap(double low_a, double high_a, double low_b, double high_b) {
    return std::max({low_b - high_a, low_a - high_b, 0.0});
}

// Points that may be neighbours of a group's, seen from its first one, in units of its spacing: floats are exact enough for
// rows, whose ends are out of sight of the kernel.
struct Candidates {
    std::vector<float> x, y, z, half_reach;
    std::vector<std::uint32_t> index;
    std::size_t count = 0;

    void reserve(std::size_t n) {
        if (index.size() >= n + width) return;
        for (auto* v : {&x, &y, &z, &half_reach}) v->resize(2 * n + width);
        index.resize(2 * n + width);
    }
    void add(std::uint32_t i, const Vec3& at, double reach) {
        x[count] = float(at.x), y[count] = float(at.y), z[count] = float(at.z), half_reach[count] = float(reach);
        index[count++] = i;
    }
};

}   // namespace

void GradedRows::find(std::span<const Vec3> points, std::span<const double> spacing, double reach) {
    const std::size_t count = points.size(), group_count = (count + group_size - 1) / group_size;
    levels_.assign(1, std::vector<Node>(group_count));
    for_each_index(group_count, [&](std::size_t g) {
        const std::size_t first = g * group_size, end = std::min(count, first + group_size);
        Node node{points[first], points[first], 0};
        for (std::size_t i = first; i < end; ++i) {
            const Vec3& x = points[i];
            node.low = {std::min(node.low.x, x.x), std::min(node.low.y, x.y), std::min(node.low.z, x.z)};
            node.high = {std::max(node.high.x, x.x), std::max(node.high.y, x.y), std::max(node.high.z, x.z)};
            node.largest = std::max(node.largest, spacing[i]);
        }
        levels_[0][g] = node;
    });
    while (levels_.back().size() > 1) {
        const std::vector<Node>& below = levels_.back();
        std::vector<Node> level((below.size() + fan - 1) / fan);
        for (std::size_t n = 0; n < below.size(); ++n) {
            Node& node = level[n / fan];
            const Node& b = below[n];
            if (n % fan == 0) node = b;
            node.low = {std::min(node.low.x, b.low.x), std::min(node.low.y, b.low.y), std::min(node.low.z, b.low.z)};
            node.high = {std::max(node.high.x, b.high.x), std::max(node.high.y, b.high.y),
                         std::max(node.high.z, b.high.z)};
            node.largest = std::max(node.largest, b.largest);
        }
        levels_.push_back(std::move(level));
    }

    groups_.resize(group_count);
#pragma omp parallel
    {
        Candidates candidates;
        std::vector<std::uint32_t> rows;                                // of one group
        std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting;   // level, node
#pragma omp for schedule(dynamic, 16)
        for (std::size_t g = 0; g < group_count; ++g) {
            const Node& own = levels_[0][g];
            const std::size_t first = g * group_size, end = std::min(count, first + group_size);
            const Vec3 from = points[first];
            const double unit = spacing[first];
            candidates.count = 0;
            waiting.assign(1, {std::uint32_t(levels_.size() - 1), 0});
            while (!waiting.empty()) {
                const auto [level, n] = waiting.back();
                waiting.pop_back();
                const Node& node = levels_[level][n];
                const double dx = gap(own.low.x, own.high.x, node.low.x, node.high.x),
                             dy = gap(own.low.y, own.high.y, node.low.y, node.high.y),
                             dz = gap(own.low.z, own.high.z, node.low.z, node.high.z);
                const double most = 0.5 * reach * (own.largest + node.largest);
                if (dx * dx + dy * dy + dz * dz > most * most) continue;
                if (level > 0) {   // in rising order
                    for (std::size_t k = std::min(levels_[level - 1].size(), (n + 1) * fan); k-- > n * fan;)
                        waiting.emplace_back(level - 1, k);
                    continue;
                }
                const std::size_t begin = n * group_size, stop = std::min(count, begin + group_size);
                candidates.reserve(candidates.count + group_size);
                for (std::size_t j = begin; j < stop; ++j) {
                    const Vec3& x = points[j];
                    const double ex = gap(own.low.x, own.high.x, x.x, x.x), ey = gap(own.low.y, own.high.y, x.y, x.y),
                                 ez = gap(own.low.z, own.high.z, x.z, x.z);
                    const double far = 0.5 * reach * (own.largest + spacing[j]);
                    if (ex * ex + ey * ey + ez * ez < far * far)
                        candidates.add(std::uint32_t(j), (x - from) / unit, 0.5 * reach * spacing[j] / unit);
                }
            }
            candidates.reserve(candidates.count);
            for (std::size_t k = candidates.count; k < candidates.count + width; ++k)
                candidates.x[k] = std::numeric_limits<float>::infinity(),
                candidates.y[k] = candidates.z[k] = candidates.half_reach[k] = 0;

            Group& group = groups_[g];
            rows.resize(std::max(rows.size(), group_size * (candidates.count + width + lanes)));
            std::size_t filled = 0;
            group.start[0] = 0;
            for (std::size_t i = first; i < end; ++i) {
                const Vec3 at = (points[i] - from) / unit;
                const Floats x(float(at.x)), y(float(at.y)), z(float(at.z)),
                    half(float(0.5 * reach * spacing[i] / unit));
                for (std::size_t k = 0; k < candidates.count; k += width) {
                    const Floats dx = Floats::load(&candidates.x[k]) - x, dy = Floats::load(&candidates.y[k]) - y,
                                 dz = Floats::load(&candidates.z[k]) - z,
                                 most = Floats::load(&candidates.half_reach[k]) + half;
                    const Floats square = fma(dz, dz, fma(dy, dy, dx * dx));
                    filled += store_chosen(Indices::load(&candidates.index[k]), lanes_below(square, most * most),
                                           &rows[filled]);
                }
                while (filled % lanes != 0) rows[filled++] = std::uint32_t(count);
                group.start[i - first + 1] = std::uint32_t(filled);
            }
            group.neighbours.assign(rows.begin(), rows.begin() + std::ptrdiff_t(filled));
        }
    }
}

}   // namespace patency
