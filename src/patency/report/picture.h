// SPDX-License-Identifier: Apache-2.0
// A picture of a vessel's wall coloured by a field: what the page shows without a script, and on paper.
#pragma once

#include <string>

#include "patency/io/encode.h"
#include "patency/io/vtp.h"
#include "patency/report/view.h"

namespace patency {

/// A field's values as colours: `low` is the scale's first.
struct ColourRange {
    double low, high;
};

/// What is drawn: the surface's field, looked at in a view. Where IsResolved is zero the wall is grey. The box that the picture fits
/// is that of `frame`, so that two surfaces can be drawn in the same place; the background is transparent.
struct SurfaceScene {
    const PolyData& surface;
    std::string array;
    ColourRange range;
    View view;
    const PolyData& frame;
    std::size_t width = 720, most_height = 620;   ///< pixels
};
Bitmap draw_field(const SurfaceScene& scene);

}   // namespace patency
