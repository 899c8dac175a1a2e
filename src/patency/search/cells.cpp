// SPDX-License-Identifier: Apache-2.0
#include "patency/search/cells.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

// 2^21 quanta per support: an exact float difference for every pair within reach, and a range of 1024 supports.
constexpr double quanta_per_support = 2097152;
// Measured: columns of 2 to 2.5 spacings with bins of a half keep 16 consecutive particles compact (docs/PERFORMANCE.md).
constexpr double column_side_in_spacings = 2.3;
constexpr double bin_in_spacings = 0.5;

double component(const Vec3& x, int axis) { return axis == 0 ? x.x : axis == 1 ? x.y : x.z; }

/// order[k] = the k-th particle when particles (taken in the order `from`) are sorted by key, stably. Chunks are
/// contiguous and a chunk's share of a key lies after those of the chunks before it, so threads do not matter.
void counting_sort(std::span<const std::uint32_t> key, std::span<const std::uint32_t> from, std::size_t keys,
                   std::vector<std::uint32_t>& order, std::vector<std::uint32_t>* start) {
    const std::size_t count = key.size();
    order.resize(count);
    const int chunks = std::max(1, std::min(omp_get_max_threads(), int(count / 4096)));
    std::vector<std::vector<std::uint32_t>> share(std::size_t(chunks), std::vector<std::uint32_t>(keys, 0));
    const auto begin_of = [&](int c) { return count * std::size_t(c) / std::size_t(chunks); };
    const auto particle = [&](std::size_t k) { return from.empty() ? std::uint32_t(k) : from[k]; };
#pragma omp parallel for schedule(static, 1)
    for (int c = 0; c < chunks; ++c)
        for (std::size_t k = begin_of(c); k < begin_of(c + 1); ++k) ++share[std::size_t(c)][key[particle(k)]];
    std::uint32_t sum = 0;
    if (start) start->resize(keys + 1);
    for (std::size_t q = 0; q < keys; ++q) {
        if (start) (*start)[q] = sum;
        for (auto& s : share) sum += std::exchange(s[q], sum);
    }
    if (start) (*start)[keys] = sum;
#pragma omp parallel for schedule(static, 1)
    for (int c = 0; c < chunks; ++c)
        for (std::size_t k = begin_of(c); k < begin_of(c + 1); ++k)
            order[share[std::size_t(c)][key[particle(k)]]++] = particle(k);
}

}   // namespace

Frame::Frame(const Vec3& low, const Vec3& high, double support, const std::array<bool, 3>& periodic)
    : low_(low), high_(high), support_(support), quantum_(support / quanta_per_support), periodic_(periodic) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!periodic[std::size_t(axis)]) continue;
        const double side = component(high, axis) - component(low, axis);
        if (quantum_ != support / quanta_per_support && std::abs(side / (quantum_ * 4294967296.0) - 1) > 1e-12)
            throw GeometryError("the periodic sides of a box must be equal");
        if (side < 3 * support)
            throw GeometryError(
                fmt::format("a periodic side of {:.4g} m is shorter than three kernel supports of {:.3g} m: "
                            "use a finer spacing",
                            side, support));
        quantum_ = side / 4294967296.0;
    }
    inverse_quantum_ = 1 / quantum_;
    const Vec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
        const double side = component(size, axis), turn = 4294967296.0 * quantum_;
        if (!any_periodic() && !(side < 1000 * support))
            throw GeometryError(
                fmt::format("the domain is {:.4g} m long, more than 1000 kernel supports of {:.3g} m: "
                            "use a coarser spacing or a shorter domain",
                            side, support));
        // A longer distance would wrap onto a short one.
        if (any_periodic() && !periodic[std::size_t(axis)] && !(side + support <= turn))
            throw GeometryError(
                fmt::format("a periodic side of {:.4g} m is too short for a box of {:.4g} m and a kernel support of "
                            "{:.3g} m across it: make the periodic side longer",
                            turn, side, support));
    }
    const Vec3 centre = 0.5 * (low + high);
    centre_ = {centre.x, centre.y, centre.z};
    axes_ = {0, 1, 2};
    std::stable_sort(axes_.begin(), axes_.end(), [&](int a, int b) { return component(size, a) > component(size, b); });
}

Vec3 Frame::wrapped(const Vec3& x) const {
    const auto wrap = [&](double value, int axis) {
        if (!periodic_[std::size_t(axis)]) return value;
        const double low = component(low_, axis), side = component(high_, axis) - low;
        const double w = value - side * std::floor((value - low) / side);
        return w < low + side ? w : low;   // rounding may reach the upper face, which is the lower one
    };
    return {wrap(x.x, 0), wrap(x.y, 1), wrap(x.z, 2)};
}

