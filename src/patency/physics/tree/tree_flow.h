// SPDX-License-Identifier: Apache-2.0
// Steady flow through a tree of vessels as a network: pressure and flow along every branch from areas alone, in
// milliseconds. Profiles marched along branches, losses where they part. Knows no particles. THEORY section 15.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "patency/physics/tree/profile_march.h"

namespace patency {

/// A vessel between two bifurcations, an end and a bifurcation, or two ends.
struct TreeBranch {
    std::string name;
    int parent = -1;                 ///< index of the branch it comes from, smaller than its own; -1: the inlet's
    double turn = 0;                 ///< angle from the parent's end to its own beginning [rad]
    std::vector<double> arc, area;   ///< stations from upstream down, two or more [m], [m^2]
};

/// What holds at an end. Flows are along the stream: into the inlet, out of an outlet.
struct TreePressure {
    double pressure;   ///< static, mean over the section [Pa]
};
struct TreeFlowRate {
    double flow;   ///< [m^3/s]
};
struct TreeResistance {           ///< p = distal_pressure + resistance Q
    double resistance;            ///< [Pa s/m^3]
    double distal_pressure = 0;   ///< [Pa]
};
using TreeEnd = std::variant<TreePressure, TreeFlowRate, TreeResistance>;

struct TreeCase {
    std::vector<TreeBranch> branches;   ///< the inlet's first, parents before children
    TreeBlood blood;
    TreeEnd inlet;                  ///< a flow or a pressure
    std::vector<TreeEnd> outlets;   ///< one per branch; of branches that have children of no account
    double inlet_entrance = 1;      ///< 1: the profile at the inlet is flat; 0: it is a parabola
};

/// The answer. Arrays are as the branches, stations as theirs.
struct TreeFlow {
    std::vector<double> flow;                        ///< [m^3/s], along the branch
    std::vector<std::vector<double>> pressure;       ///< static [Pa]
    std::vector<std::vector<TreeProfile>> profile;   ///< from upstream down, also where blood runs back
    double inlet_pressure = 0;                       ///< static, at the first station of the first branch [Pa]
    int iterations = 0;                              ///< Broyden steps
};

/// Flows and pressures that agree with all ends. Throws DeckError if the ends leave the pressure open (all are flows), and
/// GeometryError if a tree is malformed or no agreement is found.
TreeFlow solve_tree(const TreeCase& tree);

}   // namespace patency
