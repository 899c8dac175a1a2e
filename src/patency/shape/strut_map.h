// SPDX-License-Identifier: Apache-2.0
// The distance to struts on the unrolled tube, which closes on itself around.
#pragma once

#include <cstdint>
#include <vector>

#include "patency/shape/stent_pattern.h"

namespace patency {

/// The nearest strut seen from a place.
struct StrutSample {
    double value;          ///< to the strut's edge [m], negative in the metal
    FlatPoint foot;        ///< the nearest place of its centreline [m]
    FlatPoint direction;   ///< unit, from there to the place
    double half_width;     ///< [m]
};

class StrutMap {
public:
    /// Keeps what it needs of the curves. Throws GeometryError if there are no struts.
    explicit StrutMap(const StrutCurves& curves);

    /// Exact outside of the metal and within one strut; where struts meet only |value| <= the true depth.
    StrutSample sample(const FlatPoint& place) const;
    double value(const FlatPoint& place) const { return sample(place).value; }
    double circumference() const { return circumference_; }

private:
    struct Piece {
        FlatPoint middle, direction;
        double half_length, half_width;
    };
    FlatPoint from_middle(const Piece& piece, const FlatPoint& place) const;
    double value(const Piece& piece, const FlatPoint& place) const;
    StrutSample nearest(const FlatPoint& place, const std::uint32_t* begin, const std::uint32_t* end) const;

    double circumference_;
    std::vector<Piece> pieces_;
    // A cell lists the pieces that are nearest to any of its places.
    double low_, cell_around_, cell_along_;
    int around_, along_;
    std::vector<std::uint32_t> start_, candidates_, all_;
};

}   // namespace patency
