// SPDX-License-Identifier: Apache-2.0
// The lumen that a deck describes, and what is known of its axis where it has one. Makes no particles.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "patency/config/case.h"
#include "patency/physics/open_ends/profile.h"
#include "patency/shape/lumen.h"
#include "patency/shape/network.h"
#include "patency/stages/vessel.h"

namespace patency {

/// The lumen of geometry.shape, geometry.surface or geometry.network with its openings named. Throws GeometryError for what cannot be and for
/// surfaces with defects; FileError; DeckError if the deck names openings that the lumen has not, leaves one out, or has too large a spacing for it.
/// `known`: the deck's surface if it has been read (read_vessel), so that this need not be done again.
Lumen make_lumen(const deck::Case& config, const Vessel* known = nullptr);

/// That of geometry.shape alone, whatever the deck says of its openings.
Lumen make_lumen_of_shape(const deck::Case& config);

/// The network of geometry.network, narrowed by geometry.lesion. Throws FileError, GeometryError.
Network read_network_of(const deck::Case& config);

/// A lumen around one straight axis: a channel, tube, cone, nozzle.
struct StraightAxis {
    Vec3 start, direction;   ///< first point [m]; unit, towards the outlet
    double length;           ///< [m]
    Section section;
    std::vector<AxialRadius> outline;   ///< radius or half gap along the axis [m]

    double axial(const Vec3& x) const { return dot(x - start, direction); }
    /// Distance from the axis (from the mid-plane) [m].
    double radial(const Vec3& x) const;
    /// Radius or half gap at a place along the axis; constant beyond the ends [m].
    double radius_at(double axial) const;
};
/// None for boxes in space, branches, surfaces and networks.
std::optional<StraightAxis> find_straight_axis(const deck::Geometry& geometry);

/// Whether the lumen branches.
bool is_branching(const deck::Geometry& geometry);

/// Name of the plane wall that has this normal out of the blood: x_low, x_high, y_low, ...
std::string_view plane_wall_name(const Vec3& normal);

}   // namespace patency
