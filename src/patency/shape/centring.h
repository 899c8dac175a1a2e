// SPDX-License-Identifier: Apache-2.0
// Moves a rough line through a lumen onto the ridge of its distance: the centres of the largest spheres. Works from where
// the wall is, not from the value at the ridge, which a gridded distance does not have sharply.
#pragma once

#include <vector>

#include "patency/shape/lumen_ways.h"

namespace patency {

/// The radius of the largest sphere around the centre that fits [m]: the nearest of the wall's points seen from places
/// beside it, (14.3). radius: a first guess of it; across: the direction of the line there.
double inscribed_radius(const SignedDistance& distance, const Ball& guess, const Vec3& across);

/// How a line ends. Over `reach` [m] from a flat cap the distance sees the cap and not the wall: there the line is the
/// cubic that leaves the end along its tangent and joins the rest smoothly. 0 where there is no cap.
struct LineEnds {
    Vec3 first_tangent, last_tangent;   ///< unit, both away from the inlet
    double first_reach = 0, last_reach = 0;
};

/// The centred line, points 0.4 radii apart; its first and last points stay. (14.2)
std::vector<Ball> centred(const SignedDistance& distance, std::vector<Ball> way, const LineEnds& ends);

/// A smooth line through places at about the given position in their row, by a weighted quadratic fit to those within
/// `reach` [m] of it along the line. Unlike a mean it does not cut corners: its error is of fourth order.
struct SmoothPlace {
    Vec3 place, tangent;
};
SmoothPlace smoothed(const std::vector<Ball>& line, const std::vector<double>& arcs, std::size_t at, double reach);

std::vector<double> arcs_of(const std::vector<Ball>& line);   ///< from the first point [m]

}   // namespace patency
