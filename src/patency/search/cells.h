// SPDX-License-Identifier: Apache-2.0
// Where particles are: fixed-point coordinates, the order that keeps neighbours near in memory, and the columns of cells
// in which neighbours are looked up. Knows positions only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "patency/base/aligned.h"
#include "patency/base/vec.h"

namespace patency {

/// One grid of fixed-point coordinates for all bodies of a scene, so that differences between bodies are exact.
/// A coordinate is a 32-bit number of quanta from the origin; its range is checked, because overflow would wrap silently.
class Frame {
public:
    /// box: corners [m] of everything that will ever be there; support: largest kernel support [m].
    /// Throws GeometryError if the box exceeds the range of the coordinates (about 1000 supports).
    /// Along periodic axes the box repeats itself and a difference takes the short way round, at no cost: there the box
    /// is 2^32 quanta long and the integers wrap. All periodic sides must be equal, and longer than the others by a support.
    Frame(const Vec3& low, const Vec3& high, double support, const std::array<bool, 3>& periodic = {});

    double quantum() const { return quantum_; }   ///< [m]
    double support() const { return support_; }   ///< [m]
    const Vec3& low() const { return low_; }
    const Vec3& high() const { return high_; }
    std::array<std::int32_t, 3> fixed(const Vec3& x) const {
        return {fixed_one(x.x, 0), fixed_one(x.y, 1), fixed_one(x.z, 2)};
    }
    bool contains(const Vec3& x) const {
        return x.x >= low_.x && x.y >= low_.y && x.z >= low_.z && x.x <= high_.x && x.y <= high_.y && x.z <= high_.z;
    }
    /// The axis along which columns run (the longest), and the two across.
    const std::array<int, 3>& axes() const { return axes_; }

    const std::array<bool, 3>& periodic() const { return periodic_; }
    bool any_periodic() const { return periodic_[0] || periodic_[1] || periodic_[2]; }
    Vec3 wrapped(const Vec3& x) const;   ///< back into the box, along periodic axes

private:
    std::int32_t fixed_one(double x, int axis) const {   // through 64 bits: the upper face of a periodic box wraps
        return static_cast<std::int32_t>(
            static_cast<std::int64_t>((x - centre_[std::size_t(axis)]) * inverse_quantum_));
    }
    Vec3 low_, high_;
    std::array<double, 3> centre_{};
    double support_, quantum_, inverse_quantum_;
    std::array<int, 3> axes_;
    std::array<bool, 3> periodic_{};
};

/// The particles of one body in columns of cells, in cell order.
class Cells {
public:
    /// The permutation that puts the particles in cell order: columns of about 2.3 spacings, short bins along them;
    /// stable, the same for any number of threads.
    std::span<const std::uint32_t> find_order(const Frame& frame, double spacing, std::span<const Vec3> positions);
    /// Index particles that are already in that order.
    void index(const Frame& frame, double spacing, std::span<const Vec3> positions);

    std::size_t size() const { return count_; }
    /// Fixed-point coordinates along (column axis, first, second axis across), in cell order, padded for whole packs.
    const AlignedVector<std::int32_t>& coordinate(int k) const { return coordinates_[std::size_t(k)]; }

    /// Calls visit(begin, end) for runs of particles that may lie within `reach` quanta of the box [low, high]
    /// (fixed-point, in the order of axes()). Runs come in rising order.
    template <class Visit>
    void for_each_run(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high,
                      std::int64_t reach, Visit visit) const;

private:
    /// Part of a column's particles.
    struct Range {
        std::uint32_t begin, end;
    };
    static constexpr std::size_t ranges_at_once = 16;
    void narrow(std::array<Range, ranges_at_once>& ranges, std::size_t count, std::int32_t first_bin,
                std::int32_t last_bin) const;
    std::int64_t bin_of(std::int64_t along) const { return (along - origin_[0]) / bin_; }
    void measure(const Frame& frame, double spacing);
    std::uint32_t column_of(const std::array<std::int32_t, 3>& x) const;

    std::size_t count_ = 0;
    std::array<int, 3> axes_{};
    std::array<std::int64_t, 3> origin_{};   // of the columns, in quanta
    std::int64_t side_ = 1, bin_ = 1;        // of a column, along it
    std::int64_t columns_[2] = {1, 1};
    std::vector<std::uint32_t> column_start_;
    std::vector<std::int32_t> bins_;   // of every particle, along its column
    std::array<AlignedVector<std::int32_t>, 3> coordinates_;
    std::vector<std::uint32_t> order_, order_by_bin_, key_, bin_key_;
};

template <class Visit>
void Cells::for_each_run(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high,
                         std::int64_t reach, Visit visit) const {
    const auto clamp_column = [&](std::int64_t x, int k) {
        const std::int64_t c = (x - origin_[std::size_t(k) + 1]) / side_;
        return c < 0 ? 0 : c >= columns_[k] ? columns_[k] - 1 : c;
    };
    const std::int64_t a0 = clamp_column(low[1] - reach, 0), a1 = clamp_column(high[1] + reach, 0);
    const std::int64_t b0 = clamp_column(low[2] - reach, 1), b1 = clamp_column(high[2] + reach, 1);
    const std::int64_t r2 = reach * reach;
    const auto gap = [&](std::int64_t c, int k) {   // between the box and column c, across
        const std::size_t axis = std::size_t(k) + 1;
        const std::int64_t left = origin_[axis] + c * side_, right = left + side_;
        return left > high[axis] ? left - high[axis] : right < low[axis] ? low[axis] - right : std::int64_t(0);
    };
    const std::int32_t first_bin = std::int32_t(bin_of(low[0] - reach) - 1),
                       last_bin = std::int32_t(bin_of(high[0] + reach) + 1);
    std::array<Range, ranges_at_once> ranges;
    std::size_t count = 0;
    const auto visit_ranges = [&] {
        narrow(ranges, count, first_bin, last_bin);
        for (std::size_t k = 0; k < count; ++k)
            if (ranges[k].begin < ranges[k].end) visit(ranges[k].begin, ranges[k].end);
        count = 0;
    };
    for (std::int64_t b = b0; b <= b1; ++b) {
        const std::int64_t gap_b = gap(b, 1);
        for (std::int64_t a = a0; a <= a1; ++a) {
            const std::int64_t gap_a = gap(a, 0);
            if (gap_a >= reach || gap_b >= reach || gap_a * gap_a + gap_b * gap_b >= r2)
                continue;   // (squares overflow)
            const std::size_t column = std::size_t(b * columns_[0] + a);
            const Range all{column_start_[column], column_start_[column + 1]};
            if (all.begin == all.end) continue;
            ranges[count++] = all;
            if (count == ranges.size()) visit_ranges();
        }
    }
    visit_ranges();
}

}   // namespace patency
