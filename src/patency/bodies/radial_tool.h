// SPDX-License-Identifier: Apache-2.0
// Rigid tubes of a radius that is told: a balloon pushes what is within it outwards, a crimper what is outside of it
// inwards, straight or along a bent axis. They report what it takes.                 THEORY (21.12), (21.13)
#pragma once

#include "patency/bodies/contact.h"
#include "patency/shape/stent_axis.h"

namespace patency {

struct RadialTool {
    enum class Kind { balloon, crimper };
    Kind kind = Kind::balloon;
    StentAxis axis;                              ///< its middle is the tool's
    double length = 0;                           ///< along the axis [m]; a balloon has a half sphere at each end
    std::function<double(double time)> radius;   ///< [m]; continuous
};

/// A radius through these values [m] at these times [s], constant outside; between two of them as growing_rise.
std::function<double(double time)> ramped_radius(std::vector<double> times, std::vector<double> radii);

/// Vertices of the surface against the tool. A vertex's friction is against a wall that moves along the radius only.
std::unique_ptr<Contact> make_tool_contact(SolidSurface& surface, RadialTool tool, const ContactNumerics& numerics);

}   // namespace patency
