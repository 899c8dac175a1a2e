// SPDX-License-Identifier: Apache-2.0
// Steady flow through a tree of vessels as a network: pressure and flow along every branch from areas alone, in a
// millisecond. Viscous, entrance and lesion losses, losses at bifurcations. Knows no particles. THEORY section 15.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace patency {

/// A narrowing within a branch, whose jet loses energy where it widens again.
struct TreeLesion {
    double throat_arc, end_arc;   ///< where it is narrowest, and where it ends [m]
    double throat_area;           ///< [m^2]
    double reference_area;        ///< of the vessel without it [m^2]
};

/// A vessel between two bifurcations, an end and a bifurcation, or two ends.
struct TreeBranch {
    std::string name;
    int parent = -1;                 ///< index of the branch it comes from, smaller than its own; -1: the inlet's
    double turn = 0;                 ///< angle from the parent's end to its own beginning [rad]
    std::vector<double> arc, area;   ///< stations from upstream down, two or more [m], [m^2]
    std::vector<TreeLesion> lesions{};
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

struct TreeBlood {
    double density;                               ///< [kg/m^3]
    std::function<double(double)> viscosity_at;   ///< of the shear rate [1/s]: dynamic viscosity [Pa s]
};

struct TreeCase {
    std::vector<TreeBranch> branches;   ///< the inlet's first, parents before children
    TreeBlood blood;
    TreeEnd inlet;                  ///< a flow or a pressure
    std::vector<TreeEnd> outlets;   ///< one per branch; of branches that have children of no account
    double inlet_entrance = 1;      ///< 1: the profile at the inlet is flat; 0: it is developed
};

/// The answer. Arrays are as the branches, stations as theirs.
struct TreeFlow {
    std::vector<double> flow;                    ///< [m^3/s], along the branch
    std::vector<std::vector<double>> pressure;   ///< static [Pa]
    double inlet_pressure = 0;                   ///< static, at the first station of the first branch [Pa]
    int iterations = 0;                          ///< Newton steps
};

/// Static pressure at every station for flows that are given. Losses are those of THEORY.md (15.1) to (15.4).
std::vector<std::vector<double>> tree_pressures(const TreeCase& tree, const std::vector<double>& branch_flows,
                                                double inlet_pressure);

/// Flows and pressures that agree with all ends. Throws DeckError if the ends leave the pressure open (all are flows), and
/// GeometryError if a tree is malformed or no agreement is found.
TreeFlow solve_tree(const TreeCase& tree);

/// The excess pressure of a flat profile that becomes a parabola, x = z / (D Re) after its start, in units of the mean
/// velocity's dynamic pressure: 0 at first, 1.25 in the end (Shah & London 1978).                   THEORY.md (15.2)
double entrance_excess(double x);

}   // namespace patency
