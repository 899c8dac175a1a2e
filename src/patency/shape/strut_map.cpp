// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/strut_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "patency/base/errors.h"

namespace patency {

StrutMap::StrutMap(const StrutCurves& curves) : circumference_(curves.circumference()) {
    const double longest = circumference_ / 8;   // a piece must see which way round a place is nearer
    double thinnest = std::numeric_limits<double>::infinity();
    for (const Strut& strut : curves.struts)
        for (std::size_t k = 1; k < strut.points.size(); ++k) {
            const FlatPoint &a = strut.points[k - 1], &b = strut.points[k];
            const double da = b.around - a.around, dl = b.along - a.along, length = std::hypot(da, dl);
            if (!(length > 0)) continue;
            thinnest = std::min(thinnest, strut.half_width);
            const int parts = std::max(1, int(std::ceil(length / longest)));
            for (int i = 0; i < parts; ++i) {
                const double t = (i + 0.5) / parts;
                pieces_.push_back({{a.around + t * da, a.along + t * dl},
                                   {da / length, dl / length},
                                   0.5 * length / parts,
                                   strut.half_width});
            }
        }
    if (pieces_.empty()) throw GeometryError("The stent has no struts.");
    all_.resize(pieces_.size());
    std::iota(all_.begin(), all_.end(), 0u);

    const double margin = curves.middle_radius;
    low_ = -curves.length / 2 - margin;
    const double cell = 3 * thinnest;
    around_ = std::max(1, int(circumference_ / cell));
    along_ = std::max(1, int((curves.length + 2 * margin) / cell));
    cell_around_ = circumference_ / around_;
    cell_along_ = (curves.length + 2 * margin) / along_;
    // No place of a block is farther than `reach` from its middle, so its nearest piece is within 2 reach of the middle's.
    std::vector<double> values;
    const auto near_block = [&](int i, int j, int across, const std::vector<std::uint32_t>& from) {
        const FlatPoint middle{(i + 0.5 * across) * cell_around_, low_ + (j + 0.5 * across) * cell_along_};
        const double reach = 0.5 * across * std::hypot(cell_around_, cell_along_) * (1 + 1e-9);
        values.resize(from.size());
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < from.size(); ++k)
            least = std::min(least, values[k] = value(pieces_[from[k]], middle));
        std::vector<std::uint32_t> found;
        for (std::size_t k = 0; k < from.size(); ++k)
            if (values[k] <= least + 2 * reach) found.push_back(from[k]);
        return found;
    };
    constexpr int block = 8;   // cells, looked at together first
    std::vector<std::vector<std::uint32_t>> of_cell(std::size_t(around_) * std::size_t(along_));
    for (int j = 0; j < along_; j += block)
        for (int i = 0; i < around_; i += block) {
            const std::vector<std::uint32_t> of_block = near_block(i, j, block, all_);
            for (int l = j; l < std::min(along_, j + block); ++l)
                for (int k = i; k < std::min(around_, i + block); ++k)
                    of_cell[std::size_t(l) * std::size_t(around_) + std::size_t(k)] = near_block(k, l, 1, of_block);
        }
    start_.push_back(0);
    for (const auto& found : of_cell) {
        candidates_.insert(candidates_.end(), found.begin(), found.end());
        start_.push_back(std::uint32_t(candidates_.size()));
    }
}

FlatPoint StrutMap::from_middle(const Piece& piece, const FlatPoint& place) const {
    const double d = place.around - piece.middle.around;
    return {d - circumference_ * std::round(d / circumference_), place.along - piece.middle.along};
}

double StrutMap::value(const Piece& piece, const FlatPoint& place) const {
    const FlatPoint d = from_middle(piece, place);
    const double along = d.around * piece.direction.around + d.along * piece.direction.along;
    const double aside = d.along * piece.direction.around - d.around * piece.direction.along;
    const double past = std::max(0.0, std::abs(along) - piece.half_length);
    return std::sqrt(past * past + aside * aside) - piece.half_width;
}

StrutSample StrutMap::nearest(const FlatPoint& place, const std::uint32_t* begin, const std::uint32_t* end) const {
    double least = std::numeric_limits<double>::infinity();
    const Piece* best = &pieces_[*begin];
    for (const std::uint32_t* k = begin; k != end; ++k)
        if (const double v = value(pieces_[*k], place); v < least) least = v, best = &pieces_[*k];
    const FlatPoint d = from_middle(*best, place);
    const double along = std::clamp(d.around * best->direction.around + d.along * best->direction.along,
                                    -best->half_length, best->half_length);
    FlatPoint out{d.around - along * best->direction.around, d.along - along * best->direction.along};
    const double away = std::hypot(out.around, out.along);
    const FlatPoint foot{place.around - out.around, place.along - out.along};
    // On the centreline both sides are as good.
    out = away > 1e-12 * circumference_ ? FlatPoint{out.around / away, out.along / away}
                                        : FlatPoint{-best->direction.along, best->direction.around};
    return {least, foot, out, best->half_width};
}

StrutSample StrutMap::sample(const FlatPoint& place) const {
    const double row = (place.along - low_) / cell_along_;
    if (!(row >= 0) || row >= along_)   // far past an end
        return nearest(place, all_.data(), all_.data() + all_.size());
    const double turns = place.around / circumference_;
    const int i = std::min(around_ - 1, int((turns - std::floor(turns)) * around_));
    const std::size_t cell = std::size_t(int(row)) * std::size_t(around_) + std::size_t(i);
    return nearest(place, candidates_.data() + start_[cell], candidates_.data() + start_[cell + 1]);
}

}   // namespace patency
