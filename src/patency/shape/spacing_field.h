// SPDX-License-Identifier: Apache-2.0
// How far apart particles should be, everywhere in a lumen: a share of the local diameter. Makes no particles
// (bodies/graded_points.h).
#pragma once

#include <memory>
#include <span>

#include "patency/shape/lumen.h"

namespace patency {

struct SpacingSettings {
    double smallest;        ///< [m]; vessels narrower than `across` of these have fewer across
    double largest;         ///< [m]
    double across = 12;     ///< spacings in the local diameter
    double growth = 0.15;   ///< how much the spacing may change per length of way
};

/// A ball in a lumen that touches its wall.
struct InscribedBall {
    Vec3 centre;     ///< [m]
    double radius;   ///< [m]
};

/// A spacing [m] at every place in and around the lumen; a value that can be copied. Safe to ask from several threads.
class SpacingField {
public:
    double operator()(const Vec3& x) const;
    const SpacingSettings& settings() const { return settings_; }
    /// `factor` times as far apart everywhere.
    SpacingField scaled(double factor) const;

private:
    friend SpacingField make_spacing_field(const Lumen&, std::span<const InscribedBall>, const SpacingSettings&);
    class Grid;
    SpacingSettings settings_;
    std::shared_ptr<const Grid> grid_;
    double factor_ = 1;
};

/// The local diameter at x is that of the largest of the balls that holds x; where none does, beside the balls, that of the
/// places around. In a round tube it is the tube's to 2 %. Kept at the nodes of a grid of a
/// quarter of the diameter that has the smallest spacing, linear in between; ways count along the grid, which are up to 9 %
/// longer than straight ones. The same bits for any number of threads. Throws GeometryError for settings that make no sense,
/// and for planar and periodic lumens.
SpacingField make_spacing_field(const Lumen& lumen, std::span<const InscribedBall> balls,
                                const SpacingSettings& settings);
/// Of all the balls that fit into the lumen and its straight continuations, which takes a while to find out; those around
/// a vessel's centrelines are known.
SpacingField make_spacing_field(const Lumen& lumen, const SpacingSettings& settings);

}   // namespace patency
