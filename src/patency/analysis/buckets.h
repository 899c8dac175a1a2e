// SPDX-License-Identifier: Apache-2.0
// Which points are near a place, for samples taken here and there: quick to build, good for thousands of places.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "patency/base/parallel.h"
#include "patency/search/cells.h"

namespace patency {

inline Vec3 shortest(const Vec3& d, const Frame& frame) {   // the short way round a periodic box
    if (!frame.any_periodic()) return d;
    const auto wrap = [](double x, double side, bool periodic) {
        return periodic ? x - side * std::round(x / side) : x;
    };
    const Vec3 side = frame.high() - frame.low();
    return {wrap(d.x, side.x, frame.periodic()[0]), wrap(d.y, side.y, frame.periodic()[1]),
            wrap(d.z, side.z, frame.periodic()[2])};
}

/// Points that may be near a place: those of a box around all places, in buckets of one reach. Along periodic axes there
/// is one bucket.
class Buckets {
public:
    Buckets(std::span<const Vec3> points, const Frame& frame, std::span<const Vec3> places, double reach) {
        Vec3 low = places[0], high = places[0];
        for (const Vec3& x : places) {
            low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
            high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
        }
        const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low) + Vec3{reach, reach, reach};
        low_ = middle - half;
        const std::array<double, 3> length{2 * half.x, 2 * half.y, 2 * half.z};
        for (std::size_t a = 0; a < 3; ++a) {
            const double count = frame.periodic()[a] ? 1 : std::floor(length[a] / reach);
            count_[a] = int(std::clamp(count, 1.0, 400.0));
            scale_[a] = count_[a] / length[a];
        }
        struct Found {
            std::size_t bucket;
            std::uint32_t index;
        };
        std::vector<std::vector<Found>> found((points.size() + block_size - 1) / block_size);
        for_each_block(points.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Vec3 d = shortest(points[i] - middle, frame);
                if (std::abs(d.x) <= half.x && std::abs(d.y) <= half.y && std::abs(d.z) <= half.z)
                    found[begin / block_size].push_back({number(cell_of(middle + d)), std::uint32_t(i)});
            }
        });
        start_.assign(std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]) + 1, 0);
        for (const auto& block : found)
            for (const Found& f : block) ++start_[f.bucket + 1];
        for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
        index_.resize(start_.back());
        std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
        for (const auto& block : found)
            for (const Found& f : block) index_[next[f.bucket]++] = f.index;
    }

    /// visit(particle) for all that lie within a reach of x, and some more.
    template <class Visit>
    void for_each_near(const Vec3& x, Visit visit) const {
        const auto c = cell_of(x);
        for (int k = std::max(0, c[2] - 1); k <= std::min(count_[2] - 1, c[2] + 1); ++k)
            for (int j = std::max(0, c[1] - 1); j <= std::min(count_[1] - 1, c[1] + 1); ++j) {
                const std::size_t first = number({std::max(0, c[0] - 1), j, k}),
                                  last = number({std::min(count_[0] - 1, c[0] + 1), j, k});
                for (std::size_t n = start_[first]; n < start_[last + 1]; ++n) visit(index_[n]);
            }
    }

private:
    std::array<int, 3> cell_of(const Vec3& x) const {
        const std::array<double, 3> d{x.x - low_.x, x.y - low_.y, x.z - low_.z};
        std::array<int, 3> cell;
        for (std::size_t a = 0; a < 3; ++a) cell[a] = std::clamp(int(std::floor(d[a] * scale_[a])), 0, count_[a] - 1);
        return cell;
    }
    std::size_t number(const std::array<int, 3>& c) const {
        return (std::size_t(c[2]) * std::size_t(count_[1]) + std::size_t(c[1])) * std::size_t(count_[0]) +
               std::size_t(c[0]);
    }

    Vec3 low_;
    std::array<int, 3> count_{};
    std::array<double, 3> scale_{};
    std::vector<std::size_t> start_;
    std::vector<std::uint32_t> index_;
};

}   // namespace patency
