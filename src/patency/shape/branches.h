// SPDX-License-Identifier: Apache-2.0
// Branches and bifurcations of a vessel: which parts of its centrelines are one vessel, and where they part.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patency/shape/centreline.h"

namespace patency {

/// One vessel between two bifurcations, or between one and an opening. Its points are those of one of the lines that
/// pass through it.
struct Branch {
    std::string name;                 ///< branch_1..
    std::size_t line;                 ///< the line whose points they are
    std::size_t first, last;          ///< indices of its first and last point, both in it
    int parent;                       ///< index of the branch upstream, -1 if there is none
    std::vector<std::size_t> lines;   ///< all lines that pass through it
};

struct BranchedLines {
    std::vector<Centreline> lines;
    std::vector<Branch> branches;   ///< in the order in which the lines, one after another, reach them
    /// Per line and point: the index of its branch, or -1 between branches; and there, the bifurcation's, else -1.
    /// Bifurcations are numbered by the branches that lead to them.
    std::vector<std::vector<int>> branch_ids, bifurcation_ids;

    const CentrelinePoint& point(const Branch& branch, std::size_t k) const { return lines[branch.line].points[k]; }
    double start_arc(const Branch& branch) const { return point(branch, branch.first).arc; }   ///< [m] from the inlet
    double end_arc(const Branch& branch) const { return point(branch, branch.last).arc; }      ///< [m] from the inlet
};

/// Lines are in different branches where neither runs inside the other's tube, the union of the spheres along it. The
/// bifurcation begins one radius upstream of the last point they share and ends, on each line, where it leaves the
/// other's tube for good; bifurcations that overlap, or have less than a radius between them, are one. (14.4)
BranchedLines find_branches(std::vector<Centreline> lines);

/// A curve with a name, of the network that a surface was made from [m].
struct NamedCurve {
    std::string name;
    std::vector<Vec3> points;
};
/// Gives every branch the name of the curve that its points are nearest to on average, if that is within half its mean
/// radius; a second branch along the same curve becomes NAME_2.
void name_branches(BranchedLines& vessel, std::span<const NamedCurve> curves);

/// The branch that a point lies in: whose largest spheres it is deepest in; none between branches and outside of them.
std::optional<std::size_t> branch_around(const BranchedLines& vessel, const Vec3& point);

/// Gives the branches around the points their names; the others keep theirs. Throws UsageError for a point in no branch, a branch with
/// two names, and a name of two branches.
void name_branches(BranchedLines& vessel, const std::map<std::string, Vec3>& points);

/// The unit normal of the plane that the points of all lines are nearest to: how the vessel mostly lies.
Vec3 normal_of(const BranchedLines& vessel);

}   // namespace patency
