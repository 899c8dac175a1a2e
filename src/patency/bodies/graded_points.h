// SPDX-License-Identifier: Apache-2.0
// Points in a lumen whose spacing follows the vessel (shape/spacing_field.h), evenly dense for it: for cells, which need no
// points in the wall. Points of one spacing are relax.h's.
#pragma once

#include <vector>

#include "patency/bodies/relax.h"
#include "patency/shape/spacing_field.h"

namespace patency {

struct GradedPoints {
    std::vector<Vec3> points;      ///< behind the openings, ordered along the vessel from the first opening
    std::vector<double> spacing;   ///< [m] of each, the field's up to one factor; their cubes sum to the lumen's volume
};

struct GradedSettings {
    int steps = 100;           ///< at most
    double tolerance = 0.01;   ///< it ends when points move less in a step, root mean square in spacings of each
    double clearance = 0.3;    ///< least distance to the wall and to the openings' planes, in spacings of each
};

/// As many points as the lumen holds spacings cubed, relaxed in kernels of h = 1.3 mean spacings of each pair. A lattice
/// continues them behind the wall and the openings, so that the first layer is half a spacing away. The same bits for any
/// number of threads. `quality`, if given, receives what was reached; its lengths are in spacings of each point.
/// The distance is asked at points near the wall only, a few times for each.
GradedPoints make_graded_points(const Lumen& lumen, const SpacingField& field, const GradedSettings& settings = {},
                                RelaxQuality* quality = nullptr);

}   // namespace patency
