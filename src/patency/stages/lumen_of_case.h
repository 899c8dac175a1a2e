// SPDX-License-Identifier: Apache-2.0
// The lumen that a deck describes, and what is known of its axis where it has one. Makes no particles.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "patency/config/case.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/shape/lumen.h"

namespace patency {

/// The lumen of geometry.shape or geometry.surface with its openings named. Throws GeometryError for shapes that cannot be,
/// for surfaces with defects and for networks; FileError; DeckError if the deck names openings that the shape has not, or leaves one out.
Lumen make_lumen(const deck::Case& config);

/// A lumen around one straight axis: a channel, tube, cone, nozzle.
struct StraightAxis {
    Vec3 start, direction;            ///< first point [m]; unit, towards the outlet
    double length;                    ///< [m]
    Section section;
    std::vector<AxialRadius> outline; ///< radius or half gap along the axis [m]

    double axial(const Vec3& x) const { return dot(x - start, direction); }
    /// Distance from the axis (from the mid-plane) [m].
    double radial(const Vec3& x) const;
    /// Radius or half gap at a place along the axis; constant beyond the ends [m].
    double radius_at(double axial) const;
};
/// None for boxes in space, for branches and for surfaces.
std::optional<StraightAxis> find_straight_axis(const deck::Geometry& geometry);

/// The smallest width anywhere: a gap, a side or a diameter [m]; of a surface's lumen that of its smallest opening.
double narrowest_width(const deck::Geometry& geometry, const Lumen& lumen);

/// Whether the same blood passes everywhere between one inlet and one outlet.
bool is_single_vessel(const deck::Geometry& geometry, const Lumen& lumen);

/// Name of the plane wall that has this normal out of the blood: x_low, x_high, y_low, ...
std::string_view plane_wall_name(const Vec3& normal);

}  // namespace patency