void Cells::measure(const Frame& frame, double spacing) {
    axes_ = frame.axes();
    side_ = std::max<std::int64_t>(1, std::int64_t(column_side_in_spacings * spacing / frame.quantum()));
    bin_ = std::max<std::int64_t>(1, std::int64_t(bin_in_spacings * spacing / frame.quantum()));
    for (std::size_t k = 0; k < 3; ++k) {
        const double half =
            0.5 * (component(frame.high(), axes_[k]) - component(frame.low(), axes_[k])) / frame.quantum();
        origin_[k] = -std::int64_t(half) - 4;
        if (k > 0) columns_[k - 1] = (std::int64_t(half) + 4 - origin_[k]) / side_ + 1;
    }
}

std::uint32_t Cells::column_of(const std::array<std::int32_t, 3>& x) const {
    const auto at = [&](std::size_t k) {
        const std::int64_t c = (std::int64_t(x[std::size_t(axes_[k])]) - origin_[k]) / side_;
        return std::clamp<std::int64_t>(c, 0, columns_[k - 1] - 1);
    };
    return std::uint32_t(at(2) * columns_[0] + at(1));
}

std::span<const std::uint32_t> Cells::find_order(const Frame& frame, double spacing, std::span<const Vec3> positions) {
    measure(frame, spacing);
    const std::size_t count = positions.size();
    key_.resize(count);
    bin_key_.resize(count);
    for_each_index(count, [&](std::size_t i) {
        const auto x = frame.fixed(positions[i]);
        key_[i] = column_of(x);
        bin_key_[i] = std::uint32_t(std::max<std::int64_t>(0, bin_of(x[std::size_t(axes_[0])])));
    });
    const std::uint32_t bins = reduce(
                                   count, std::uint32_t(0), [&](std::size_t i) { return bin_key_[i]; },
                                   [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); }) +
                               1;
    counting_sort(bin_key_, {}, bins, order_by_bin_, nullptr);
    counting_sort(key_, order_by_bin_, std::size_t(columns_[0] * columns_[1]), order_, &column_start_);
    return order_;
}

void Cells::index(const Frame& frame, double spacing, std::span<const Vec3> positions) {
    measure(frame, spacing);
    count_ = positions.size();
    for (auto& c : coordinates_) c.reset(count_ + 64);
    bins_.resize(count_);
    key_.resize(count_);
    for_each_index(count_, [&](std::size_t i) {
        const auto x = frame.fixed(positions[i]);
        for (std::size_t k = 0; k < 3; ++k) coordinates_[k][i] = x[std::size_t(axes_[k])];
        bins_[i] = std::int32_t(std::max<std::int64_t>(0, bin_of(x[std::size_t(axes_[0])])));
        key_[i] = column_of(x);
    });
    for (auto& c : coordinates_)
        for (std::size_t i = count_; i < count_ + 64; ++i) c[i] = INT32_MAX;
    const std::size_t columns = std::size_t(columns_[0] * columns_[1]);
    column_start_.assign(columns + 1, 0);
    for (std::size_t i = 0; i < count_; ++i) ++column_start_[key_[i] + 1];
    for (std::size_t q = 0; q < columns; ++q) column_start_[q + 1] += column_start_[q];
}

/// Cuts ranges of columns down to the particles whose bins lie in [first_bin, last_bin]; none is empty. Bisections wait for memory at
/// every step, and without branches, which would be guessed wrong half the time, nothing runs ahead: all at once, they
/// wait together.
void Cells::narrow(std::array<Range, ranges_at_once>& ranges, std::size_t count, std::int32_t first_bin,
                   std::int32_t last_bin) const {
    std::array<Range, ranges_at_once> found;   // how many are below the first, and not above the last
    std::uint32_t longest = 0;
    for (std::size_t k = 0; k < count; ++k) {
        found[k] = {ranges[k].begin, ranges[k].begin};
        longest = std::max(longest, ranges[k].end - ranges[k].begin);
    }
    for (std::uint32_t step = std::bit_floor(longest); step > 0; step /= 2)
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t end = ranges[k].end;
            const auto advance = [&](std::uint32_t& at, std::int32_t bin) {
                const std::uint32_t next = std::min(at + step, end);
                at = bins_[next - 1] < bin ? next : at;
            };
            advance(found[k].begin, first_bin);
            advance(found[k].end, last_bin + 1);
        }
    std::copy_n(found.begin(), count, ranges.begin());
}

}   // namespace patency
