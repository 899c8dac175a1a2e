// SPDX-License-Identifier: Apache-2.0
// Where a deck's stent goes in its vessel, and whether it can: everything that must be refused before anything runs.
#pragma once

#include <vector>

#include "patency/config/case.h"
#include "patency/shape/stent_axis.h"
#include "patency/shape/stent_form.h"
#include "patency/stages/vessel.h"

namespace patency {

struct StentPlace {
    StentPattern pattern;        ///< as it was made (MadeStent)
    StentForm form;              ///< in the stent's own frame
    double diameter;             ///< that it is opened to, outside [m]
    double crimped_diameter;     ///< [m]
    double opened_length;        ///< by kinematics (at_diameter), of a surface as long as it is [m]
    std::size_t line;            ///< the centreline that it lies along, in VesselAlong::lines
    double arc;                  ///< of its middle along that line, from the inlet [m]
    StentAxis axis;              ///< through it; angle and place along as in the stent's own frame
    double reference_diameter;   ///< of the healthy lumen, mean of those at its two ends [m]
    double narrowest;            ///< the lumen before, within its length: the largest sphere that passes [m]

    double start_arc() const { return arc - pattern.length / 2; }   ///< [m]
    double end_arc() const { return arc + pattern.length / 2; }     ///< [m]
};

/// The line's points, each the mean of those within a radius [m] along it (less towards its ends): a stent does not follow every kink.
std::vector<Vec3> smoothed_line(const Centreline& line, double radius);

/// The balloon that lets a crimped stent pass: a fifth wider, in tenths of a millimetre [m].
double predilation_for(double crimped_diameter);

/// Around the worst lesion, or where stent.placement says. Throws DeckError (diameters that contradict each other, an unknown
/// branch, no lesion to find it by) and GeometryError (it reaches an opening, lies outside of the vessel, does not fit its bends or does not
/// get there), each with what to do.
StentPlace place_stent(const deck::Case& config, const Vessel& vessel);

}   // namespace patency
